"""Measures of one run, in a few words."""

from __future__ import annotations

from collections.abc import Callable
from typing import SupportsFloat

import numpy as np

from momentum_lab.lesson.parts import Measure
from momentum_lab.session import Session

STANDS = "stands"
Quantity = Callable[[Session], np.ndarray]


def of(run: str, quantity: Callable[[Session], SupportsFloat], unit: str = "", spec: str = ".0f") -> Measure:
    """A measure of one run.

    Args:
        run: its label.
        quantity: a number, from the session that has run.
        unit: of the number.
        spec: how it is written, a Python format.
    """
    return Measure(lambda runs: float(quantity(runs[run])), unit, spec)


def at(run: str, time: float, quantity: Quantity, unit: str, spec: str = ".0f") -> Measure:
    """A measure of one run at an instant: the number that an equation shows there.

    Args:
        run: its label.
        time: the instant, s.
        quantity: the quantity over time (n,), from the session that has run.
        unit: of the number.
        spec: how it is written, a Python format.
    """

    def then(session: Session) -> float:
        return float(quantity(session)[round(time / session.scenario.timestep)])

    return of(run, then, unit, spec)


def fate(run: str) -> Measure:
    """What becomes of the robot of a run, in words: `stands`, or `falls after 1.3 s`."""

    def words(session: Session) -> str:
        return STANDS if session.fall is None else f"falls after {session.fall.time:.1f} s"

    return Measure(lambda runs: words(runs[run]))
