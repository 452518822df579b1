"""Resolved momentum control: joint rates that give the robot a momentum while its feet do as told (Eqs. 24 to 26)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

# Singular values below this part of the largest count as zero.
_RANK = 1e-10


def null_space(matrix: np.ndarray) -> np.ndarray:
    """Directions that a map sends to zero.

    J N = 0, N^T N = 1.

    Args:
        matrix: J (m, n).

    Returns:
        N, one direction per column (n, n - rank).
    """
    _, values, rows = np.linalg.svd(matrix)
    rank = int(np.sum(values > _RANK * values[0])) if values.size else 0
    return rows[rank:].T


def resolved_rates(
    constraint_map: np.ndarray,
    constraint_velocity: np.ndarray,
    centroidal_map: np.ndarray,
    momentum: np.ndarray,
    reference: np.ndarray,
    controlled: Sequence[bool] = (True,) * 6,
) -> np.ndarray:
    """Joint rates that obey the constraints, then give the momentum, then stay next to a reference.

    Eq. 24: J_c v = v_c.
    Eq. 26: v = J_c^+ v_c + N z with N = null(J_c); z = (S A_G N)^+ S (h_d - A_G J_c^+ v_c) leaves free what
    neither constraints nor momentum ask for, and there v comes as near to v_ref as it can:
    z = z_h + (1 - (S A_G N)^+ (S A_G N)) N^T v_ref. S keeps the rows of the controlled directions (section
    5.3.1).

    Args:
        constraint_map: J_c (c, nv).
        constraint_velocity: v_c (c,), m/s and rad/s.
        centroidal_map: A_G (6, nv).
        momentum: h_d = [l_d; k_d] about the CoM (6,), N s and N m s.
        reference: v_ref (nv,), m/s and rad/s.
        controlled: which of l_x, l_y, l_z, k_x, k_y, k_z are asked for.

    Returns:
        v (nv,), m/s and rad/s. Where not all of the momentum can be had, |S (h_d - A_G v)| is smallest (Eq. 25).
    """
    rows = np.asarray(controlled, dtype=bool)
    constrained = np.linalg.pinv(constraint_map, rcond=_RANK) @ constraint_velocity
    free = null_space(constraint_map)
    reach = centroidal_map[rows] @ free
    inverse = np.linalg.pinv(reach, rcond=_RANK)
    wanted = free.T @ reference
    missing = momentum[rows] - centroidal_map[rows] @ constrained - reach @ wanted
    return constrained + free @ (wanted + inverse @ missing)
