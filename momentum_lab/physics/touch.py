"""Which points of the robot may touch the ground, and how they move: soles always, other bodies in a fall."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

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
        jacobian: their velocities in the axes of the plane, normal last (3 n, nv).
        gap: their heights above the plane (n,), m.
        patch: the plane.
        foot: which foot it is; None for every other body.
    """

    position: np.ndarray
    jacobian: np.ndarray
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
    arms = corners @ dynamics.sole_rotation[foot].T
    position = dynamics.sole_position[foot] + arms
    gap = patch.gap(position)
    if gap.min() > _MARGIN:
        return None
    return Touch(position, _point_jacobian(arms, dynamics.sole_jacobian[foot], patch), gap, patch, foot)


def _point_jacobian(arms: np.ndarray, jacobian: np.ndarray, patch: Patch) -> np.ndarray:
    """Velocities of points at `arms` (n, 3) from the origin of a frame with the given Jacobian (6, nv).

    u = R^T [1, -S(arm)] J for each point, R the axes of the plane.
    """
    count = len(arms)
    shift = np.zeros((count, 3, 6))
    shift[:, (0, 1, 2), (0, 1, 2)] = 1.0
    shift[:, (0, 1, 2), (4, 5, 3)] = arms[:, (2, 0, 1)]
    shift[:, (0, 1, 2), (5, 3, 4)] = -arms[:, (1, 2, 0)]
    return (patch.rotation.T @ shift).reshape(3 * count, 6) @ jacobian


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
        arms = position - self._data.oMi[joint].translation
        return Touch(position, _point_jacobian(arms, jacobian, floor), gap, floor)
