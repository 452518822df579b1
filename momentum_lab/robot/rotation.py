"""Rotations as quaternions and vectors."""

from __future__ import annotations

import math

import numpy as np

from momentum_lab.compiled import compiled


@compiled("f8[::1](f8[:, :])")
def quaternion_of(rotation: np.ndarray) -> np.ndarray:
    """The unit quaternion xyzw (4,) of a rotation matrix (3, 3).

    One entry is a root of the diagonal: w where the trace is positive, otherwise the largest of x, y and z; that
    one is positive, and the others follow from sums and differences of the rest (Shepperd 1978).
    """
    trace = rotation[0, 0] + rotation[1, 1] + rotation[2, 2]
    quaternion = np.empty(4)
    if trace > 0.0:
        root = math.sqrt(1.0 + trace)
        quaternion[3] = 0.5 * root
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            quaternion[i] = 0.5 * (rotation[k, j] - rotation[j, k]) / root
        return quaternion
    i = 0
    for other in (1, 2):
        if rotation[other, other] > rotation[i, i]:
            i = other
    j, k = (i + 1) % 3, (i + 2) % 3
    root = math.sqrt(1.0 + rotation[i, i] - rotation[j, j] - rotation[k, k])
    quaternion[i] = 0.5 * root
    quaternion[j] = 0.5 * (rotation[j, i] + rotation[i, j]) / root
    quaternion[k] = 0.5 * (rotation[k, i] + rotation[i, k]) / root
    quaternion[3] = 0.5 * (rotation[k, j] - rotation[j, k]) / root
    return quaternion


@compiled("f8[::1](f8[:, :], f8[:, :])")
def rotation_error(rotation: np.ndarray, desired: np.ndarray) -> np.ndarray:
    """The rotation vector e_R = log(R R_d^T) (3,), rad, in world axes: where to turn back from.

    Args:
        rotation: R (3, 3).
        desired: R_d (3, 3).
    """
    difference = np.zeros((3, 3))
    for i in range(3):
        for j in range(3):
            for k in range(3):
                difference[i, j] += rotation[i, k] * desired[j, k]
    quaternion = quaternion_of(difference)
    if quaternion[3] < 0.0:
        quaternion = -quaternion
    axis = quaternion[:3].copy()
    sine = math.sqrt(axis[0] ** 2 + axis[1] ** 2 + axis[2] ** 2)
    # angle / sin(angle / 2), which is 2 for small angles.
    return axis * (2.0 if sine < 1e-9 else 2.0 * math.atan2(sine, quaternion[3]) / sine)
