"""The robot beside the first, in a run without a screen: the same is done to it, but for what differs."""

from __future__ import annotations

from momentum_lab.app.companion import Companion
from momentum_lab.beside import Beside
from momentum_lab.events import SessionEvent
from momentum_lab.replay import Script
from momentum_lab.run_file import Run
from momentum_lab.scenario import sides
from momentum_lab.session import Session


class Second:
    """A session for the robot beside the first, and what is done to it.

    Args:
        run: a run of two robots.

    Attributes:
        session: at the start of the run.

    Raises:
        InputError: the robot, or what differs, is not possible here.
    """

    def __init__(self, run: Run) -> None:
        first, second = sides(run.scenario)
        self._first = Session(first, capacity=1)  # it never ticks: it is asked what would have been chosen
        self.session = Session(second, self._first.robot, run.length)
        self._companion = Companion(self.session, run.scenario.beside or Beside())
        self._script = Script(run)
        self._done: list[SessionEvent] = []

    def cue(self, session: Session) -> None:
        """Post what is done at the tick that the session is about to begin."""
        self._companion.waiting.clear()
        for event in self._script.at(session.ticks):
            self._done.append(event)
            self._companion.take(event)
            self._companion.align(self._first.choices_after(self._done))
