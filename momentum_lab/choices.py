"""What has been chosen for a session, as one value; an event makes another value of it."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import reduce
from typing import Any

from momentum_lab.control.gains import with_gains
from momentum_lab.control.ground_sense import GroundSense, ground_sense
from momentum_lab.control.motion import AngularGoal, reach_of
from momentum_lab.control.planner import OWN
from momentum_lab.control.registry import check_planner, controller_entry
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
from momentum_lab.momentum.directions import Directions, directions
from momentum_lab.physics.mismatch import Mismatch, with_error
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

    def _controlled_by(self, name: str) -> Choices:
        """Another controller with its own gains; the planner stays if it can."""
        entry = controller_entry(name)
        planner = self.planner if self.planner in entry.planners else OWN
        return replace(self, controller=name, gains=entry.gains, planner=planner)


def _checked_priority(value: float) -> float:
    if not math.isfinite(value) or not 0.0 <= value <= 1.0:
        raise InputError(
            "priority", value, "a number from 0 (keep linear momentum) to 1 (keep angular momentum)"
        )
    return float(value)
