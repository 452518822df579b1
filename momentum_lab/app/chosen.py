"""What a person has chosen for a session, and the events that lead from one set of choices to another."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields, replace

from momentum_lab.app.wire import Truth
from momentum_lab.beside import Beside
from momentum_lab.control.gains import declared_gains, with_gains
from momentum_lab.control.ground_sense import GroundSense
from momentum_lab.control.motion import AngularGoal
from momentum_lab.control.planner import OWN
from momentum_lab.control.registry import controller_entry
from momentum_lab.errors import InputError
from momentum_lab.events import (
    SelectController,
    SelectPlanner,
    SessionEvent,
    SetAngularGoal,
    SetDirections,
    SetGain,
    SetGains,
    SetGroundSense,
    SetMismatch,
    SetMotion,
    SetPriority,
)
from momentum_lab.momentum.directions import text_of
from momentum_lab.physics.mismatch import EXACT, Mismatch, changes
from momentum_lab.session import Session


@dataclass(frozen=True, slots=True)
class Chosen:
    """What a person has chosen for a session."""

    controller: str
    priority: float
    controlled: str
    planner: str
    motion: str
    angular_goal: AngularGoal
    gains: dict[str, float]
    ground_sense: GroundSense = "told"
    mismatch: Mismatch = EXACT

    def until(self, other: Chosen) -> list[SessionEvent]:
        """The events that lead from these choices to others."""
        events: list[SessionEvent] = []
        gains = self.gains
        if other.controller != self.controller:
            events.append(SelectController(other.controller))
            gains = values_of(controller_entry(other.controller).gains)
        if other.priority != self.priority:
            events.append(SetPriority(other.priority))
        if other.controlled != self.controlled:
            events.append(SetDirections(other.controlled))
        if other.planner != self.planner:
            events.append(SelectPlanner(other.planner))
        if other.motion != self.motion:
            events.append(SetMotion(other.motion))
        if other.ground_sense != self.ground_sense:
            events.append(SetGroundSense(other.ground_sense))
        events += [SetMismatch(*change) for change in changes(self.mismatch, other.mismatch)]
        if other.angular_goal != self.angular_goal:
            events.append(SetAngularGoal(other.angular_goal))
        changed = {name: value for name, value in other.gains.items() if value != gains[name]}
        if len(changed) > 1:
            return [*events, SetGains(changed)]
        return events + [SetGain(name, value) for name, value in changed.items()]

    def differing(self, other: Chosen) -> frozenset[str]:
        """Names of the choices, gains and model errors in which these choices are others."""
        names = {name for name in CHOICES if getattr(self, name) != getattr(other, name)} - {
            "gains",
            "mismatch",
        }
        gains = {name for name in self.gains if self.gains[name] != other.gains.get(name)}
        return frozenset(names | gains | {name for name, _ in changes(other.mismatch, self.mismatch)})

    def beside(self, beside: Beside) -> Chosen:
        """The choices for a robot beside the one with these choices.

        Raises:
            InputError: the controller is unknown, or has no such gain, or a value is out of range.
        """
        controller = beside.controller or self.controller
        entry = controller_entry(controller)
        same = self.gains if controller == self.controller else {}
        priority = self.priority if beside.priority is None else beside.priority
        if not 0.0 <= priority <= 1.0:
            raise InputError("priority", priority, "0 to 1")
        return replace(
            self,
            controller=controller,
            priority=priority,
            planner=self.planner if self.planner in entry.planners else OWN,
            gains=values_of(with_gains(entry.gains, {**same, **beside.gains})),
        )


CHOICES = tuple(field.name for field in fields(Chosen))
"""The names of all choices; `Truth` has them under the same names."""


def chosen_in(truth: Truth) -> Chosen:
    """The choices in what is the case."""
    return Chosen(**{name: getattr(truth, name) for name in CHOICES})


def chosen_of(session: Session, waiting: Iterable[SessionEvent]) -> Chosen:
    """The choices of this moment; those that wait for the session's next tick count as made."""
    choices = session.choices_after(waiting)
    return Chosen(
        controller=choices.controller,
        priority=choices.priority,
        controlled=text_of(choices.controlled),
        planner=choices.planner,
        motion=choices.motion,
        angular_goal=choices.angular_goal,
        gains=values_of(choices.gains),
        ground_sense=choices.ground_sense,
        mismatch=choices.mismatch,
    )


def values_of(gains: object) -> dict[str, float]:
    """All gains by name."""
    return {name: float(getattr(gains, name)) for name in declared_gains(gains)}
