"""Which points of all bodies but the soles may touch the floor, and how they move: in a fall."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from momentum_lab.compiled import compiled
from momentum_lab.physics.contact import Contacts
from momentum_lab.physics.ground import Patch
from momentum_lab.physics.touch import MARGIN, Touches, spread_of
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import State
from momentum_lab.robot.terms import Frames, jacobian_at, memory_of

_MATRIX, _VECTOR = "f8[:, ::1]", "f8[::1]"


class BodyPoints:
    """The points of all bodies but the soles, looked at only when one of them may be near the floor.

    No point of a body is faster than the sum of what each velocity of the robot can move it by, |v_j| times the
    longest lever there can be. Until that has used up its clearance, the body cannot have reached the floor, and
    no kinematics are needed. A state that does not follow the last one seen is always looked at.

    Attributes:
        reach: how far a unit of each velocity can move any point of each body in a step (B, nv), m s.
    """

    def __init__(self, robot: RobotModel, timestep: float) -> None:
        model, links = robot.model, robot.spec.fall_points
        self._model, self._data = model, model.createData()
        self._memory = memory_of(self._data)
        self._frames = Frames.of(model, [robot.frame(link) for link in links])
        placed = [
            [model.frames[robot.frame(link)].placement.act(np.array(point)) for point in points]
            for link, points in links.items()
        ]
        self._points = np.array([point for points in placed for point in points]).reshape(-1, 3)
        self._body = np.repeat(np.arange(len(placed)), [len(points) for points in placed])
        joints = zip(self._frames.joint.tolist(), placed, strict=True)
        reaches = [reach_of(model, joint, np.array(points)) for joint, points in joints]
        self.reach = timestep * np.array(reaches).reshape(-1, model.nv)
        self._expected: State | None = None
        self._clearance = np.zeros(len(placed))
        self._clear = False

    def follow(self, state: State) -> None:
        """Note that `state` is where the last step has led."""
        self._expected = state
        self._clear = still_clear(self._clearance, self.reach, state.v)

    def touches(self, state: State, floor: Patch) -> Touches | None:
        """The points near the floor, body by body; None when there are none."""
        if not self._points.size or (self._clear and state is self._expected):
            return None
        pin.forwardKinematics(self._model, self._data, state.q)
        memory, frames, axes = self._memory, self._frames, np.ascontiguousarray(floor.rotation)
        position, gap, self._clearance = placed_bodies(
            memory.joint_position,
            memory.joint_rotation,
            frames.joint,
            self._body,
            self._points,
            floor.origin,
            axes[:, 2].copy(),
        )
        if not self._clearance.min() < MARGIN:  # so that NaN, too, touches nothing
            return None
        pin.computeJointJacobians(self._model, self._data)
        *contacts, position, origin, foot = touching_bodies(
            memory.joint_position,
            memory.joint_jacobian,
            frames.joint,
            frames.moved_by,
            self._body,
            position,
            gap,
            axes,
            floor.friction,
        )
        return Touches(Contacts(*contacts), position, origin, foot)


def reach_of(model: pin.Model, joint: int, points: np.ndarray) -> np.ndarray:
    """How fast a unit of each velocity of the robot can at most move any of a body's points (nv,), m or none.

    Args:
        model: a tree of revolute joints on a free-flyer.
        joint: what carries the body.
        points: in the frame of that joint (n, 3), m.
    """
    reach, lever = np.zeros(model.nv), float(np.linalg.norm(points, axis=1).max())
    while joint > 1:
        reach[model.idx_vs[joint]] = lever
        lever += float(np.linalg.norm(model.jointPlacements[joint].translation))
        joint = model.parents[joint]
    reach[:3], reach[3:6] = 1.0, lever
    return reach


@compiled(
    f"Tuple(({_MATRIX}, {_VECTOR}, {_VECTOR}))"
    f"(f8[:, :], f8[:, :, :], i8[::1], i8[::1], {_MATRIX}, {_VECTOR}, {_VECTOR})"
)
def placed_bodies(
    joint_position: np.ndarray,
    joint_rotation: np.ndarray,
    joint: np.ndarray,
    body: np.ndarray,
    points: np.ndarray,
    plane_origin: np.ndarray,
    normal: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Where the points of bodies are, over one plane.

    Args:
        joint_position: origins of all joints in the world (njoints, 3), m.
        joint_rotation: their axes (njoints, 3, 3).
        joint: which joint carries each body (B,).
        body: which body each point is on (P,).
        points: in the frames of those joints (P, 3), m.
        plane_origin: a point of the plane (3,), m.
        normal: of the plane (3,).

    Returns:
        Positions (P, 3), gaps (P,) and the least gap of each body (B,), m; NaN where a state is not finite.
    """
    position, gap = np.empty_like(points), np.zeros(len(points))
    clearance = np.full(len(joint), np.inf)
    for i in range(len(points)):
        place, turn = joint_position[joint[body[i]]], joint_rotation[joint[body[i]]]
        for k in range(3):
            position[i, k] = place[k]
            for j in range(3):
                position[i, k] += turn[k, j] * points[i, j]
            gap[i] += (position[i, k] - plane_origin[k]) * normal[k]
        if not gap[i] > clearance[body[i]]:
            clearance[body[i]] = gap[i]
    return position, gap, clearance


@compiled(
    f"Tuple(({_MATRIX}, {_MATRIX}, {_VECTOR}, {_VECTOR}, {_VECTOR}, {_MATRIX}, {_MATRIX}, i8[::1]))"
    f"(f8[:, :], f8[::1, :], i8[::1], {_MATRIX}, i8[::1], {_MATRIX}, {_VECTOR}, {_MATRIX}, f8)"
)
def touching_bodies(
    joint_position: np.ndarray,
    joint_jacobian: np.ndarray,
    joint: np.ndarray,
    moved_by: np.ndarray,
    body: np.ndarray,
    position: np.ndarray,
    gap: np.ndarray,
    plane_axes: np.ndarray,
    friction: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The points near a plane at rest, and how the bodies they are on move.

    Args:
        joint_position: origins of all joints in the world (njoints, 3), m.
        joint_jacobian: spatial velocities about the world origin, of which each joint is a column (6, nv).
        joint: which joint carries each body (B,).
        moved_by: 1 for velocities that move a body, 0 for all others (B, nv).
        body: which body each point is on, in ascending order (P,).
        position: of the points in the world (P, 3), m.
        gap: of the points (P,), m.
        plane_axes: axes of the plane, its normal last (3, 3).
        friction: Coulomb coefficient of the plane.

    Returns:
        As `placed_soles`, for the bodies that have a point near the plane, and those points of theirs.
    """
    near = np.flatnonzero(gap < MARGIN)
    bodies = np.unique(body[near])
    jacobian, origin = np.empty((6 * len(bodies), moved_by.shape[1])), np.empty((len(bodies), 3))
    spread = np.zeros((3 * len(near), 6 * len(bodies)))
    row = 0
    for i, one in enumerate(bodies):
        origin[i] = joint_position[joint[one]]
        jacobian_at(origin[i], joint_jacobian, moved_by[one], jacobian[6 * i : 6 * i + 6])
        mine = position[near[body[near] == one]]
        spread[row : row + 3 * len(mine), 6 * i : 6 * i + 6] = spread_of(mine, origin[i], plane_axes)
        row += 3 * len(mine)
    return (
        jacobian,
        spread,
        gap[near],
        np.full(len(near), friction),
        np.zeros(6 * len(bodies)),
        position[near],
        origin,
        np.full(len(bodies), -1),
    )


@compiled(f"b1({_VECTOR}, {_MATRIX}, {_VECTOR})")
def still_clear(clearance: np.ndarray, reach: np.ndarray, velocity: np.ndarray) -> bool:
    """Whether all bodies are surely clear of the floor after one more step; their clearance shrinks by that step.

    Args:
        clearance: at least so far is each body from the floor (B,), m; changed in place.
        reach: how far a unit of each velocity can move any point of each body in a step (B, nv), m s.
        velocity: of the step (nv,).
    """
    clear = True
    for body in range(len(clearance)):
        for j in range(len(velocity)):
            clearance[body] -= reach[body, j] * abs(velocity[j])
        clear &= clearance[body] > MARGIN
    return clear
