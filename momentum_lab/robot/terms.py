"""What Pinocchio has left in its memory after two passes over a state, as the quantities of `Dynamics`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pinocchio as pin

from momentum_lab.compiled import compiled

_MATRIX, _VECTOR, _STACK = "f8[:, ::1]", "f8[::1]", "f8[:, :, ::1]"
_OF_PINOCCHIO = "f8[::1, :]"


@dataclass(frozen=True, slots=True)
class Frames:
    """Frames of a robot, each fixed to a joint (K).

    Attributes:
        joint: index of the joint that carries each frame (K,).
        moved_by: 1 for velocities that move the frame, 0 for all others (K, nv).
        position: origins in the axes of the joints (K, 3), m.
        rotation: axes likewise (K, 3, 3).
    """

    joint: np.ndarray
    moved_by: np.ndarray
    position: np.ndarray
    rotation: np.ndarray

    @classmethod
    def of(cls, model: pin.Model, indices: Sequence[int]) -> Frames:
        """The frames with these indices in a model."""
        frames = [model.frames[index] for index in indices]
        moved_by = np.zeros((len(frames), model.nv))
        for row, frame in zip(moved_by, frames, strict=True):
            for joint in list(model.supports[frame.parentJoint])[1:]:
                row[model.idx_vs[joint] : model.idx_vs[joint] + model.nvs[joint]] = 1.0
        return cls(
            joint=np.array([frame.parentJoint for frame in frames]),
            moved_by=moved_by,
            position=np.array([frame.placement.translation for frame in frames]),
            rotation=np.array([frame.placement.rotation for frame in frames]),
        )


class Memory(NamedTuple):
    """Views of what `crba` (in world coordinates) and `nonLinearEffects` write; see `state_terms` for each.

    They show every later pass, and are valid as long as Pinocchio's data exist.
    """

    mass_matrix: np.ndarray
    nonlinear_effects: np.ndarray
    centroidal_map: np.ndarray
    joint_jacobian: np.ndarray
    com: np.ndarray
    joint_position: np.ndarray
    joint_rotation: np.ndarray
    joint_acceleration: np.ndarray


def memory_of(data: pin.Data) -> Memory:
    """The memory of some data."""
    return Memory(
        data.M,
        data.nle,
        data.Ag,
        data.J,
        data.com[0],
        _every(data.oMi, "translation"),
        _every(data.oMi, "rotation"),
        _every(data.a_gf, "vector"),
    )


def _every(vector: Sequence[object], attribute: str) -> np.ndarray:
    """One attribute of all elements of a C++ vector, which lie one behind the other, as one view (n, ...)."""
    first, second = (getattr(vector[i], attribute) for i in range(2))
    step = second.ctypes.data - first.ctypes.data
    return np.lib.stride_tricks.as_strided(first, (len(vector), *first.shape), (step, *first.strides))


@compiled(
    f"Tuple(({_VECTOR}, {_VECTOR}, {_MATRIX}))"
    f"({_MATRIX}, {_VECTOR}, {_VECTOR}, f8[:, :], f8[:], {_VECTOR}, {_VECTOR})"
)
def centroidal_terms(
    centroidal_map: np.ndarray,
    nonlinear_effects: np.ndarray,
    velocity: np.ndarray,
    rotation: np.ndarray,
    position: np.ndarray,
    com: np.ndarray,
    weight: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """What A_G and the base rows of the equations of motion say about the momentum (Eqs. 15, 20, 29).

    h_G = A_G v. The base rows of C v + tau_g, turned into world axes and taken about the CoM, are dA_G/dt v
    and the weight held up. The base turned alone, with no joint moving, shows the inertia about the CoM.

    Args:
        centroidal_map: A_G (6, nv).
        nonlinear_effects: C v + tau_g (nv,).
        velocity: v (nv,).
        rotation: axes of the base in the world (3, 3).
        position: its origin (3,), m.
        com: r_G (3,), m.
        weight: m g (3,), N.

    Returns:
        h_G (6,), dA_G/dt v (6,), I_G (3, 3).
    """
    bias, inertia = np.zeros(6), np.zeros((3, 3))
    for i in range(3):
        for k in range(3):
            bias[i] += rotation[i, k] * nonlinear_effects[k]
            bias[3 + i] += rotation[i, k] * nonlinear_effects[3 + k]
            for j in range(3):
                inertia[i, j] += centroidal_map[3 + i, 3 + k] * rotation[j, k]
    fx, fy, fz = bias[:3]
    x, y, z = position - com
    bias[3] += y * fz - z * fy
    bias[4] += z * fx - x * fz
    bias[5] += x * fy - y * fx
    bias[:3] += weight
    return centroidal_map @ velocity, bias, inertia


@compiled(f"void({_VECTOR}, {_OF_PINOCCHIO}, {_VECTOR}, {_MATRIX})")
def jacobian_at(
    place: np.ndarray, joint_jacobian: np.ndarray, moved_by: np.ndarray, jacobian: np.ndarray
) -> None:
    """Fill in how a point of a body moves: column (v, w) of the joints' Jacobian moves it with (v + w x o, w).

    Args:
        place: the point o in the world (3,), m.
        joint_jacobian: spatial velocities about the world origin, of which each joint is a column (6, nv).
        moved_by: 1 for velocities that move the body, 0 for all others (nv,).
        jacobian: world-aligned, linear first (6, nv); changed in place.
    """
    x, y, z = place
    for j in range(len(moved_by)):
        part = moved_by[j]
        wx, wy, wz = joint_jacobian[3, j], joint_jacobian[4, j], joint_jacobian[5, j]
        jacobian[0, j] = part * (joint_jacobian[0, j] + wy * z - wz * y)
        jacobian[1, j] = part * (joint_jacobian[1, j] + wz * x - wx * z)
        jacobian[2, j] = part * (joint_jacobian[2, j] + wx * y - wy * x)
        jacobian[3, j], jacobian[4, j], jacobian[5, j] = part * wx, part * wy, part * wz


@compiled(
    f"Tuple(({_MATRIX}, {_STACK}, {_STACK}, {_MATRIX}))({_OF_PINOCCHIO}, f8[:, :], f8[:, :, :], f8[:, :], "
    f"{_VECTOR}, i8[::1], {_MATRIX}, {_MATRIX}, {_STACK}, {_VECTOR})"
)
def frame_terms(
    joint_jacobian: np.ndarray,
    joint_position: np.ndarray,
    joint_rotation: np.ndarray,
    joint_acceleration: np.ndarray,
    velocity: np.ndarray,
    carrier: np.ndarray,
    moved_by: np.ndarray,
    position: np.ndarray,
    rotation: np.ndarray,
    gravity: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Where frames are, how they move, and how they are accelerated with no joint acceleration (Eqs. 31, 45).

    With o = p_j + R_j p the origin of a frame, column (v_k, w_k) of the joints' Jacobian moves it with
    v_k + w_k x o. The joint's spatial acceleration (a, alpha) gives the frame a + alpha x p and, since that
    belongs to a point that passes by, w x o' on top.

    Args: see `state_terms`.

    Returns:
        Origins in the world (K, 3), axes (K, 3, 3), world-aligned Jacobians (K, 6, nv), classical accelerations
        (K, 6).
    """
    count, size = moved_by.shape
    places, axes = np.empty((count, 3)), np.zeros((count, 3, 3))
    jacobians, drifts = np.empty((count, 6, size)), np.zeros((count, 6))
    for frame in range(count):
        turn, here = joint_rotation[carrier[frame]], position[frame]
        place, jacobian, drift = places[frame], jacobians[frame], drifts[frame]
        for i in range(3):
            place[i] = joint_position[carrier[frame], i]
            for k in range(3):
                place[i] += turn[i, k] * here[k]
                for j in range(3):
                    axes[frame, i, j] += turn[i, k] * rotation[frame, k, j]
        jacobian_at(place, joint_jacobian, moved_by[frame], jacobian)
        vx, vy, vz, wx, wy, wz = jacobian @ velocity
        ax, ay, az, bx, by, bz = joint_acceleration[carrier[frame]]
        x, y, z = here
        local = (ax + by * z - bz * y, ay + bz * x - bx * z, az + bx * y - by * x)
        passing = (wy * vz - wz * vy, wz * vx - wx * vz, wx * vy - wy * vx)
        for i in range(3):
            drift[i] = gravity[i] + passing[i]
            for k in range(3):
                drift[i] += turn[i, k] * local[k]
            drift[3 + i] = turn[i, 0] * bx + turn[i, 1] * by + turn[i, 2] * bz
    return places, axes, jacobians, drifts


@compiled(
    # as in `Dynamics`: the state and momentum, then soles and pelvis
    f"Tuple(({_VECTOR}, {_VECTOR}, {_MATRIX}, {_VECTOR}, {_VECTOR}, {_MATRIX}, {_MATRIX}, {_VECTOR}, "
    f"{_MATRIX}, {_STACK}, {_STACK}, {_MATRIX}, {_MATRIX}, {_MATRIX}, {_VECTOR}))("
    # Pinocchio's memory
    f"{_OF_PINOCCHIO}, {_VECTOR}, {_OF_PINOCCHIO}, {_OF_PINOCCHIO}, {_VECTOR}, f8[:, :], f8[:, :, :], f8[:, :], "
    # the state, the frames, the mass
    f"{_VECTOR}, i8[::1], {_MATRIX}, {_MATRIX}, {_STACK}, f8, {_VECTOR})"
)
def state_terms(
    mass_matrix: np.ndarray,
    nonlinear_effects: np.ndarray,
    centroidal_map: np.ndarray,
    joint_jacobian: np.ndarray,
    com: np.ndarray,
    joint_position: np.ndarray,
    joint_rotation: np.ndarray,
    joint_acceleration: np.ndarray,
    velocity: np.ndarray,
    carrier: np.ndarray,
    moved_by: np.ndarray,
    position: np.ndarray,
    rotation: np.ndarray,
    mass: float,
    gravity: np.ndarray,
) -> tuple[np.ndarray, ...]:
    """All arrays of `Dynamics` in its order, none of them shared with Pinocchio.

    Args:
        mass_matrix: H (nv, nv).
        nonlinear_effects: C v + tau_g (nv,).
        centroidal_map: A_G (6, nv).
        joint_jacobian: spatial velocities about the world origin, of which each joint is a column (6, nv).
        com: r_G (3,), m.
        joint_position: origins of all joints in the world, the world's own first (njoints, 3), m.
        joint_rotation: their axes likewise (njoints, 3, 3).
        joint_acceleration: their spatial accelerations under no joint acceleration, minus gravity, in their
            own axes (njoints, 6), m/s^2 and rad/s^2.
        velocity: v (nv,).
        carrier: joints of soles and pelvis, which is the last; see `Frames` for this and the next three (K,).
        moved_by: (K, nv).
        position: (K, 3), m.
        rotation: (K, 3, 3).
        mass: m, kg.
        gravity: g (3,), m/s^2.

    Returns:
        r_G, its velocity, A_G, dA_G/dt v, h_G, I_G, H, C v + tau_g; of the soles: positions (K - 1, 3), axes
        (K - 1, 3, 3), Jacobians (K - 1, 6, nv), drifts (K - 1, 6); of the pelvis: axes, Jacobian, drift.
    """
    own_map = np.ascontiguousarray(centroidal_map)
    momentum, bias, inertia = centroidal_terms(
        own_map, nonlinear_effects, velocity, joint_rotation[1], joint_position[1], com, mass * gravity
    )
    places, axes, jacobians, drifts = frame_terms(
        joint_jacobian,
        joint_position,
        joint_rotation,
        joint_acceleration,
        velocity,
        carrier,
        moved_by,
        position,
        rotation,
        gravity,
    )
    return (
        com.copy(),
        momentum[:3] / mass,
        own_map,
        bias,
        momentum,
        inertia,
        # H is symmetric: its columns are its rows.
        mass_matrix.T.copy(),
        nonlinear_effects.copy(),
        places[:-1],
        axes[:-1],
        jacobians[:-1],
        drifts[:-1],
        axes[-1],
        jacobians[-1],
        drifts[-1],
    )
