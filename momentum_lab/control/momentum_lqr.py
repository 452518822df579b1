"""The momentum of a standing robot as a linear system, and its optimal feedback (Herzog et al. 2014)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.linalg import solve_continuous_are

from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.momentum.wrench import skew

# A moment costs as much as a force this far from the sole, m.
_LEVER = 0.1


@dataclass(frozen=True, slots=True)
class OperatingPoint:
    """A robot that stands still on C feet, each of which carries the same part of the weight.

    Attributes:
        mass: m, kg.
        arms: centres of the carrying soles, seen from the CoM (C, 3), m.
    """

    mass: float
    arms: tuple[tuple[float, float, float], ...]


@dataclass(frozen=True, slots=True)
class LqrCosts:
    """What an error may cost, by Bryson's rule: each of these is as bad as every other.

    Attributes:
        position: of the CoM, m.
        velocity: of the CoM, m/s.
        spin: angular momentum over the rotational inertia of a rod as tall as the CoM, rad/s.
        force: change of a foot's force, as a part of the weight.
    """

    position: float
    velocity: float
    spin: float
    force: float


def linear_momentum_dynamics(point: OperatingPoint) -> tuple[np.ndarray, np.ndarray]:
    """A and B of d(dx)/dt = A dx + B du near an operating point.

    x = (r, l, k) and u = (f_i, n_i) about the soles' centres c_i: dr/dt = l / m, dl/dt = m g + sum f_i,
    dk/dt = sum (c_i - r) x f_i + n_i. Linearized, A = [[0, 1 / m, 0], [0, 0, 0], [S(sum f_i0), 0, 0]]; B has
    1 for every f_i in the rows of l, S(c_i - r_0) and 1 in those of k.

    Args:
        point: where the robot stands.

    Returns:
        A (9, 9) and B (9, 6 C).
    """
    A, B = np.zeros((9, 9)), np.zeros((9, 6 * len(point.arms)))
    A[:3, 3:6] = np.eye(3) / point.mass
    A[6:, :3] = skew(np.array([0.0, 0.0, point.mass * GRAVITY]))
    for i, arm in enumerate(point.arms):
        B[3:6, 6 * i : 6 * i + 3] = np.eye(3)
        B[6:, 6 * i : 6 * i + 3] = skew(np.array(arm))
        B[6:, 6 * i + 3 : 6 * i + 6] = np.eye(3)
    return A, B


@lru_cache(maxsize=32)
def momentum_feedback(point: OperatingPoint, costs: LqrCosts) -> np.ndarray:
    """The closed loop A - B K of the linear-quadratic regulator.

    K = R^-1 B^T S with S from the continuous algebraic Riccati equation. Its last six rows times
    x = (r - r_d, l, k) are the momentum rates that the optimal wrenches cause, Eqs. 37 and 38 with every gain
    a matrix.

    Args:
        point: where the robot stands.
        costs: what an error may cost.

    Returns:
        The matrix (9, 9); all its eigenvalues have negative real parts.
    """
    A, B = linear_momentum_dynamics(point)
    weight = point.mass * GRAVITY
    height = max(abs(arm[2]) for arm in point.arms)
    worst_spin = costs.spin * point.mass * height**2 / 3.0
    worst_state = np.repeat([costs.position, costs.velocity * point.mass, worst_spin], 3)
    worst_wrench = costs.force * weight * np.tile([1.0, 1.0, 1.0, _LEVER, _LEVER, _LEVER], len(point.arms))
    # In parts of what is worst both weights are 1; in SI the equation is too ill-conditioned for some costs.
    A, B = A * worst_state / worst_state[:, None], B * worst_wrench / worst_state[:, None]
    S = solve_continuous_are(A, B, np.eye(len(A)), np.eye(len(worst_wrench)))
    return (A - B @ (B.T @ S)) * worst_state[:, None] / worst_state
