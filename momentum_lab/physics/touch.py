"""Which points of the robot may touch the ground, and how they move: soles always, other bodies in a fall."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from momentum_lab.compiled import compiled
from momentum_lab.physics.ground import Ground, Patch
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics, State

# Points this close to the ground take part in the contact problem, m.
_MARGIN = 0.01
# No point of a falling humanoid is faster than this, m/s; it bounds how long a clear body stays clear.
_FASTEST = 20.0


@dataclass(frozen=True, slots=True)
class Touch:
    """Points of one body on one plane.

    Attributes:
        position: the points in the world (n, 3), m.
        origin: the origin of the body's frame in the world (3,), m.
        frame_jacobian: velocity of the body's frame, world-aligned (6, nv).
        spread: from that to the velocities of the points in the axes of the plane, normal last (3 n, 6).
        gap: their heights above the plane (n,), m.
        patch: the plane.
        foot: which foot it is; None for every other body.
    """

    position: np.ndarray
    origin: np.ndarray
    frame_jacobian: np.ndarray
    spread: np.ndarray
    gap: np.ndarray
    patch: Patch
    foot: int | None = None


def sole_touches(robot: RobotModel, dynamics: Dynamics, ground: Ground) -> list[Touch]:
    """The four corners of each foot that is not wholly clear of the ground."""
    touches = (
        _sole_touch(sole.corners, dynamics, foot, ground.under_feet[foot])
        for foot, sole in enumerate(robot.soles)
    )
    return [touch for touch in touches if touch is not None]


def _sole_touch(corners: np.ndarray, dynamics: Dynamics, foot: int, patch: Patch) -> Touch | None:
    origin = dynamics.sole_position[foot]
    position, gap, spread, lowest = placed_points(
        corners, origin, dynamics.sole_rotation[foot], patch.origin, patch.rotation
    )
    if lowest > _MARGIN:
        return None
    return Touch(position, origin, dynamics.sole_jacobian[foot], spread, gap, patch, foot)


@compiled("f8[:, ::1](f8[:, ::1], f8[::1], f8[:, ::1])")
def spread_of(points: np.ndarray, origin: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Velocities of points from that of a frame they are fixed to: R^T [1, -S(p - o)] for each (3 n, 6).

    Args:
        points: p in the world (n, 3), m.
        origin: o of the frame in the world (3,), m.
        axes: R, in whose axes the velocities are given (3, 3).
    """
    spread = np.empty((3 * len(points), 6))
    for i in range(len(points)):
        x, y, z = points[i] - origin
        for k in range(3):
            ax, ay, az = axes[0, k], axes[1, k], axes[2, k]
            row = spread[3 * i + k]
            row[0], row[1], row[2] = ax, ay, az
            row[3], row[4], row[5] = az * y - ay * z, ax * z - az * x, ay * x - ax * y
    return spread


@compiled(
    "Tuple((f8[:, ::1], f8[::1], f8[:, ::1], f8))(f8[:, ::1], f8[::1], f8[:, ::1], f8[::1], f8[:, ::1])"
)
def placed_points(
    points: np.ndarray,
    origin: np.ndarray,
    rotation: np.ndarray,
    plane_origin: np.ndarray,
    plane_axes: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """Points of a frame over a plane.

    Args:
        points: in the frame (n, 3), m.
        origin: of the frame in the world (3,), m.
        rotation: axes of the frame in the world (3, 3).
        plane_origin: a point of the plane (3,), m.
        plane_axes: axes of the plane, its normal last (3, 3).

    Returns:
        Positions in the world (n, 3), heights above the plane (n,), `spread_of` them (3 n, 6), least height, m.
    """
    position, gap = np.empty_like(points), np.zeros(len(points))
    for i in range(len(points)):
        x, y, z = points[i]
        for k in range(3):
            position[i, k] = origin[k] + rotation[k, 0] * x + rotation[k, 1] * y + rotation[k, 2] * z
            gap[i] += (position[i, k] - plane_origin[k]) * plane_axes[k, 2]
    return position, gap, spread_of(position, origin, plane_axes), gap.min()


class BodyPoints:
    """The points of all bodies but the soles, looked at only when one of them may be near the floor.

    A clear body cannot reach the floor before its clearance divided by the largest possible speed has passed,
    so most steps need no kinematics. A state that does not follow the last one seen is always looked at.
    """

    def __init__(self, robot: RobotModel, timestep: float) -> None:
        model = robot.model
        links = [(model.frames[robot.frame(link)], points) for link, points in robot.spec.fall_points.items()]
        self._model, self._data = model, model.createData()
        self._joints = [int(frame.parentJoint) for frame, _ in links]
        self._points = [
            np.array([frame.placement.act(np.array(p)) for p in points]) for frame, points in links
        ]
        self._step_length = _FASTEST * timestep
        self._expected: State | None = None
        self._clearance = 0.0

    def follow(self, state: State) -> None:
        """Note that `state` is where the last step has led."""
        self._expected = state
        self._clearance -= self._step_length

    def touches(self, state: State, floor: Patch) -> list[Touch]:
        """The points near the floor, body by body."""
        if not self._points or (state is self._expected and self._clearance > _MARGIN):
            return []
        pin.computeJointJacobians(self._model, self._data, state.q)
        positions = [self._in_world(j, points) for j, points in zip(self._joints, self._points, strict=True)]
        gaps = [floor.gap(position) for position in positions]
        self._clearance = min(float(gap.min()) for gap in gaps)
        return [
            self._touch(joint, position[gap < _MARGIN], gap[gap < _MARGIN], floor)
            for joint, position, gap in zip(self._joints, positions, gaps, strict=True)
            if gap.min() < _MARGIN
        ]

    def _in_world(self, joint: int, points: np.ndarray) -> np.ndarray:
        placement = self._data.oMi[joint]
        return points @ placement.rotation.T + placement.translation

    def _touch(self, joint: int, position: np.ndarray, gap: np.ndarray, floor: Patch) -> Touch:
        jacobian = pin.getJointJacobian(
            self._model, self._data, joint, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        )
        origin = self._data.oMi[joint].translation.copy()
        return Touch(position, origin, jacobian, spread_of(position, origin, floor.rotation), gap, floor)
