"""The way back: instants of a session from which it can go on again, bit for bit or otherwise."""

from __future__ import annotations

from collections import deque

from momentum_lab.errors import InputError
from momentum_lab.session import Session, Snapshot

# Ticks between two snapshots; what lies between them is simulated anew.
_EVERY = 20


def fork(session: Session, capacity: int) -> Session:
    """Another session that is where this one is and goes on by itself; its inbox is empty.

    What has been done in this one has been done in it, too. Its recording begins with the last sample of this one,
    if there is one.

    Args:
        session: between two ticks.
        capacity: ticks that the new recording keeps.
    """
    other = Session(session.scenario, session.robot, capacity)
    other.resume(session.snapshot())
    other.log = list(session.log)
    if len(session.recording):
        other.recording.next_row()[:] = session.recording.latest.row
    return other


class Timeline:
    """Snapshots of a session while it runs, as far back as its recording reaches.

    Args:
        session: a session at the start of a tick.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._snapshots: deque[Snapshot] = deque(maxlen=session.recording.capacity // _EVERY + 1)
        self.note()

    def note(self) -> None:
        """Remember where the session is, if it is time to; to be called before every tick."""
        if self._snapshots and self._session.time < self._time(self._snapshots[-1]):
            self._snapshots.clear()  # the robot has been stood up: what was before is another story
        if not self._snapshots or self._session.ticks - self._snapshots[-1].ticks >= _EVERY:
            self._snapshots.append(self._session.snapshot())

    def remembers(self, ticks: int) -> bool:
        """Whether the session can go back so many ticks."""
        return self._snapshots[0].ticks <= self._session.ticks - ticks

    def go_back(self, ticks: int) -> None:
        """Let the session be where it was so many ticks ago, and forget what came after.

        Raises:
            InputError: that is further back than is remembered.
        """
        session, target = self._session, self._session.ticks - ticks
        oldest = self._snapshots[0].ticks
        if not oldest <= target <= session.ticks:
            raise InputError("ticks", ticks, f"0 to {session.ticks - oldest}, as far as is remembered")
        while self._snapshots[-1].ticks > target:
            self._snapshots.pop()
        events = deque(entry for entry in session.log if self._snapshots[-1].ticks <= entry.tick < target)
        session.resume(self._snapshots[-1])
        while session.ticks < target:
            while events and events[0].tick == session.ticks:
                session.post(events.popleft().event)
            session.tick()

    def _time(self, snapshot: Snapshot) -> float:
        return float(snapshot.tick_of_run * self._session.scenario.timestep)
