"""Where a wrench is taken: its reference point, its axes, the order of its blocks, and which way is up.

Everywhere else in the package a wrench is [force; moment], a momentum is [linear; angular], a velocity is
[linear; angular], and z points up. The chapter (Goswami, Orin, Lee: momentum-based balance control) stacks
angular before linear and lets y point up in part of its equations; this file is the only bridge between the
two.
"""

from __future__ import annotations

import numpy as np

from momentum_lab.compiled import compiled


def _frozen(array: np.ndarray) -> np.ndarray:
    array.setflags(write=False)
    return array


Z_UP_FROM_Y_UP = _frozen(np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]))
"""Rotation that takes y-up coordinates to z-up coordinates: x, y, z -> x, -z, y."""


def skew(vector: np.ndarray) -> np.ndarray:
    """The matrix of a cross product, S(a) b = a x b.

    Args:
        vector: a (3,), any unit.

    Returns:
        S(a) (3, 3), the unit of a.
    """
    x, y, z = vector.tolist()
    return np.array(((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0)))


@compiled("f8[::1](f8[:], f8[:])")
def cross(left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """The cross product a x b of two vectors; compiled, ten times as fast as numpy's for any shape.

    Args:
        left: a (3,), any unit.
        right: b (3,), any unit.

    Returns:
        a x b (3,), the product of the units.
    """
    ax, ay, az = left
    bx, by, bz = right
    return np.array((ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx))


@compiled("f8[::1](f8[:], f8[:], f8[:])")
def shift_wrench(wrench: np.ndarray, from_point: np.ndarray, to_point: np.ndarray) -> np.ndarray:
    """The same wrench about another point.

    f' = f,  n' = n + (a - b) x f, from point a to point b.

    Args:
        wrench: [f; n] about from_point (6,), N and N m.
        from_point: a (3,), m, in the axes of the wrench.
        to_point: b (3,), m, in the same axes.

    Returns:
        [f; n'] about to_point (6,), N and N m.
    """
    fx, fy, fz, nx, ny, nz = wrench
    ax, ay, az = from_point
    bx, by, bz = to_point
    dx, dy, dz = ax - bx, ay - by, az - bz
    return np.array((fx, fy, fz, nx + dy * fz - dz * fy, ny + dz * fx - dx * fz, nz + dx * fy - dy * fx))


def wrench_shift_map(from_point: np.ndarray, to_point: np.ndarray) -> np.ndarray:
    """The matrix of `shift_wrench`, for sums of unknown wrenches.

    [[1, 0], [S(a - b), 1]], from point a to point b.

    Args:
        from_point: a (3,), m.
        to_point: b (3,), m.

    Returns:
        The map of [f; n] about a to [f; n'] about b (6, 6).
    """
    shift = np.eye(6)
    shift[3:, :3] = skew(from_point - to_point)
    return shift


@compiled("f8[::1](f8[:, :], f8[:, :], f8[:])")
def sum_wrenches(wrenches: np.ndarray, points: np.ndarray, about: np.ndarray) -> np.ndarray:
    """Several wrenches, each about its own point, as one wrench about a common point.

    f = sum f_i,  n = sum (n_i + (p_i - b) x f_i), the right-hand sides of Eqs. 1 and 2 without gravity.

    Args:
        wrenches: [f_i; n_i] about points[i], world axes (C, 6), N and N m.
        points: p_i (C, 3), m.
        about: b (3,), m.

    Returns:
        [f; n] about b, world axes (6,), N and N m; zero when there are no wrenches.
    """
    if len(points) != len(wrenches):
        raise ValueError("every wrench needs the point it is taken about")
    total = np.zeros(6)
    for i in range(len(wrenches)):
        total += shift_wrench(wrenches[i], points[i], about)
    return total


def wrench_in_frame_axes(wrench_in_world: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """A wrench in the axes of a frame, about the same point.

    [R^T f; R^T n].

    Args:
        wrench_in_world: [f; n] in world axes (6,), N and N m.
        rotation: R, the frame's axes in the world (3, 3).

    Returns:
        The wrench in the frame's axes (6,), N and N m.
    """
    return (wrench_in_world.reshape(2, 3) @ rotation).reshape(6)


def wrench_in_world_axes(wrench_in_frame: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """A wrench given in the axes of a frame, in world axes, about the same point.

    [R f; R n].

    Args:
        wrench_in_frame: [f; n] in the frame's axes (6,), N and N m.
        rotation: R, the frame's axes in the world (3, 3).

    Returns:
        The wrench in world axes (6,), N and N m.
    """
    return (wrench_in_frame.reshape(2, 3) @ rotation.T).reshape(6)


def swap_linear_angular(rows: np.ndarray) -> np.ndarray:
    """Rows in the chapter's order (angular first) from rows in this package's (linear first), and back.

    x_chapter = P x, with P the exchange of the two blocks of three. It is its own inverse. The columns of a
    map such as A_G belong to joint rates and stay where they are.

    Args:
        rows: a velocity, momentum or wrench (6,), or a map onto one (6, n).

    Returns:
        The same with its first and last three rows exchanged, a new array.
    """
    return np.concatenate((rows[3:], rows[:3]))


def swap_operator_blocks(operator: np.ndarray) -> np.ndarray:
    """A matrix between 6-vectors in the chapter's order from one in this package's, and back.

    P X P: spatial inertias (Eq. 9) and spatial transforms (Eq. 4).

    Args:
        operator: X (6, 6).

    Returns:
        P X P (6, 6), a new array.
    """
    return swap_linear_angular(swap_linear_angular(operator).T).T


def z_up_from_y_up(vectors: np.ndarray) -> np.ndarray:
    """Vectors of the chapter's y-up equations (21 to 23, 39 to 41) in this package's z-up axes.

    (x, y, z) -> (x, -z, y). This is a rotation; exchanging y and z alone would be a reflection, which turns
    every cross product around and misplaces the CoP.

    Args:
        vectors: points, forces or moments, y up (..., 3), any unit.

    Returns:
        The same, z up (..., 3).
    """
    return vectors @ Z_UP_FROM_Y_UP.T


def y_up_from_z_up(vectors: np.ndarray) -> np.ndarray:
    """Vectors of this package in the chapter's y-up axes, the inverse of `z_up_from_y_up`.

    (x, y, z) -> (x, z, -y).

    Args:
        vectors: points, forces or moments, z up (..., 3), any unit.

    Returns:
        The same, y up (..., 3).
    """
    return vectors @ Z_UP_FROM_Y_UP
