"""What the words of a command line may mean: numbers in a range, gains, directions."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

from momentum_lab.errors import InputError
from momentum_lab.momentum.directions import directions

ABOVE_ZERO = math.ulp(0.0)
_DIRECTIONS = {"forward": 0.0, "left": 90.0, "backward": 180.0, "right": 270.0}


def number(option: str, low: float, high: float, unit: str) -> Callable[[str], float]:
    """A type for numbers within a range; `ABOVE_ZERO` as the lower end leaves out zero.

    Raises:
        InputError: (the type does) the text is not a finite number within the range.
    """
    start = "above 0, at most" if low == ABOVE_ZERO else f"from {low:g} to"

    def convert(text: str) -> float:
        value = as_number(text)
        if isinstance(value, str) or not low <= value <= high:
            raise InputError(option, text, f"a number {start} {high:g} ({unit})")
        return value

    return convert


def whole_number(option: str, low: int, high: int) -> Callable[[str], int]:
    """A type for whole numbers within a range.

    Raises:
        InputError: (the type does) the text is not such a number.
    """

    def convert(text: str) -> int:
        if not re.fullmatch(r"\d{1,18}", text, re.ASCII) or not low <= int(text) <= high:
            raise InputError(option, text, f"a whole number from {low} to {high}")
        return int(text)

    return convert


def as_number(text: str) -> float | str:
    """The number a text spells, or the text itself when it spells none that is finite."""
    try:
        value = float(text)
    except ValueError:
        return text
    return value if math.isfinite(value) and "_" not in text else text


def gain_setting(text: str) -> tuple[str, str]:
    """`GAIN=VALUE` as its two words.

    Raises:
        InputError: it is not of that form.
    """
    name, equals, value = text.partition("=")
    if not (name and equals and value):
        raise InputError("--set", text, "GAIN=VALUE, such as linear_damping=8")
    return name, value


def mismatch_setting(text: str) -> tuple[str, str]:
    """`NAME=VALUE` as its two words.

    Raises:
        InputError: it is not of that form.
    """
    name, equals, value = text.partition("=")
    if not (name and equals and value):
        raise InputError("--mismatch", text, "NAME=VALUE, such as mass_error=0.1")
    return name, value


def controlled_directions(text: str) -> str:
    """Directions of momentum, as they were typed.

    Raises:
        InputError: they are none.
    """
    try:
        directions(text)
    except InputError as error:
        raise InputError("--controlled", text, error.allowed) from error
    return text


def one_or_all(text: str) -> float | None:
    """A direction in degrees; None: all of them.

    Raises:
        InputError: it is no direction.
    """
    if text == "all":
        return None
    if text in _DIRECTIONS:
        return _DIRECTIONS[text]
    value = as_number(text)
    if isinstance(value, str) or not -360.0 <= value <= 360.0:
        allowed = f"{', '.join(_DIRECTIONS)}, all, or a number from -360 to 360 (degrees)"
        raise InputError("--direction", text, allowed)
    return value
