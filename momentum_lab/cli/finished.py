"""A run that was typed, played to its end: one robot, or two."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from momentum_lab.cli.run import played, played_beside
from momentum_lab.finished import FinishedRun
from momentum_lab.headless import Timing
from momentum_lab.run_file import Run
from momentum_lab.session import Session


def finished(chosen: Run) -> tuple[FinishedRun, str | None]:
    """The run, and why it ended before its time; None when it did not.

    Raises:
        InputError: something in it is not possible here.
        KeyboardInterrupt: Ctrl+C.
    """
    run, error = _one(chosen, played)
    if chosen.scenario.beside is None:
        return run, error
    beside, problem = _one(chosen, played_beside)
    return replace(run, beside=beside), error or problem


def _one(chosen: Run, play: Callable[[Run], tuple[Session, Timing, bool]]) -> tuple[FinishedRun, str | None]:
    session, timing, stopped = play(chosen)
    if stopped:
        raise KeyboardInterrupt
    return FinishedRun.of(session), timing.error
