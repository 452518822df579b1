"""Motions on top of standing or in the air, and which angular momentum goes with them (section 5.3.2)."""

from __future__ import annotations

import dataclasses
import fnmatch
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from momentum_lab.control.controller import JointMotion, Reference
from momentum_lab.errors import InputError
from momentum_lab.momentum.reference_motion import reference_motion
from momentum_lab.robot.catalog import RobotSpec
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics

AngularGoal = Literal["zero", "reference"]
ANGULAR_GOALS: tuple[AngularGoal, ...] = ("zero", "reference")
# The robot stands for a moment before it moves, s; a swing grows to its full size within so long, s.
_START, _GROWTH = 0.5, 1.0
_KICK, _PAUSE = 0.7, 1.3
_REACH, _HOLD, _REST = 0.6, 0.2, 0.6
_SWING = 1.0
# A loop in the air starts at once and takes so long, s; this part of it is getting up to speed, as much is
# stopping; then the legs rest.
_LOOP_START, _LOOP, _LOOP_RAMP, _LOOP_PAUSE = 0.02, 0.7, 0.25, 1.28

# How far joints are on their way, 1, and its rate, 1/s, at a time, s.
Course = Callable[[float], tuple[float, float]]


@dataclass(frozen=True, slots=True)
class Motion:
    """What all robots have in common in a motion; which joints go how far stands in the robot's file.

    Attributes:
        title: what it is, in a few words.
        courses: which joints move, a table of the robot's file -> the course they take.
        period: after which it repeats itself, once it is in full swing, s.
        where: a motion for the air does nothing while a foot is on the ground.
    """

    title: str
    courses: Mapping[str, Course]
    period: float
    where: Literal["ground", "air"] = "ground"


def kick_course(time: float) -> tuple[float, float]:
    """Forward and back within 0.7 s, then a pause of 1.3 s: s = sin^3(pi t / T), with no jump up to s''."""
    phase = (time - _START) % (_KICK + _PAUSE)
    if time < _START or phase >= _KICK:
        return 0.0, 0.0
    angle = math.pi * phase / _KICK
    sine = math.sin(angle)
    return sine**3, 3.0 * math.pi / _KICK * sine**2 * math.cos(angle)


def reach_course(time: float) -> tuple[float, float]:
    """Out within 0.6 s, held for 0.2 s, back within 0.6 s, then a pause as long.

    s = 10 u^3 - 15 u^4 + 6 u^5, with no jump up to s'' (minimum jerk).
    """
    if time < _START:
        return 0.0, 0.0
    t = (time - _START) % (2.0 * _REACH + _HOLD + _REST)
    away, back = min(t / _REACH, 1.0), min(max(0.0, t - _REACH - _HOLD) / _REACH, 1.0)
    way = [u**3 * (10.0 - 15.0 * u + 6.0 * u**2) for u in (away, back)]
    rate = [30.0 * (u * (1.0 - u)) ** 2 / _REACH for u in (away, back)]
    return way[0] - way[1], rate[0] - rate[1]


def swing_course(time: float) -> tuple[float, float]:
    """To and fro once a second, growing smoothly within the first: s = e(t) sin(2 pi f t)."""
    t = time - _START
    if t <= 0.0:
        return 0.0, 0.0
    u = min(t / _GROWTH, 1.0)
    size, growing = u**2 * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u) / _GROWTH
    angle, rate = 2.0 * math.pi * _SWING * t, 2.0 * math.pi * _SWING
    return size * math.sin(angle), growing * math.sin(angle) + size * rate * math.cos(angle)


def loop_angle(time: float) -> tuple[float, float]:
    """How far a loop is, from 0 to 2 pi, rad, and its rate, rad/s: at a constant speed between smooth ramps."""
    u = (time - _LOOP_START) % (_LOOP + _LOOP_PAUSE) / _LOOP
    if time < _LOOP_START or u >= 1.0:
        return 0.0, 0.0
    early, peak = min(u, 1.0 - u), 2.0 * math.pi / (1.0 - _LOOP_RAMP)
    ramp = min(early / _LOOP_RAMP, 1.0)
    turned = peak * (early - _LOOP_RAMP * (ramp / 2.0 + math.sin(math.pi * ramp) / (2.0 * math.pi)))
    rate = peak * math.sin(0.5 * math.pi * ramp) ** 2 / _LOOP
    return (turned if u <= 0.5 else 2.0 * math.pi - turned), rate


def across_course(time: float) -> tuple[float, float]:
    """To one side, back and to the other side, once around the loop: s = sin(phi)."""
    angle, rate = loop_angle(time)
    return math.sin(angle), rate * math.cos(angle)


def back_across_course(time: float) -> tuple[float, float]:
    """The other side first: the same loop the other way round, s = sin(-phi)."""
    way, rate = across_course(time)
    return -way, -rate


def out_course(time: float) -> tuple[float, float]:
    """Out and in again, once around the loop: s = (1 - cos(phi)) / 2."""
    angle, rate = loop_angle(time)
    return 0.5 * (1.0 - math.cos(angle)), 0.5 * rate * math.sin(angle)


MOTIONS: dict[str, Motion] = {
    "kick": Motion("one leg kicks forward, again and again", {"kick": kick_course}, _KICK + _PAUSE),
    "reach": Motion(
        "the right hand reaches forward and comes back, again and again",
        {"reach": reach_course},
        2.0 * _REACH + _HOLD + _REST,
    ),
    "arm-swing": Motion("both arms swing, once a second", {"arm-swing": swing_course}, 1.0 / _SWING),
    "cat-left": Motion(
        "in the air: a loop of the legs that turns the body to the left",
        {"scissors": across_course, "spread": out_course},
        _LOOP + _LOOP_PAUSE,
        "air",
    ),
    "cat-right": Motion(
        "in the air: the same loop the other way round, and so the body",
        {"scissors": back_across_course, "spread": out_course},
        _LOOP + _LOOP_PAUSE,
        "air",
    ),
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
        reach: how far each joint goes on each course (courses, na), rad.

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
        self._motion = MOTIONS[name]
        self._timestep = timestep
        self._period = round(MOTIONS[name].period / timestep)
        self._angular = np.zeros((1, 3))
        if angular_goal == "reference":
            self._angular = self._of_kinematics(robot, home, stance)

    def applied(self, reference: Reference, time: float) -> Reference:
        """The same goal with the motion in it, at a time, s."""
        moved, rate = self.joints(time)
        if self._motion.where == "air":
            later = self.joints(time + self._timestep)[1]
            flown = JointMotion(reference.posture + moved, rate, (later - rate) / self._timestep)
            return dataclasses.replace(reference, in_the_air=flown)
        return dataclasses.replace(
            reference,
            posture=reference.posture + moved,
            posture_rate=rate,
            angular_momentum=self.angular_momentum(time),
            angular_momentum_rate=self._angular_rate(time),
        )

    def joints(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """How far each joint is from its posture (na,), rad, and its rate (na,), rad/s, at a time, s."""
        ways, rates = np.array([course(time) for course in self._motion.courses.values()]).T
        return ways @ self.reach, rates @ self.reach

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
        rates = np.array([self.joints(i * self._timestep)[1] for i in range(ticks)])
        moved = reference_motion(robot, home.state.q, stance, np.zeros((ticks, 3)), rates, self._timestep)
        return moved.momentum[:, 3:]


def reach_of(robot: RobotModel, name: str) -> np.ndarray:
    """How far each joint of a robot goes on each course of a motion (courses, na), rad.

    Raises:
        InputError: there is no such motion, or the robot's file does not say which joints it moves.
    """
    if name not in MOTIONS:
        raise InputError("motion", name, f"one of {', '.join(MOTIONS)}")
    known = motions_of(robot.spec)
    if name not in known:
        described = ", ".join(known) or "none"
        raise InputError(
            "motion", name, f"a motion that the file of {robot.spec.name} describes: {described}"
        )
    reach = np.zeros((len(MOTIONS[name].courses), robot.na))
    for row, table in zip(reach, MOTIONS[name].courses, strict=True):
        for pattern, angle in robot.spec.motions[table].items():
            row[_joints(robot, pattern)] = angle
    return reach


def motions_of(spec: RobotSpec) -> list[str]:
    """The motions whose joints a robot's file describes."""
    return [name for name, motion in MOTIONS.items() if all(spec.motions.get(key) for key in motion.courses)]


def _joints(robot: RobotModel, pattern: str) -> list[int]:
    joints = [i for i, joint in enumerate(robot.joint_names) if fnmatch.fnmatchcase(joint, pattern)]
    if not joints:
        raise InputError("motion", pattern, f"a joint of {robot.spec.name}")
    return joints
