"""What a push would do: a copy of the session is pushed and runs ahead, a few ticks at a time."""

from __future__ import annotations

from collections.abc import Iterable

from momentum_lab.app.wire import Fallen, Foreseen
from momentum_lab.errors import SimulationError
from momentum_lab.events import ApplyPush, SessionEvent
from momentum_lab.physics.push import Push
from momentum_lab.session import Session
from momentum_lab.timeline import fork

SECONDS = 1.5
"""How far it looks, s of simulated time."""

# Ticks between two samples of the answer.
_EVERY = 10


class Foresight:
    """A push on a copy of a session. The session itself does not notice.

    Args:
        session: between two ticks.
        waiting: what waits for its next tick.
        push: what is tried at its next tick.

    Raises:
        InputError: the robot cannot be pushed so.
    """

    def __init__(self, session: Session, waiting: Iterable[SessionEvent], push: Push) -> None:
        self._ticks = self._left = round(SECONDS / session.scenario.timestep)
        self._start = session.time
        self.session = fork(session, self._left + 1)
        self.session.recording.clear()
        for event in (*waiting, ApplyPush(push)):
            self.session.post(event)

    @property
    def part(self) -> float:
        """How much of it is done, from 0 to 1."""
        return 1.0 - self._left / self._ticks

    def go_on(self, ticks: int) -> bool:
        """Some ticks more; whether it has reached its end."""
        for _ in range(min(ticks, self._left)):
            self._left -= 1
            try:
                self.session.tick()
            except SimulationError:
                self._left = 0
        return self._left == 0

    def answer(self) -> Foreseen:
        """What has happened to the copy."""
        fall = self.session.fall
        return Foreseen(
            start=self._start,
            rows=self.session.recording.rows(_EVERY).tobytes(),
            fall=None if fall is None else Fallen(fall.time, fall.reason),
        )
