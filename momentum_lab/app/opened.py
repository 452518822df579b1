"""A run that has been opened: events come at their ticks, time stops where it ended, the bits are compared."""

from __future__ import annotations

from momentum_lab.app.wire import Opened
from momentum_lab.events import LoggedEvent, SessionEvent
from momentum_lab.replay import Script, end_agreement
from momentum_lab.run_file import Run
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session


class OpenedRun:
    """A run on its way through a session.

    Args:
        run: the run; one of no ticks has no end and no events to come.
    """

    def __init__(self, run: Run) -> None:
        self._run, self._script = run, Script(run)
        self._over = False
        self._agrees: bool | None = None

    @property
    def events(self) -> tuple[LoggedEvent, ...]:
        """All that is done in it, at its ticks."""
        return self._run.events

    def due(self, session: Session) -> list[SessionEvent]:
        """What was done at the tick that is about to begin."""
        return self._script.at(session.ticks)

    def coming(self, session: Session) -> list[LoggedEvent]:
        """What is done at the ticks that have not begun."""
        return [entry for entry in self._run.events if entry.tick >= session.ticks]

    def ends(self, session: Session) -> bool:
        """Whether a session has come to the end of the run, for the first time."""
        if self._over or not self._run.ticks or session.ticks != self._run.ticks:
            return False
        self._over = True
        done = [entry for entry in self._run.events if entry.tick < session.ticks]
        if self._run.end and session.log == done:
            self._agrees = end_agreement(self._run, session).agrees
        return True

    def told(self, session: Session) -> Opened | None:
        """How far it is; None for a run without an end."""
        if not self._run.ticks:
            return None
        over = self._over and session.ticks == self._run.ticks
        return Opened(self._run.ticks * session.scenario.timestep, over, self._agrees if over else None)


NOTHING_OPENED = OpenedRun(Run(Scenario("nothing")))
"""In place of a run, when none is open."""
