"""Gains declare themselves: default, unit, range and help; sliders, command line and documents read it here."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass, field
from typing import Any, TypeVar

from momentum_lab.errors import GainError

_KEY = "gain"
GainsT = TypeVar("GainsT")


@dataclass(frozen=True, slots=True)
class GainInfo:
    """What a person needs to know about one gain.

    Attributes:
        name: the name on the command line.
        default: the value without any choice.
        unit: SI unit, "1" for a ratio.
        low: smallest allowed value.
        high: largest allowed value.
        help: what the gain does, in one sentence.
    """

    name: str
    default: float
    unit: str
    low: float
    high: float
    help: str

    def check(self, value: float) -> float:
        """The value, if it is a finite number within the range.

        Raises:
            GainError: it is not.
        """
        if (
            not isinstance(value, int | float)
            or not math.isfinite(value)
            or not self.low <= value <= self.high
        ):
            raise GainError(self.name, value, f"a number from {self.low:g} to {self.high:g} {self.unit}")
        return float(value)


def gain(default: float, unit: str, low: float, high: float, help: str) -> Any:
    """Declare one gain as the field of a frozen dataclass of gains."""
    return field(default=default, metadata={_KEY: GainInfo("", default, unit, low, high, help)})


def declared_gains(gains: object) -> dict[str, GainInfo]:
    """All gains of a dataclass (or of an instance of one), by name, in the order of declaration."""
    return {
        item.name: dataclasses.replace(item.metadata[_KEY], name=item.name)
        for item in dataclasses.fields(gains)  # type: ignore[arg-type]
        if _KEY in item.metadata
    }


def values_of(gains: object) -> dict[str, float]:
    """All gains by name."""
    return {name: float(getattr(gains, name)) for name in declared_gains(gains)}


def with_gains(gains: GainsT, values: dict[str, float]) -> GainsT:
    """The same gains with some values changed.

    Raises:
        GainError: a name is not declared, or a value is out of range.
    """
    known = declared_gains(gains)
    for name in values:
        if name not in known:
            raise GainError("gain", name, f"one of {', '.join(known)}")
    checked = {name: known[name].check(value) for name, value in values.items()}
    return dataclasses.replace(gains, **checked)  # type: ignore[type-var]
