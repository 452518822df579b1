"""What has been chosen for a session, as one value; an event makes another value of it."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, fields, replace
from functools import reduce
from typing import Any

from momentum_lab.beside import Beside
from momentum_lab.control.gains import values_of, with_gains
from momentum_lab.control.ground_sense import GroundSense, ground_sense
from momentum_lab.control.motion import AngularGoal, reach_of
from momentum_lab.control.registry import check_planner, controller_entry, planner_above
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
from momentum_lab.momentum.directions import Directions, directions, text_of
from momentum_lab.physics.mismatch import Mismatch, changes, with_error
from momentum_lab.robot.model import RobotModel
from momentum_lab.scenario import Scenario


@dataclass(frozen=True, slots=True)
class Choices:
    """Who controls the robot, with which gains and goals, and what it is not told.

    Attributes:
        controller: name in the registry.
        gains: its gains.
        priority: 0 keeps linear momentum, 1 angular momentum.
        controlled: the directions of momentum that are asked for.
        planner: name of what makes the rates that are asked for.
        motion: name of the motion on top of standing; empty: none.
        angular_goal: no angular momentum, or that of the motion.
        ground_sense: whether the ground is told or felt.
        mismatch: how the robot that is simulated differs from the one the controller believes in.
    """

    controller: str
    gains: Any
    priority: float
    controlled: Directions
    planner: str
    motion: str
    angular_goal: AngularGoal
    ground_sense: GroundSense
    mismatch: Mismatch

    @classmethod
    def of(cls, scenario: Scenario) -> Choices:
        """What a scenario begins with.

        Raises:
            InputError: it names something that does not exist, or a value is out of range.
        """
        return cls(
            controller=scenario.controller,
            gains=with_gains(controller_entry(scenario.controller).gains, scenario.gains),
            priority=scenario.priority,
            controlled=directions(scenario.controlled),
            planner=check_planner(scenario.planner, scenario.controller),
            motion=scenario.motion,
            angular_goal=scenario.angular_goal,
            ground_sense=scenario.ground_sense,
            mismatch=scenario.mismatch,
        )

    def after(self, event: SessionEvent, robot: RobotModel) -> Choices:
        """The choices after an event; the same ones if it is about something else.

        Raises:
            InputError: it asks for something that does not exist or is out of range.
        """
        match event:
            case SetGain(name, value):
                return replace(self, gains=with_gains(self.gains, {name: value}))
            case SetGains(values):
                return replace(self, gains=with_gains(self.gains, values))
            case SetPriority(value):
                return replace(self, priority=_checked_priority(value))
            case SetDirections(text):
                return replace(self, controlled=directions(text))
            case SelectPlanner(name):
                return replace(self, planner=check_planner(name, self.controller))
            case SelectController(name):
                return self._controlled_by(name)
            case SetMotion(name):
                if name:
                    reach_of(robot, name)  # refuses what this robot cannot do
                return replace(self, motion=name)
            case SetAngularGoal(goal):
                return replace(self, angular_goal=goal)
            case SetGroundSense(sense):
                return replace(self, ground_sense=ground_sense(sense))
            case SetMismatch(name, value):
                return replace(self, mismatch=with_error(self.mismatch, name, value))
        return self

    def after_all(self, events: Iterable[SessionEvent], robot: RobotModel) -> Choices:
        """The choices after some events, one after the other.

        Raises:
            InputError: one asks for something that does not exist or is out of range.
        """
        return reduce(lambda choices, event: choices.after(event, robot), events, self)

    def until(self, other: Choices) -> list[SessionEvent]:
        """The events that lead from these choices to others."""
        events: list[SessionEvent] = []
        before = values_of(self.gains)
        if other.controller != self.controller:
            events.append(SelectController(other.controller))
            before = values_of(controller_entry(other.controller).gains)
        if other.priority != self.priority:
            events.append(SetPriority(other.priority))
        if other.controlled != self.controlled:
            events.append(SetDirections(text_of(other.controlled)))
        if other.planner != self.planner:
            events.append(SelectPlanner(other.planner))
        if other.motion != self.motion:
            events.append(SetMotion(other.motion))
        if other.ground_sense != self.ground_sense:
            events.append(SetGroundSense(other.ground_sense))
        events += [SetMismatch(*change) for change in changes(self.mismatch, other.mismatch)]
        if other.angular_goal != self.angular_goal:
            events.append(SetAngularGoal(other.angular_goal))
        changed = {name: value for name, value in values_of(other.gains).items() if value != before[name]}
        if len(changed) > 1:
            return [*events, SetGains(changed)]
        return events + [SetGain(name, value) for name, value in changed.items()]

    def differing(self, other: Choices) -> frozenset[str]:
        """Names of the choices, gains and model errors in which these choices are others."""
        names = {name for name in CHOICES if getattr(self, name) != getattr(other, name)} - {
            "gains",
            "mismatch",
        }
        theirs = values_of(other.gains)
        gains = {name for name, value in values_of(self.gains).items() if value != theirs.get(name)}
        return frozenset(names | gains | {name for name, _ in changes(other.mismatch, self.mismatch)})

    def beside(self, beside: Beside) -> Choices:
        """The choices for a robot beside the one with these choices.

        Raises:
            InputError: the controller is unknown, or has no such gain, or a value is out of range.
        """
        name = beside.controller or self.controller
        same = self if name == self.controller else self._controlled_by(name)
        priority = self.priority if beside.priority is None else beside.priority
        if not 0.0 <= priority <= 1.0:
            raise InputError("priority", priority, "0 to 1")
        return replace(same, priority=priority, gains=with_gains(same.gains, beside.gains))

    def _controlled_by(self, name: str) -> Choices:
        """Another controller with its own gains; the planner stays if it can."""
        gains, planner = controller_entry(name).gains, planner_above(name, self.planner)
        return replace(self, controller=name, gains=gains, planner=planner)


CHOICES = tuple(field.name for field in fields(Choices))
"""The names of all choices."""


def _checked_priority(value: float) -> float:
    if not math.isfinite(value) or not 0.0 <= value <= 1.0:
        raise InputError(
            "priority", value, "a number from 0 (keep linear momentum) to 1 (keep angular momentum)"
        )
    return float(value)
