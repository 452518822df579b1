"""Motions on top of standing, and which angular momentum goes with them (section 5.3.2)."""

from __future__ import annotations

import dataclasses
import fnmatch
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from momentum_lab.control.controller import Reference
from momentum_lab.errors import InputError
from momentum_lab.momentum.reference_motion import reference_motion
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics

AngularGoal = Literal["zero", "reference"]
ANGULAR_GOALS: tuple[AngularGoal, ...] = ("zero", "reference")
# The robot stands for a moment before it moves, s; a swing grows to its full size within so long, s.
_START, _GROWTH = 0.5, 1.0
_KICK, _PAUSE = 0.7, 1.3
_SWING = 1.0


@dataclass(frozen=True, slots=True)
class Motion:
    """What all robots have in common in a motion; which joints go how far stands in the robot's file.

    Attributes:
        title: what it is, in a few words.
        course: time, s -> how far the joints are on their way, 1, and its rate, 1/s.
        period: after which it repeats itself, once it is in full swing, s.
    """

    title: str
    course: Callable[[float], tuple[float, float]]
    period: float


def kick_course(time: float) -> tuple[float, float]:
    """Forward and back within 0.7 s, then a pause of 1.3 s: s = sin^3(pi t / T), with no jump up to s''."""
    phase = (time - _START) % (_KICK + _PAUSE)
    if time < _START or phase >= _KICK:
        return 0.0, 0.0
    angle = math.pi * phase / _KICK
    sine = math.sin(angle)
    return sine**3, 3.0 * math.pi / _KICK * sine**2 * math.cos(angle)


def swing_course(time: float) -> tuple[float, float]:
    """To and fro once a second, growing smoothly within the first: s = e(t) sin(2 pi f t)."""
    t = time - _START
    if t <= 0.0:
        return 0.0, 0.0
    u = min(t / _GROWTH, 1.0)
    size, growing = u**2 * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u) / _GROWTH
    angle, rate = 2.0 * math.pi * _SWING * t, 2.0 * math.pi * _SWING
    return size * math.sin(angle), growing * math.sin(angle) + size * rate * math.cos(angle)


MOTIONS: dict[str, Motion] = {
    "kick": Motion("one leg kicks forward, again and again", kick_course, _KICK + _PAUSE),
    "arm-swing": Motion("both arms swing, once a second", swing_course, 1.0 / _SWING),
}


class MovingGoal:
    """A motion of one robot, and the angular momentum that is asked for meanwhile.

    Args:
        robot: the robot.
        home: the standing posture, with everything computed.
        stance: the feet that carry it, as indices.
        name: a motion of `MOTIONS`.
        angular_goal: `zero`, k_d = 0; or `reference`, the k_d of the motion by kinematics alone, with the CoM
            and the stance feet at rest (section 5.3.2).
        timestep: length of a tick, s.

    Attributes:
        reach: how far each joint goes (na,), rad.

    Raises:
        InputError: there is no such motion, or the robot's file does not say which joints it moves.
    """

    def __init__(
        self,
        robot: RobotModel,
        home: Dynamics,
        stance: tuple[int, ...],
        name: str,
        angular_goal: AngularGoal,
        timestep: float,
    ) -> None:
        self.reach = reach_of(robot, name)
        self._course = MOTIONS[name].course
        self._timestep = timestep
        self._period = round(MOTIONS[name].period / timestep)
        self._angular = np.zeros((1, 3))
        if angular_goal == "reference":
            self._angular = self._of_kinematics(robot, home, stance)

    def applied(self, reference: Reference, time: float) -> Reference:
        """The same goal with the motion in it, at a time, s."""
        way, rate = self._course(time)
        return dataclasses.replace(
            reference,
            posture=reference.posture + way * self.reach,
            posture_rate=rate * self.reach,
            angular_momentum=self.angular_momentum(time),
            angular_momentum_rate=self._angular_rate(time),
        )

    def _angular_rate(self, time: float) -> np.ndarray:
        """dk_d at a time, s (3,), N m: what a goal that moves needs besides Eq. 37, or k would lag behind."""
        dt = self._timestep
        ahead, behind = self.angular_momentum(time + dt), self.angular_momentum(max(0.0, time - dt))
        return np.asarray((ahead - behind) / (2.0 * dt))

    def angular_momentum(self, time: float) -> np.ndarray:
        """k_d at a time, s (3,), N m s; behind the ticks that were looked at it repeats the last period."""
        tick, known = round(time / self._timestep), len(self._angular)
        if known == 1:
            return np.asarray(self._angular[0])
        return np.asarray(
            self._angular[tick if tick < known else known - self._period + (tick - known) % self._period]
        )

    def _of_kinematics(self, robot: RobotModel, home: Dynamics, stance: tuple[int, ...]) -> np.ndarray:
        """k_d tick by tick (N, 3), N m s, until the motion has been in full swing for a period."""
        ticks = round((_START + _GROWTH) / self._timestep) + self._period
        rates = np.array([self._course(i * self._timestep)[1] * self.reach for i in range(ticks)])
        moved = reference_motion(robot, home.state.q, stance, np.zeros((ticks, 3)), rates, self._timestep)
        return moved.momentum[:, 3:]


def reach_of(robot: RobotModel, name: str) -> np.ndarray:
    """How far each joint of a robot goes in a motion (na,), rad.

    Raises:
        InputError: there is no such motion, or the robot's file does not say which joints it moves.
    """
    if name not in MOTIONS:
        raise InputError("motion", name, f"one of {', '.join(MOTIONS)}")
    patterns = robot.spec.motions.get(name)
    if not patterns:
        known = ", ".join(robot.spec.motions) or "none"
        raise InputError("motion", name, f"a motion that the file of {robot.spec.name} describes: {known}")
    reach = np.zeros(robot.na)
    for pattern, angle in patterns.items():
        joints = [i for i, joint in enumerate(robot.joint_names) if fnmatch.fnmatchcase(joint, pattern)]
        if not joints:
            raise InputError("motion", pattern, f"a joint of {robot.spec.name}")
        reach[joints] = angle
    return reach
