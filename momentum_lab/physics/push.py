"""Pushes: a force on a body, at a point, for a time. Never a jump of the velocity."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Literal

import msgspec
import numpy as np
import pinocchio as pin

from momentum_lab.errors import InputError
from momentum_lab.momentum.wrench import cross
from momentum_lab.plain import plain
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics

MAX_FORCE = 5000.0
MAX_DURATION = 10.0
MAX_HEIGHT = 3.0
MAX_SPEED = 5.0
MAX_START = 3600.0
MAX_REACH = 3.0

Shape = Literal["rectangle", "half-sine"]
_MEAN_OF_SHAPE = {"rectangle": 1.0, "half-sine": 2.0 / math.pi}
_ABOVE_ZERO = math.ulp(0.0)
_RANGES = {
    "force": (0.0, MAX_FORCE, "N"),
    "velocity_change": (0.0, MAX_SPEED, "m/s"),
    "duration": (_ABOVE_ZERO, MAX_DURATION, "s"),
    "direction_deg": (-360.0, 360.0, "degrees"),
    "elevation_deg": (-90.0, 90.0, "degrees"),
    "start": (0.0, MAX_START, "s"),
    "height": (_ABOVE_ZERO, MAX_HEIGHT, "m"),
}
_Reach = Annotated[float, msgspec.Meta(ge=-MAX_REACH, le=MAX_REACH)]


class Push(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A force on one body of the robot; a horizontal one unless it says how far it points up.

    Its size is given either as a force or as the velocity that it gives to the CoM of the whole robot, which
    means the same on robots of any mass.

    Attributes:
        force: peak force, N; None when the velocity change is given.
        velocity_change: impulse divided by the robot's mass, m/s; None when the force is given.
        duration: how long it lasts, s.
        direction_deg: where it points in the world: 0 along x, forward for a robot that faces there; 90 along y,
            to its left; degrees.
        elevation_deg: how far it points up from there: 90 straight up, -90 straight down; degrees.
        start: when it begins, s of simulated time.
        height: height of its line of action above the ground, m; None: through the centre of mass.
        body: name of the pushed body in the robot's file, or of any link of its URDF; None: the trunk.
        shape: a rectangle in time, or a half sine.
        point: where it acts on the pushed body (3,), in that body's frame, m; it has no `height` then. None: on
            the vertical through the centre of mass.
    """

    force: Annotated[float, msgspec.Meta(ge=0.0, le=MAX_FORCE)] | None = None
    velocity_change: Annotated[float, msgspec.Meta(ge=0.0, le=MAX_SPEED)] | None = None
    duration: Annotated[float, msgspec.Meta(gt=0.0, le=MAX_DURATION)] = 0.1
    direction_deg: Annotated[float, msgspec.Meta(ge=-360.0, le=360.0)] = 0.0
    elevation_deg: Annotated[float, msgspec.Meta(ge=-90.0, le=90.0)] = 0.0
    start: Annotated[float, msgspec.Meta(ge=0.0, le=MAX_START)] = 0.5
    height: Annotated[float, msgspec.Meta(gt=0.0, le=MAX_HEIGHT)] | None = None
    body: str | None = None
    shape: Shape = "rectangle"
    point: tuple[_Reach, _Reach, _Reach] | None = None

    @property
    def direction(self) -> np.ndarray:
        """Unit vector of the force in the world (3,)."""
        return np.append(self.horizontal_part * self.along, math.sin(math.radians(self.elevation_deg)))

    @property
    def along(self) -> np.ndarray:
        """Unit vector over the ground (2,) in which it pushes, or would if it did not point up or down."""
        angle = math.radians(self.direction_deg)
        return np.array([math.cos(angle), math.sin(angle)])

    @property
    def horizontal_part(self) -> float:
        """The part of the force that is horizontal, from 0 to 1."""
        return math.cos(math.radians(self.elevation_deg))

    @property
    def towards(self) -> str:
        """Where it points, for people: `90°`, or `90°, 30° up`."""
        return f"{plain(self.direction_deg, 'g')}°{self.tilt}"

    @property
    def tilt(self) -> str:
        """How far it points up or down, for people; nothing for a horizontal one."""
        way = "up" if self.elevation_deg > 0.0 else "down"
        return f", {abs(self.elevation_deg):g}° {way}" if self.elevation_deg else ""

    @property
    def impulse(self) -> float:
        """The whole push: integral of the force, N s. A push without a force has to be sized for a mass first."""
        if self.force is None:
            raise InputError("push", "no force", "a push that is sized for a robot")
        return self.force * self.duration * _MEAN_OF_SHAPE[self.shape]

    def sized_for(self, mass: float) -> Push:
        """The same push with its force (N) for a robot of a mass (kg).

        Raises:
            InputError: neither or both of force and velocity change are given, or a number is out of range.
        """
        self._check_ranges()
        if (self.force is None) == (self.velocity_change is None):
            given = f"force {self.force}, velocity_change {self.velocity_change}"
            raise InputError("push", given, "either a force (N) or a velocity_change (m/s)")
        if self.velocity_change is None:
            return self
        force = self.velocity_change * mass / (self.duration * _MEAN_OF_SHAPE[self.shape])
        return msgspec.structs.replace(self, force=force, velocity_change=None)

    def _check_ranges(self) -> None:
        """Refuse numbers that a push read from a file could not have, NaN among them."""
        for field, (low, high, unit) in _RANGES.items():
            value = getattr(self, field)
            if value is not None and not low <= value <= high:
                lowest = "above 0" if low == _ABOVE_ZERO else f"from {low:g}"
                raise InputError(field, value, f"{lowest} to {high:g} {unit}")
        if self.point is None:
            return
        if self.height is not None:
            raise InputError("push", f"height {self.height} and point {self.point}", "one of the two")
        if len(self.point) != 3 or not all(abs(x) <= MAX_REACH for x in self.point):
            raise InputError("point", self.point, f"three numbers from {-MAX_REACH:g} to {MAX_REACH:g} m")

    def delivered(self, time: float) -> float:
        """Impulse delivered from the start of the push until `time`, N s."""
        elapsed = min(max(time - self.start, 0.0), self.duration)
        if self.shape == "rectangle":
            return self.impulse * elapsed / self.duration
        return self.impulse * 0.5 * (1.0 - math.cos(math.pi * elapsed / self.duration))

    def mean_force(self, time: float, timestep: float) -> float:
        """Mean force over [time, time + timestep], N: the impulse is exact whatever the step."""
        return (self.delivered(time + timestep) - self.delivered(time)) / timestep

    def point_of_action(self, dynamics: Dynamics, placement: pin.SE3) -> np.ndarray:
        """A point of the line of action in the world (3,), m: the push's own, or over the CoM at its height.

        Args:
            dynamics: the robot's state with everything computed.
            placement: of the pushed body in the world.
        """
        if self.point is not None:
            fixed: np.ndarray = placement.act(np.array(self.point))
            return fixed
        point = dynamics.com_in_world.copy()
        if self.height is not None:
            point[2] = dynamics.sole_position[:, 2].min() + self.height
        return point


@dataclass(frozen=True, slots=True)
class AppliedPush:
    """What all pushes together do to the robot during one step.

    Attributes:
        wrench: force and moment about the world origin (6,), N and N m.
        generalized: the same as generalized forces (nv,).
    """

    wrench: np.ndarray
    generalized: np.ndarray


def apply_pushes(
    robot: RobotModel,
    data: pin.Data,
    dynamics: Dynamics,
    pushes: tuple[Push, ...],
    time: float,
    timestep: float,
) -> AppliedPush | None:
    """Wrench and generalized forces of the pushes that act in [time, time + timestep]; None when none does.

    tau = J_b^T w_b with the wrench w_b = (F, (c - o_b) x F) about the origin o_b of the pushed body.

    Args:
        robot: the robot.
        data: Pinocchio data that may be overwritten.
        dynamics: the robot's state with everything computed.
        pushes: all pushes of the run.
        time: start of the step, s.
        timestep: length of the step, s.
    """
    active = [p for p in pushes if p.start < time + timestep and time < p.start + p.duration]
    if not active:
        return None
    wrench, generalized = np.zeros(6), np.zeros(robot.nv)
    for push in active:
        force = push.mean_force(time, timestep) * push.direction
        frame = pushed_frame(robot, push)
        jacobian = pin.computeFrameJacobian(
            robot.model, data, dynamics.state.q, frame, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        )
        point = push.point_of_action(dynamics, data.oMf[frame])
        lever = point - data.oMf[frame].translation
        wrench += np.concatenate([force, cross(point, force)])
        generalized += jacobian.T @ np.concatenate([force, cross(lever, force)])
    return AppliedPush(wrench, generalized)


def pushed_frame(robot: RobotModel, push: Push) -> int:
    """Index of the frame a push acts on.

    Raises:
        InputError: the robot has no such body.
    """
    if push.body is None:
        return robot.trunk
    link = robot.spec.push_bodies.get(push.body, push.body)
    if not robot.model.existFrame(link, pin.FrameType.BODY):
        raise InputError(
            "body", push.body, f"one of {', '.join(robot.spec.push_bodies)}, or a link of the robot"
        )
    return robot.frame(link)
