"""Which points of the robot may touch the ground, and how they move: soles always, other bodies in a fall."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pinocchio as pin

from momentum_lab.compiled import compiled
from momentum_lab.momentum.foot_ground import velocity_at
from momentum_lab.physics.contact import Contacts
from momentum_lab.physics.ground import Ground, Patch
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics, State
from momentum_lab.robot.terms import Frames, memory_of

# Points this close to the ground take part in the contact problem, m.
_MARGIN = 0.01
_MATRIX, _VECTOR, _STACK = "f8[:, ::1]", "f8[::1]", "f8[:, :, ::1]"


@dataclass(frozen=True, slots=True)
class Touches:
    """Points of B bodies on the ground, body after body.

    Attributes:
        contacts: how they move and how far they are from the ground.
        position: the points in the world (n, 3), m.
        origin: origins of the bodies' frames in the world (B, 3), m.
        foot: which foot each body is; -1 for every other body (B,).
    """

    contacts: Contacts
    position: np.ndarray
    origin: np.ndarray
    foot: np.ndarray


class SolePoints:
    """The four corners of each sole, over the plates of a ground."""

    def __init__(self, robot: RobotModel, timestep: float) -> None:
        self._half_step = 0.5 * timestep
        self._corners = np.array([sole.corners for sole in robot.soles])

    def touches(self, dynamics: Dynamics, ground: Ground, time: float) -> Touches:
        """The corners of all feet that are not wholly clear of the ground at a time of the run, s.

        Plates are where they are at the start of a step, and have the velocity of its middle: so the way they go
        in it is right to third order, and to second order where they turn.
        """
        plates, on_the_way = ground.at(time), ground.at(time + self._half_step)
        *contacts, position, origin, foot = placed_soles(
            self._corners,
            dynamics.sole_position,
            dynamics.sole_rotation,
            dynamics.sole_jacobian,
            plates.position,
            plates.rotation,
            on_the_way.velocity,
            ground.friction(time),
        )
        return Touches(Contacts(*contacts), position, origin, foot)


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
    f"Tuple(({_MATRIX}, {_MATRIX}, {_VECTOR}, {_VECTOR}, {_VECTOR}, {_MATRIX}, {_MATRIX}, i8[::1]))"
    f"({_STACK}, {_MATRIX}, {_STACK}, {_STACK}, {_MATRIX}, {_STACK}, {_MATRIX}, {_VECTOR})"
)
def placed_soles(
    corners: np.ndarray,
    origin: np.ndarray,
    rotation: np.ndarray,
    jacobian: np.ndarray,
    plane_origin: np.ndarray,
    plane_axes: np.ndarray,
    plane_velocity: np.ndarray,
    friction: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The corners of the soles that have any of them near their plane, as B bodies.

    Args:
        corners: in the sole frames (F, 4, 3), m.
        origin: of the soles in the world (F, 3), m.
        rotation: axes of the soles in the world (F, 3, 3).
        jacobian: of the soles, world-aligned (F, 6, nv).
        plane_origin: a point of the plane under each foot (F, 3), m.
        plane_axes: axes of those planes, their normals last (F, 3, 3).
        plane_velocity: of those points and planes, linear before angular (F, 6), m/s and rad/s.
        friction: Coulomb coefficients of those planes (F,).

    Returns:
        J_f (6 B, nv), S (12 B, 6 B), gaps (4 B,), friction (4 B,), velocities of the ground (6 B,),
        positions (4 B, 3), origins (B, 3), feet (B,).
    """
    position, gap = np.empty_like(corners), np.zeros(corners.shape[:2])
    near = np.zeros(len(corners), dtype=np.bool_)
    for foot in range(len(corners)):
        turn, axes = rotation[foot], plane_axes[foot]
        for i in range(4):
            x, y, z = corners[foot, i]
            for k in range(3):
                place = origin[foot, k] + turn[k, 0] * x + turn[k, 1] * y + turn[k, 2] * z
                position[foot, i, k] = place
                gap[foot, i] += (place - plane_origin[foot, k]) * axes[k, 2]
            near[foot] |= not gap[foot, i] > _MARGIN
    feet = np.flatnonzero(near)
    bodies = len(feet)
    spread, carried = np.zeros((12 * bodies, 6 * bodies)), np.empty(6 * bodies)
    for body, foot in enumerate(feet):
        carried[6 * body : 6 * body + 6] = velocity_at(origin[foot], plane_origin[foot], plane_velocity[foot])
        spread[12 * body : 12 * body + 12, 6 * body : 6 * body + 6] = spread_of(
            position[foot], origin[foot], plane_axes[foot]
        )
    return (
        jacobian[feet].reshape(6 * bodies, jacobian.shape[2]),
        spread,
        gap[feet].ravel(),
        np.repeat(friction[feet], 4),
        carried,
        position[feet].reshape(-1, 3),
        origin[feet],
        feet,
    )


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
    near = np.flatnonzero(gap < _MARGIN)
    bodies = np.unique(body[near])
    jacobian, origin = np.empty((6 * len(bodies), moved_by.shape[1])), np.empty((len(bodies), 3))
    spread = np.zeros((3 * len(near), 6 * len(bodies)))
    row = 0
    for i, one in enumerate(bodies):
        origin[i] = joint_position[joint[one]]
        x, y, z = origin[i]
        block = jacobian[6 * i : 6 * i + 6]
        for j in range(moved_by.shape[1]):
            part = moved_by[one, j]
            wx, wy, wz = joint_jacobian[3, j], joint_jacobian[4, j], joint_jacobian[5, j]
            block[0, j] = part * (joint_jacobian[0, j] + wy * z - wz * y)
            block[1, j] = part * (joint_jacobian[1, j] + wz * x - wx * z)
            block[2, j] = part * (joint_jacobian[2, j] + wx * y - wy * x)
            block[3, j], block[4, j], block[5, j] = part * wx, part * wy, part * wz
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


def near_points(touches: Touches) -> Touches:
    """Only the points that are near their ground, as of other bodies: of a sole on edge, those of that edge."""
    contacts = touches.contacts
    near = contacts.gap < _MARGIN
    if near.all():
        return touches
    frames = contacts.spread.shape[1]
    contacts = replace(
        contacts,
        spread=contacts.spread.reshape(-1, 3, frames)[near].reshape(-1, frames),
        gap=contacts.gap[near],
        friction=contacts.friction[near],
    )
    return replace(touches, contacts=contacts, position=touches.position[near])


def together(*groups: Touches) -> Touches:
    """The points of some groups of bodies as one group."""
    contacts = [group.contacts for group in groups]
    return Touches(
        contacts=Contacts(
            frame_jacobian=np.concatenate([each.frame_jacobian for each in contacts]),
            spread=_blocks([each.spread for each in contacts]),
            gap=np.concatenate([each.gap for each in contacts]),
            friction=np.concatenate([each.friction for each in contacts]),
            ground_velocity=np.concatenate([each.ground_velocity for each in contacts]),
        ),
        position=np.concatenate([group.position for group in groups]),
        origin=np.concatenate([group.origin for group in groups]),
        foot=np.concatenate([group.foot for group in groups]),
    )


def _blocks(parts: Sequence[np.ndarray]) -> np.ndarray:
    """A block-diagonal matrix; scipy's takes longer to look at small blocks than to copy them."""
    whole = np.zeros((sum(len(part) for part in parts), sum(part.shape[1] for part in parts)))
    row = column = 0
    for part in parts:
        whole[row : row + len(part), column : column + part.shape[1]] = part
        row, column = row + len(part), column + part.shape[1]
    return whole


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
        self.reach = timestep * np.array([reach_of(model, joint, np.array(points)) for joint, points in joints])
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
        if not self._clearance.min() < _MARGIN:  # so that NaN, too, touches nothing
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
        clear &= clearance[body] > _MARGIN
    return clear
