"""How the robot is doing, in plain words: one line that a person reads while the robot moves."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from momentum_lab.active_bounds import TORQUE, Active, heading_of, pressed_feet
from momentum_lab.control.sole_bounds import FRICTION, HEEL, LEAST, TOES, TWIST
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
SOME_LIMIT = "foot forces at their limit"
"""What is said where nothing is known that stops the forces."""
IN_THE_AIR = "in the air: no ground to push on, angular momentum is kept"
"""What is said while no foot carries anything: then the ground can change neither momentum."""

# Bounds that stop forces wherever the CoP is.
_OF_FORCES = frozenset({FRICTION, TWIST, LEAST, TORQUE})
_HEELS = "CoP on the heels"
# Bounds of single feet that stop the CoP of all at a border; the sides have edges of one foot or of both.
_EDGES = {TOES: frozenset({TOES}), _HEELS: frozenset({HEEL})}
_SIDES = frozenset(f"CoP on the {side} edge" for side in ("inner", "outer", "left", "right"))


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
    held: Sequence[Active] | None = None,
) -> Status:
    """The most important thing to say about a sample.

    Args:
        sample: the sample.
        robot: the robot it is about.
        fall: when and why it has fallen; None while it stands.
        failure: why the last solve had no answer; said when it concerns this sample.
        stopped: why the simulation has ended; None while it goes on.
        held: the bounds that are active; None: not known.
    """
    if stopped is not None:
        return _status("stopped", f"stopped: {stopped}")
    if fall is not None:
        return _status("fallen", f"fallen at {fall.time:.2f} s: {fall.reason}")
    if sample.number("solver_failed") and failure is not None:
        return _status("solver", f"solver: {failure}")
    if not carrying_feet(sample, robot.mass):
        return _status("lifted", IN_THE_AIR)  # no bound holds back what there is no ground for
    lost = lost_goals(sample, robot.mass)
    if lost:
        return _status("border", f"{_where(sample, held)}: {lost}")
    return _footing(sample, robot)


def carrying_feet(sample: Sample, mass: float) -> tuple[int, ...]:
    """The feet that press on the ground, as indices.

    Args:
        sample: the sample.
        mass: the robot's, kg.
    """
    return pressed_feet(sample["foot_wrench_measured"], mass)


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


def _where(sample: Sample, held: Sequence[Active] | None) -> str:
    """What stops the forces: the border that the CoP should cross if it is there, or else another active bound."""
    border = _border(sample)
    if held is None:
        return border or SOME_LIMIT
    active = {bound.what for bound in held}
    if border and not _EDGES.get(border, _SIDES).isdisjoint(active):
        return border
    forces = (f"{bound.what} ({bound.holder})" for bound in held if bound.what in _OF_FORCES)
    return next(forces, border or SOME_LIMIT)


def _border(sample: Sample) -> str:
    """Which border the desired CoP is beyond, seen from the robot; empty if it is the granted one."""
    beyond = sample["cop_desired"] - sample["cop_admissible"]
    if not float(np.linalg.norm(beyond)) > _SAME_POINT:
        return ""
    heading = heading_of(sample)
    forward = beyond[0] * math.cos(heading) + beyond[1] * math.sin(heading)
    left = beyond[1] * math.cos(heading) - beyond[0] * math.sin(heading)
    if abs(forward) >= abs(left):
        return TOES if forward > 0.0 else _HEELS
    return f"CoP on the {'left' if left > 0.0 else 'right'} border"


def _footing(sample: Sample, robot: RobotModel) -> Status:
    """On which feet the robot stands."""
    feet = carrying_feet(sample, robot.mass)
    if len(feet) == len(robot.soles):
        return _status("standing", "standing")
    names = " and ".join(robot.foot_names[foot] for foot in feet)
    return _status("standing", f"standing on the {names} foot")


def _status(kind: Kind, words: str) -> Status:
    return Status(kind, words, _COLORS[kind])
