"""The robot beside the first: it gets the same events, and differs only in what was chosen for it."""

from __future__ import annotations

import msgspec

from momentum_lab.app.chosen import told
from momentum_lab.app.wire import Fallen, Truth
from momentum_lab.beside import Beside
from momentum_lab.choices import Choices
from momentum_lab.control.registry import controller_entry
from momentum_lab.errors import InputError, SimulationError
from momentum_lab.events import (
    Reset,
    SelectController,
    SelectPlanner,
    SessionEvent,
    SetGain,
    SetGains,
    SetPriority,
)
from momentum_lab.recording import Sample
from momentum_lab.session import Session
from momentum_lab.timeline import Timeline, fork


class Companion:
    """A second session in step with the first.

    Args:
        session: where the first session is, between two ticks.
        beside: what it does differently.
        since: when it came, s of the run; what happened before is the first robot's.

    Attributes:
        since: the same; 0 once it has stood up again.
    """

    def __init__(self, session: Session, beside: Beside, since: float = 0.0) -> None:
        self.session, self.beside, self.since = session, beside, since
        self.stopped: str | None = None
        self.waiting: list[SessionEvent] = []
        self._timeline = Timeline(session)

    @classmethod
    def of(cls, first: Session, beside: Beside) -> Companion:
        """One that begins where the first session is now."""
        session = fork(first, first.recording.capacity)
        session.solver_failures = 0  # those before were the first one's
        return cls(session, beside, first.time)

    def take(self, event: SessionEvent) -> None:
        """Do what the first robot is told to do, unless something else has been chosen for this one."""
        if self._is_for_both(event):
            self._post(event)
        if isinstance(event, Reset):
            self.stopped, self.since = None, 0.0

    def align(self, first: Choices) -> None:
        """Make this robot's choices those of the first one, but for the differences."""
        names = controller_entry(self.beside.controller or first.controller).gains.__dataclass_fields__
        gains = {name: value for name, value in self.beside.gains.items() if name in names}
        target = first.beside(msgspec.structs.replace(self.beside, gains=gains))
        for event in self.session.choices_after(self.waiting).until(target):
            self._post(event)

    def tick(self) -> None:
        """One tick, unless its simulation cannot go on."""
        if self.stopped is not None:
            return
        self._timeline.note()
        try:
            self.session.tick()
        except SimulationError as error:
            self.stopped = str(error)
        self.waiting.clear()

    def back(self, ticks: int) -> bool:
        """Be where this session was so many ticks ago; whether it remembers."""
        if self.stopped is not None:
            return False
        try:
            self._timeline.go_back(ticks)
        except InputError:
            return False
        self.waiting.clear()
        return True

    def shown(self, behind: int) -> Sample:
        """The sample so many ticks ago, the oldest one if that is too far."""
        recording = self.session.recording
        return recording.before_end(min(behind, len(recording) - 1))

    def truth(self, first: Truth, behind: int) -> Truth:
        """What is the case with this robot, given what is the case with the first one."""
        session, chosen = self.session, told(self.session.choices_after(self.waiting))
        fall = session.fall
        fallen = fall is not None and fall.time <= self.shown(behind).number("time")
        return msgspec.structs.replace(
            first,
            **{name: chosen[name] for name in ("controller", "priority", "planner", "gains")},
            fall=Fallen(fall.time, fall.reason) if fall is not None and fallen else None,
            failure=session.last_failure,
            failures=session.solver_failures,
            stopped=self.stopped,
            since=self.since,
        )

    def _is_for_both(self, event: SessionEvent) -> bool:
        match event:
            case SetPriority():
                return self.beside.priority is None
            case SetGain(name):
                return self.beside.controller is None and name not in self.beside.gains
            case SetGains(values):
                return self.beside.controller is None and not values.keys() & self.beside.gains.keys()
            case SelectController() | SelectPlanner():
                return self.beside.controller is None
        return True

    def _post(self, event: SessionEvent) -> None:
        self.session.post(event)
        self.waiting.append(event)
