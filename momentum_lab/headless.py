"""A run without a screen: every tick of a scenario as fast as the machine can, and how long each one took."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter

import numpy as np

from momentum_lab.errors import SimulationError
from momentum_lab.session import Session


@dataclass(frozen=True, slots=True)
class Timing:
    """How a run went on this machine.

    Attributes:
        tick_time: wall time of every tick (n,), s.
        wall_time: of the whole loop, s.
        error: why the run ended before its time; None when it did not.
    """

    tick_time: np.ndarray
    wall_time: float
    error: str | None = None


def always(_fraction: float) -> bool:
    """Go on to the end."""
    return True


def _nothing(_session: Session) -> None:
    return None


def run_headless(
    session: Session,
    proceed: Callable[[float], bool] = always,
    cue: Callable[[Session], None] = _nothing,
    ticks: int | None = None,
) -> Timing:
    """Run a session to the end of its scenario.

    A simulation that breaks down ends the run; the recording holds everything before, and `Timing.error` says
    what happened.

    Args:
        session: a session at the start of its scenario.
        proceed: asked before every tick with the fraction of the run that is done; False ends the run there.
        cue: called before every tick; it posts what is to be done there.
        ticks: how long to run; None: as long as the scenario.

    Returns:
        The timing; what happened is in the session.
    """
    ticks = session.scenario_ticks if ticks is None else ticks
    tick_time = np.zeros(ticks)
    done, error = 0, None
    start = perf_counter()
    try:
        while done < ticks and proceed(done / ticks):
            cue(session)
            before = perf_counter()
            session.tick()
            tick_time[done] = perf_counter() - before
            done += 1
    except SimulationError as failure:
        error = str(failure)
    return Timing(tick_time[:done], perf_counter() - start, error)
