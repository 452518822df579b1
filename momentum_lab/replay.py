"""A run again: its scenario, its events at their ticks, and whether every bit is as it was."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from momentum_lab.events import SessionEvent
from momentum_lab.headless import Timing, always, run_headless
from momentum_lab.run_file import Run, fingerprint
from momentum_lab.session import Session
from momentum_lab.trace import Trace


class Script:
    """The events of a run, to be posted tick by tick.

    Args:
        run: the run.
    """

    def __init__(self, run: Run) -> None:
        self._at: dict[int, list[SessionEvent]] = defaultdict(list)
        for entry in run.events:
            self._at[entry.tick].append(entry.event)

    def at(self, tick: int) -> list[SessionEvent]:
        """What was done at a tick."""
        return self._at.get(tick, [])

    def cue(self, session: Session) -> None:
        """Post what was done at the tick that a session is about to begin.

        Raises:
            InputError: the session cannot do it.
        """
        for event in self.at(session.ticks):
            session.post(event)


@dataclass(frozen=True, slots=True)
class Agreement:
    """Whether a replay is the run that was recorded.

    Attributes:
        agrees: every bit that can be compared is the same.
        compared: what was compared, in words.
        difference: the first difference in words; empty when there is none.
    """

    agrees: bool
    compared: str
    difference: str = ""


def prepared(run: Run) -> Session:
    """A session at the start of a run, with room for all of it.

    Raises:
        InputError: the run's robot, or one of its events, is not possible here.
    """
    session = Session(run.scenario, capacity=run.length)
    session.check(entry.event for entry in run.events)
    return session


def replayed(run: Run, proceed: Callable[[float], bool] = always) -> tuple[Session, Timing]:
    """A session that has done a run again.

    Args:
        run: the run.
        proceed: asked before every tick with the fraction that is done; False ends the replay there.

    Raises:
        InputError: its robot, or one of its events, is not possible here.
    """
    session = prepared(run)
    return session, run_headless(session, proceed, Script(run).cue, run.length)


def end_agreement(run: Run, session: Session) -> Agreement:
    """Whether the last sample of a replay is that of the run."""
    agrees = fingerprint(session.recording.latest.row) == run.end
    words = "" if agrees else "the last sample has other bits"
    return Agreement(agrees, f"the sample at {session.recording.latest.number('time'):.3f} s", words)


def trace_agreement(trace: Trace, session: Session) -> Agreement:
    """Whether every number of a trace is that of the replay, to the bit.

    Both end at the same tick; a trace may begin later than the replay.
    """
    rows = len(trace.columns["time"])
    compared = f"{rows} samples of {len(trace.columns)} quantities"
    first = min(
        (
            (tick, name)
            for name, column in trace.columns.items()
            for tick in _differing(column, session, name)[:1]
        ),
        default=None,
    )
    if first is None:
        return Agreement(True, compared)
    tick, name = first
    return Agreement(False, compared, f"{name} at {trace.columns['time'][tick]:.3f} s is the first of them")


def _differing(column: np.ndarray, session: Session, name: str) -> np.ndarray:
    """Rows of a recorded quantity (n, ...) that the replay does not have in the same bits; all if it has none."""
    rows = len(column)
    if name not in session.recording.layout.shapes or len(session.recording) < rows:
        return np.arange(rows)
    again = session.recording.column(name)[len(session.recording) - rows :]
    if again.shape != column.shape:
        return np.arange(rows)
    same = (again == column) | (np.isnan(again) & np.isnan(column))
    return np.flatnonzero(~same.reshape(rows, -1).all(axis=1))
