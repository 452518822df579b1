"""Which points of the robot may touch the ground, and how they move: the corners of its soles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from momentum_lab.compiled import compiled
from momentum_lab.momentum.foot_ground import velocity_at
from momentum_lab.physics.contact import Contacts
from momentum_lab.physics.ground import Ground
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics

# Points this close to the ground take part in the contact problem, m.
MARGIN = 0.01
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
            near[foot] |= not gap[foot, i] > MARGIN
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


def near_points(touches: Touches) -> Touches:
    """Only the points that are near their ground, as of other bodies: of a sole on edge, those of that edge."""
    contacts = touches.contacts
    near = contacts.gap < MARGIN
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
