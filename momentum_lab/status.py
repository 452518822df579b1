"""How the robot is doing, in plain words: one line that a person reads while the robot moves."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
import pinocchio as pin

from momentum_lab.fall import Fall
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.recording import Sample
from momentum_lab.robot.model import RobotModel

Kind = Literal["standing", "border", "lifted", "solver", "fallen", "stopped"]
StatusColor = Literal["green", "orange", "vermillion", "black"]

_COLORS: dict[Kind, StatusColor] = {
    "standing": "green",
    "border": "orange",
    "lifted": "orange",
    "solver": "vermillion",
    "fallen": "vermillion",
    "stopped": "black",
}
# A goal counts as lost when this part of the weight, or of weight times CoM height, is missing.
_LOST = 5e-3
# A desired CoP closer than this to the granted one is the same, m.
_SAME_POINT = 1e-3
# A foot that carries less than this part of the weight only touches.
_CARRIES = 2e-3


@dataclass(frozen=True, slots=True)
class Status:
    """One line about the robot.

    Attributes:
        kind: which of the few things that can be said.
        words: the line.
        color: the colour that goes with the kind; never the only difference.
    """

    kind: Kind
    words: str
    color: StatusColor


def status_of(
    sample: Sample,
    robot: RobotModel,
    fall: Fall | None = None,
    failure: str | None = None,
    stopped: str | None = None,
) -> Status:
    """The most important thing to say about a sample.

    Args:
        sample: the sample.
        robot: the robot it is about.
        fall: when and why it has fallen; None while it stands.
        failure: why the last solve had no answer; said when it concerns this sample.
        stopped: why the simulation has ended; None while it goes on.
    """
    if stopped is not None:
        return _status("stopped", f"stopped: {stopped}")
    if fall is not None:
        return _status("fallen", f"fallen at {fall.time:.2f} s: {fall.reason}")
    if sample.number("solver_failed") and failure is not None:
        return _status("solver", f"solver: {failure}")
    lost = lost_goals(sample, robot.mass)
    if lost:
        return _status("border", f"{_where(sample)}: {lost}")
    return _footing(sample, robot)


def carrying_feet(sample: Sample, mass: float) -> tuple[int, ...]:
    """The feet that press on the ground, as indices.

    Args:
        sample: the sample.
        mass: the robot's, kg.
    """
    least = _CARRIES * mass * GRAVITY
    return tuple(foot for foot, wrench in enumerate(sample["foot_wrench_measured"]) if wrench[2] > least)


def lost_goals(sample: Sample, mass: float) -> str:
    """Which momentum goals give way and by how much, in words; empty when both are met.

    The loss is |desired - admissible| of the linear rate (N) and of the angular rate (N m).
    """
    missing = sample["momentum_rate_desired"] - sample["momentum_rate_admissible"]
    weight = mass * GRAVITY
    linear, angular = float(np.linalg.norm(missing[:3])), float(np.linalg.norm(missing[3:]))
    words = []
    if linear > _LOST * weight:
        words.append(f"linear goal gives way by {linear:.0f} N")
    if angular > _LOST * weight * float(sample["com"][2]):
        words.append(f"angular goal gives way by {angular:.0f} N m")
    return " and ".join(words)


def _where(sample: Sample) -> str:
    """Which border stops the CoP, seen from the robot."""
    beyond = sample["cop_desired"] - sample["cop_admissible"]
    if not float(np.linalg.norm(beyond)) > _SAME_POINT:
        return "foot forces at their limit"
    heading = _heading(sample)
    forward = beyond[0] * math.cos(heading) + beyond[1] * math.sin(heading)
    left = beyond[1] * math.cos(heading) - beyond[0] * math.sin(heading)
    if abs(forward) >= abs(left):
        return "CoP on the toes" if forward > 0.0 else "CoP on the heels"
    return f"CoP on the {'left' if left > 0.0 else 'right'} border"


def _heading(sample: Sample) -> float:
    """Mean direction of the soles about the vertical, rad."""
    forward = sum(pin.XYZQUATToSE3(pose).rotation[:, 0] for pose in sample["sole_pose"])
    return math.atan2(forward[1], forward[0])


def _footing(sample: Sample, robot: RobotModel) -> Status:
    """On which feet the robot stands."""
    feet = carrying_feet(sample, robot.mass)
    if len(feet) == len(robot.soles):
        return _status("standing", "standing")
    if not feet:
        return _status("lifted", "no foot on the ground")
    names = " and ".join(robot.foot_names[foot] for foot in feet)
    return _status("standing", f"standing on the {names} foot")


def _status(kind: Kind, words: str) -> Status:
    return Status(kind, words, _COLORS[kind])
