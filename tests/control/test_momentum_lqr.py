"""Momentum of a standing robot as a linear system: A and B by differences, and an optimal feedback."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from scipy.linalg import solve_continuous_lyapunov

from momentum_lab.control.gains import declared_gains
from momentum_lab.control.momentum_lqr import (
    LqrCosts,
    OperatingPoint,
    linear_momentum_dynamics,
    momentum_feedback,
)
from momentum_lab.control.whole_body_qp import WholeBodyGains
from momentum_lab.momentum.wrench import sum_wrenches
from tests.conftest import assert_close

G = 9.81
COSTS = LqrCosts(position=0.02, velocity=0.1, spin=0.5, force=0.03)
TWO_FEET = OperatingPoint(90.0, ((0.01, 0.1, -0.9), (-0.01, -0.1, -0.9)))
ONE_FOOT = OperatingPoint(33.0, ((0.0, 0.0, -0.7),))


def rates(point: OperatingPoint, x: np.ndarray, u: np.ndarray) -> np.ndarray:
    """dx/dt of Eqs. 1 and 2 for the CoM at x[:3], wrenches about the soles' centres, nothing linearized."""
    wrench = sum_wrenches(u.reshape(-1, 6), np.array(point.arms), x[:3])
    wrench[2] -= point.mass * G
    return np.concatenate([x[3:6] / point.mass, wrench])


def carried(point: OperatingPoint) -> np.ndarray:
    """The same part of the weight on each foot."""
    count = len(point.arms)
    return np.tile([0.0, 0.0, point.mass * G / count, 0.0, 0.0, 0.0], count)


@pytest.mark.parametrize("point", [TWO_FEET, ONE_FOOT])
def test_a_and_b_are_differences(point):
    A, B = linear_momentum_dynamics(point)
    u = carried(point)
    assert_close(rates(point, np.zeros(9), u), np.zeros(9), 1e-9)
    step = 1e-4
    for i, column in enumerate(np.eye(9)):
        change = rates(point, step * column, u) - rates(point, -step * column, u)
        assert_close(A[:, i], change / (2 * step), 1e-7)
    for i, column in enumerate(np.eye(u.size)):
        change = rates(point, np.zeros(9), u + column) - rates(point, np.zeros(9), u - column)
        assert_close(B[:, i], change / 2, 1e-9)


@pytest.mark.parametrize("point", [TWO_FEET, ONE_FOOT])
def test_the_closed_loop_is_hurwitz(point):
    assert np.linalg.eigvals(momentum_feedback(point, COSTS)).real.max() < -0.3


@pytest.mark.parametrize("point", [TWO_FEET, ONE_FOOT, OperatingPoint(95.0, ((0.0, 0.0, -0.9),))])
def test_whatever_the_sliders_allow_has_a_regulator(point):
    """All corners of the gains' ranges, where the Riccati equation in SI has no answer for some."""
    gains = declared_gains(WholeBodyGains())
    names = ("lqr_com_error", "lqr_velocity_error", "lqr_spin_error", "lqr_force")
    for corner in itertools.product(*((gains[name].low, gains[name].high) for name in names)):
        assert np.linalg.eigvals(momentum_feedback(point, LqrCosts(*corner))).real.max() < 0.0


@pytest.mark.parametrize("point", [TWO_FEET, ONE_FOOT])
def test_no_feedback_nearby_is_cheaper(point, rng):
    """The cost of a feedback from random starts by Lyapunov's equation: its derivative is zero at the LQR's."""
    A, B = linear_momentum_dynamics(point)
    height = abs(point.arms[0][2])
    spin = COSTS.spin * point.mass * height**2 / 3.0
    Q = np.diag(np.repeat([COSTS.position, COSTS.velocity * point.mass, spin], 3) ** -2.0)
    worst = COSTS.force * point.mass * G * np.tile([1, 1, 1, 0.1, 0.1, 0.1], len(point.arms))
    R = np.diag(worst**-2.0)
    # Of all wrenches with the same effect the optimal ones are the cheapest.
    cheapest = np.diag(worst**2.0) @ B.T @ np.linalg.pinv(B @ np.diag(worst**2.0) @ B.T)
    K = cheapest @ (A - momentum_feedback(point, COSTS))

    def cost(gain):
        closed = A - B @ gain
        assert np.linalg.eigvals(closed).real.max() < 0.0
        return np.trace(solve_continuous_lyapunov(closed.T, -(Q + gain.T @ R @ gain)))

    best = cost(K)
    for _ in range(10):
        assert cost(K * (1.0 + 0.05 * rng.normal(size=K.shape))) > best


def test_smaller_errors_allowed_make_a_stiffer_loop():
    soft = momentum_feedback(TWO_FEET, COSTS)
    stiff = momentum_feedback(TWO_FEET, LqrCosts(0.005, 0.1, 0.5, 0.03))
    assert -stiff[3, 0] > 1.2 * -soft[3, 0] > 0.0


def test_positions_are_coupled_to_angular_momentum():
    """S(m g z) dr: a CoM that is ahead makes the weight turn the robot, which an LQR knows and Eq. 37 does not."""
    loop = momentum_feedback(ONE_FOOT, COSTS)
    assert abs(loop[7, 0]) > 1.0
