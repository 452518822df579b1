"""A run on its way: what has to happen before each tick, and when it is over. The same with and without a screen."""

from __future__ import annotations

from momentum_lab.lesson.parts import Run
from momentum_lab.session import Session

# There is nothing to learn from a robot that lies on the ground, s.
_AFTER_A_FALL = 0.05


class Staging:
    """A run and the events of it that are still to come.

    Args:
        run: the run.
    """

    def __init__(self, run: Run) -> None:
        self._coming = sorted(run.events, key=lambda event: event[0])

    def prepare(self, session: Session) -> bool:
        """Post what is due now; False if the run is over and no tick is to follow."""
        if is_over(session):
            return False
        while self._coming and self._coming[0][0] <= session.time + 1e-9:
            session.post(self._coming.pop(0)[1])
        return True


def is_over(session: Session) -> bool:
    """Whether a run has come to its end, or its robot has fallen."""
    fallen = session.fall is not None and session.time > session.fall.time + _AFTER_A_FALL
    return fallen or session.ticks >= session.scenario_ticks
