"""Which bounds a sample presses against: of feet, joints and motors; what was asked for, and what was granted."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from momentum_lab.control.acceleration_terms import BEFORE_THE_STOP
from momentum_lab.control.controller import SLACKS
from momentum_lab.control.gains import declared_gains
from momentum_lab.control.sole_bounds import (
    FRICTION,
    HEEL,
    LEFT,
    RIGHT,
    TOES,
    Used,
    trust_of,
    used_of_ground,
    used_of_trust,
)
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.recording import Sample
from momentum_lab.robot.model import RobotModel
from momentum_lab.session import Session

ACTIVE = 0.99
"""A bound counts as active from this part of its limit on; for a CoP that is a millimetre of a large sole."""

TORQUE = "torque limit"
# A foot that carries less than this part of the weight only touches.
_CARRIES = 2e-3
# A joint counts as stopped when it is this part of its range from where controllers brake it.
_NEAR = 0.01
# A slack that is smaller than this is none, m/s^2 and rad/s^2.
_LEAST_SLACK = 0.01
# Of a run one sample in so much time is looked at, s, and not more samples than a person waits for.
_LOOK, _MOST_LOOKS = 0.005, 4000
_NO_LOAD = "no load"
# The ground's own bounds by their names in `used_of_ground`: there, the foot does not stay as it is.
_OF_GROUND = {
    TOES: "tips over the toes",
    HEEL: "tips over the heel",
    LEFT: "tips over the left edge",
    RIGHT: "tips over the right edge",
    FRICTION: "slides",
}


@dataclass(frozen=True, slots=True)
class Situation:
    """What has to be known besides a sample.

    Attributes:
        robot: the robot as its controller believes it to be.
        controller: its name.
        gains: its gains.
        friction: Coulomb coefficient of the ground under each foot (F,).
        torque_scale: the part of their torque limits that the motors can really give.
    """

    robot: RobotModel
    controller: str
    gains: Mapping[str, float]
    friction: tuple[float, ...]
    torque_scale: float = 1.0


@dataclass(frozen=True, slots=True)
class Active:
    """One bound that is active.

    Attributes:
        holder: the foot or joint that is held by it.
        what: the bound, in words.
    """

    holder: str
    what: str


@dataclass(frozen=True, slots=True)
class Goal:
    """What was asked for and what was granted.

    Attributes:
        name: of the goal.
        unit: its unit.
        asked: what the feedback laws ask for, with its sign.
        granted: what the bounds leave of it.
    """

    name: str
    unit: str
    asked: float
    granted: float

    @property
    def missing(self) -> float:
        """What was asked for and not granted."""
        return self.asked - self.granted


@dataclass(frozen=True, slots=True)
class Bounds:
    """All that holds a robot back in one sample.

    Attributes:
        feet: the active bounds of each foot, in the robot's order.
        joints: the active bounds of joints and motors.
        goals: rates of both momenta and the CoP, component by component.
        slacks: name, size and unit of what outputs have to do without.
    """

    feet: tuple[tuple[Active, ...], ...]
    joints: tuple[Active, ...]
    goals: tuple[Goal, ...]
    slacks: tuple[tuple[str, float, str], ...]

    @property
    def active(self) -> tuple[Active, ...]:
        """All active bounds, feet first."""
        return (*(bound for foot in self.feet for bound in foot), *self.joints)


def bounds_of(sample: Sample, situation: Situation) -> Bounds:
    """The active bounds of a sample, from what was recorded in it and the limits.

    A foot is held by what its controller trusts in (`Trust`; the admissible wrench decides), by the ground itself
    (the measured one does), or carries nothing. A torque is the one after the motor's limit. Controllers brake a
    joint 0.03 rad before its stop.
    """
    return Bounds(_feet(sample, situation), _joints(sample, situation), goals_of(sample), slacks_of(sample))


def goals_of(sample: Sample) -> tuple[Goal, ...]:
    """Both momentum rates, N and N m, and the CoP seen from the middle of what carries, mm, along the robot's axes.

    Ahead and left are where the soles point on average, up is the vertical; a rate of angular momentum about
    "left" turns the robot forward.
    """
    axes = _axes(sample)
    rates = [sample[f"momentum_rate_{kind}"].reshape(2, 3) @ axes.T for kind in ("desired", "admissible")]
    found = [
        Goal(f"{name} {axis}", unit, *(float(rate[row, column]) for rate in rates))
        for row, (name, unit) in enumerate((("linear rate,", "N"), ("angular rate about", "N m")))
        for column, axis in enumerate(("ahead", "left", "up"))
    ]
    carrying = sample["foot_wrench_measured"][:, 2] > 0.0
    middle = sample["sole_pose"][carrying if carrying.any() else slice(None), :2].mean(axis=0)
    cops = [1e3 * axes[:2, :2] @ (sample[name] - middle) for name in ("cop_desired", "cop_admissible")]
    found += [
        Goal(f"CoP {axis}", "mm", *(float(cop[row]) for cop in cops))
        for row, axis in enumerate(("ahead", "left"))
    ]
    return tuple(found)


def _axes(sample: Sample) -> np.ndarray:
    """Ahead, left and up as rows of unit vectors in the world (3, 3)."""
    turn = heading_of(sample)
    ahead, left = (math.cos(turn), math.sin(turn), 0.0), (-math.sin(turn), math.cos(turn), 0.0)
    return np.array([ahead, left, (0.0, 0.0, 1.0)])


def slacks_of(sample: Sample) -> tuple[tuple[str, float, str], ...]:
    """The slacks that are not zero, by name."""
    return tuple(
        (name, size, "m/s^2" if name.startswith("com") else "rad/s^2")
        for name, size in zip(SLACKS, sample["slack"].tolist(), strict=True)
        if abs(size) > _LEAST_SLACK
    )


def pressed_feet(wrenches: np.ndarray, mass: float) -> tuple[int, ...]:
    """The feet that the ground carries, as indices.

    Args:
        wrenches: of the ground on the feet, world axes (F, 6), N and N m.
        mass: the robot's, kg.
    """
    return tuple(np.flatnonzero(wrenches[:, 2] > _CARRIES * mass * GRAVITY).tolist())


def heading_of(sample: Sample) -> float:
    """Mean direction of the soles about the vertical, rad."""
    forward = sum(pin.XYZQUATToSE3(pose).rotation[:, 0] for pose in sample["sole_pose"])
    return math.atan2(forward[1], forward[0])


def in_words(active: Iterable[Active]) -> str:
    """Active bounds in one line, those of one holder together."""
    held: dict[str, list[str]] = {}
    for bound in active:
        held.setdefault(bound.holder, []).append(bound.what)
    return "; ".join(f"{holder}: {', '.join(words)}" for holder, words in held.items())


def held_for(session: Session) -> dict[Active, float]:
    """How long each bound was active in a recording, s, the longest first; gains and controller as they are now."""
    timestep, most = session.scenario.timestep, math.ceil(len(session.recording) / _MOST_LOOKS)
    every = max(1, round(_LOOK / timestep), most)
    layout, ground = session.recording.layout, session.ground
    choices, times = session.choices, Counter[Active]()
    gains = {name: float(getattr(choices.gains, name)) for name in declared_gains(choices.gains)}
    for row in session.recording.rows(every):
        sample = Sample.of(layout, row)
        friction = tuple(ground.friction(sample.number("time")).tolist())
        scale = choices.mismatch.torque_scale
        situation = Situation(session.robot, choices.controller, gains, friction, scale)
        times.update(bounds_of(sample, situation).active)
    return {bound: count * every * timestep for bound, count in times.most_common()}


def _feet(sample: Sample, situation: Situation) -> tuple[tuple[Active, ...], ...]:
    """What holds each foot: its controller's trust, then the ground."""
    robot = situation.robot
    asked, measured = sample["foot_wrench_admissible"], sample["foot_wrench_measured"]
    counted, pressing = pressed_feet(asked, robot.mass), pressed_feet(measured, robot.mass)
    trust = trust_of(situation.controller, situation.gains, robot.mass * GRAVITY, len(counted))
    poses = [pin.XYZQUATToSE3(pose) for pose in sample["sole_pose"]]
    found = []
    for foot, sole in enumerate(robot.soles):
        turn, used, real = poses[foot].rotation, Used(), {_NO_LOAD: 1.0}
        if trust is not None and foot in counted:
            used = used_of_trust(asked[foot], turn, sole, trust)
        if foot in pressing:
            ground = used_of_ground(measured[foot], turn, sole, situation.friction[foot])
            real = {_OF_GROUND[name]: part for name, part in ground.items()}
        sides = _sides(poses, foot)
        held = [name for name, part in (used | real).items() if part >= ACTIVE]
        found.append(tuple(Active(f"{sole.name} foot", _beside(name, sides)) for name in held))
    return tuple(found)


def _sides(poses: list[pin.SE3], foot: int) -> tuple[str, str]:
    """What the left and the right edge of a foot are called: the inner one is on the side of the other feet."""
    others = [poses[foot].actInv(pose).translation[1] for i, pose in enumerate(poses) if i != foot]
    if not others:
        return "left", "right"
    return ("inner", "outer") if sum(others) > 0.0 else ("outer", "inner")


def _beside(words: str, sides: tuple[str, str]) -> str:
    """A bound with its edge named as seen from the other foot."""
    return words.replace("left edge", f"{sides[0]} edge").replace("right edge", f"{sides[1]} edge")


def _joints(sample: Sample, situation: Situation) -> tuple[Active, ...]:
    """Motors at their largest torque, and joints at the end of their range or at their largest speed."""
    robot, angle, speed = situation.robot, sample["q"][7:], np.abs(sample["v"][6:])
    motors = np.abs(sample["torque"]) >= ACTIVE * situation.torque_scale * robot.effort_limit
    reach = BEFORE_THE_STOP + _NEAR * (robot.position_upper - robot.position_lower)
    ends = (angle <= robot.position_lower + reach) | (angle >= robot.position_upper - reach)
    fast = speed >= ACTIVE * robot.model.velocityLimit[6:]
    words = ((TORQUE, motors), ("end of its range", ends), ("speed limit", fast))
    return tuple(
        Active(name, what)
        for joint, name in enumerate(robot.joint_names)
        for what, there in words
        if there[joint]
    )
