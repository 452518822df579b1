"""Measures of one run, in a few words."""

from __future__ import annotations

from collections.abc import Callable
from typing import SupportsFloat

from momentum_lab.lesson.parts import Measure
from momentum_lab.session import Session

STANDS = "stands"


def of(run: str, quantity: Callable[[Session], SupportsFloat], unit: str = "", spec: str = ".0f") -> Measure:
    """A measure of one run.

    Args:
        run: its label.
        quantity: a number, from the session that has run.
        unit: of the number.
        spec: how it is written, a Python format.
    """
    return Measure(lambda runs: float(quantity(runs[run])), unit, spec)


def fate(run: str) -> Measure:
    """What becomes of the robot of a run, in words: `stands`, or `falls after 1.3 s`."""

    def words(session: Session) -> str:
        return STANDS if session.fall is None else f"falls after {session.fall.time:.1f} s"

    return Measure(lambda runs: words(runs[run]))
