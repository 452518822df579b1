"""When the robot was pushed: the instants that other times of a run are counted from, and what a way back undoes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from momentum_lab.app.instants import ROUNDING, instant
from momentum_lab.events import ApplyPush, ApplyPushes, HoldPush, LetGo, LoggedEvent, SessionEvent
from momentum_lab.physics.push import Push
from momentum_lab.session import Session

_OF_A_HAND = (ApplyPush, ApplyPushes, HoldPush, LetGo)


def beginnings(pushes: Iterable[Push], now: float) -> tuple[float, ...]:
    """When pushes have begun by a time of the run, s, in their order.

    One that begins where another ends goes on with it: a hand that moves pulls once.
    """
    begun = [push for push in pushes if push.start <= now + ROUNDING]
    ends = {instant(push.start + push.duration) for push in begun}
    return tuple(sorted({push.start for push in begun if instant(push.start) not in ends}))


def latest_before(pushed: Sequence[float], time: float) -> float | None:
    """When the latest push before a time of the run began, s; None without one."""
    return max((start for start in pushed if start <= time + ROUNDING), default=None)


def forgotten(session: Session, tick: int, coming: Sequence[LoggedEvent]) -> tuple[float, ...]:
    """When a hand has pushed that does not push again if the session goes on from a tick of its own, s of the run.

    Args:
        session: between two ticks.
        tick: what was done from its start on is forgotten.
        coming: what an opened run does again.
    """
    start = session.ticks - round(session.time / session.scenario.timestep)
    again = {entry for entry in coming if isinstance(entry.event, _OF_A_HAND)}
    times = []
    before: SessionEvent | None = None
    for entry in session.log:
        if entry.tick < tick or not isinstance(entry.event, _OF_A_HAND) or entry in again:
            continue
        pulled = isinstance(before, HoldPush)
        before = entry.event
        if not isinstance(before, LetGo) and not (pulled and isinstance(before, HoldPush)):
            times.append((entry.tick - start) * session.scenario.timestep)
    return tuple(times)


class Forgetting:
    """What is forgotten, looked up in a log once for each instant that is looked at: it is told with every frame."""

    def __init__(self) -> None:
        self._log: list[LoggedEvent] = []
        self._looked: tuple[int, int] | None = None
        self._times: tuple[float, ...] = ()

    def times(self, session: Session, tick: int, coming: Sequence[LoggedEvent]) -> tuple[float, ...]:
        """As `forgotten`; a session that goes back has another log, one that goes on a longer one."""
        looked = (tick, len(session.log))
        if self._log is not session.log or self._looked != looked:
            self._log, self._looked = session.log, looked
            self._times = forgotten(session, tick, coming)
        return self._times


def is_handled(coming: Iterable[LoggedEvent]) -> bool:
    """Whether a push that is held now is moved or let go by what an opened run does later."""
    return any(isinstance(entry.event, HoldPush | LetGo) for entry in coming)
