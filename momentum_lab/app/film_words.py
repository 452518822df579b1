"""What a person is told about a film: which part of the run it shows, and how long it takes."""

from __future__ import annotations

import math

from momentum_lab.app.reel import Reel


def before_film(reel: Reel, pace: float | None) -> str:
    """What a film is going to be.

    Args:
        reel: its pictures.
        pace: how long one of them took in the last such film, s; None before the first.
    """
    count = len(reel.rows)
    length = (
        "the first one tells how long it takes" if pace is None else f"it takes about {_time(count * pace)}"
    )
    empty = "" if reel.pushes else ", in which there was no push"
    return f"{_part(reel)} of the run{empty}: {count} pictures; {length}."


def during_film(reel: Reel, fraction: float, passed: float) -> str:
    """How far a film is, and how long it still takes if it goes on as since it was begun.

    Args:
        reel: its pictures.
        fraction: of them that is taken.
        passed: since the first was asked for, s.
    """
    left = _time(passed * (1.0 / fraction - 1.0)) if fraction else _time(0.0)
    return f"{_part(reel)} of the run: {int(100.0 * fraction)} % taken, {left} to go."


def _part(reel: Reel) -> str:
    """Which part of the run a film shows."""
    start, end = reel.span
    return f"Film from {start:.1f} s to {end:.1f} s"


def _time(seconds: float) -> str:
    return f"{math.ceil(seconds / 60.0)} min" if seconds > 90.0 else f"{seconds:.0f} s"
