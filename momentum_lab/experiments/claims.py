"""What an experiment claims, and the figure that shows it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from momentum_lab.scenario import Scenario
from momentum_lab.session import Session

Runs = Mapping[str, Session]
Columns = Mapping[str, Sequence[Any] | np.ndarray]


@dataclass(frozen=True, slots=True)
class Claim:
    """One statement about a run.

    Attributes:
        text: the statement, in words.
        measured: what the run gave: a number in the unit that `allowed` names, or words.
        allowed: what it has to be, in words.
        holds: whether it is.
    """

    text: str
    measured: float | str
    allowed: str
    holds: bool


@dataclass(frozen=True, slots=True)
class Figure:
    """An experiment that ends in a picture, a table of numbers and claims.

    Attributes:
        name: on the command line, and of the scenario that the app opens.
        title: what it shows, in a few words.
        scenarios: the runs it needs by label, for a robot or, with None, for the scenario's own.
        draw: the picture of the runs, a matplotlib figure.
        table: the numbers behind the picture, column by column.
        claims: what the runs have to show.
    """

    name: str
    title: str
    scenarios: Callable[[str | None], dict[str, Scenario]]
    draw: Callable[[Runs], Any]
    table: Callable[[Runs], Columns]
    claims: Callable[[Runs], list[Claim]]


def at_most(text: str, measured: float, bound: float, unit: str) -> Claim:
    """A claim that a number is not above a bound; NaN is never allowed."""
    return Claim(text, float(measured), f"at most {bound:g} {unit}", bool(measured <= bound))


def at_least(text: str, measured: float, bound: float, unit: str) -> Claim:
    """A claim that a number is not below a bound; NaN is never allowed."""
    return Claim(text, float(measured), f"at least {bound:g} {unit}", bool(measured >= bound))


def stands(who: str, session: Session) -> Claim:
    """A claim that a robot is on its feet at the end."""
    return Claim(f"{who} does not fall", fate(session), "stands", session.fall is None)


def falls(who: str, session: Session) -> Claim:
    """A claim that a robot falls."""
    return Claim(f"{who} falls", fate(session), "fell", session.fall is not None)


def fate(session: Session) -> str:
    """How a run ended, in words."""
    return "stands" if session.fall is None else f"fell at {session.fall.time:.2f} s: {session.fall.reason}"


def largest(values: np.ndarray) -> float:
    """The largest absolute value; NaN if there is none, which no claim allows."""
    return float(np.abs(values).max()) if values.size else float("nan")
