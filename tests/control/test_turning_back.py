"""When the body stops turning: the point to hold against an integrated pendulum, and who gets the priority."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from momentum_lab.control.turning_back import _urgency, point_to_hold

GRAVITY = 9.81
MASS, HEIGHT, INERTIA = 60.0, 0.9, np.diag([8.0, 6.0, 2.0])
OMEGA = np.sqrt(GRAVITY / HEIGHT)
SOLES = np.array([[-0.1, -0.15], [0.1, -0.15], [0.1, 0.15], [-0.1, 0.15]])


def held(com, velocity, momentum, tilt, damping, stiffness) -> np.ndarray:
    return np.array(point_to_hold(com, velocity, 0.0, momentum, INERTIA @ tilt, damping, stiffness, MASS))


def end_of(capture_point: float, cop: float, momentum: float, tilt: float, gains) -> float:
    """Where the capture point of a pendulum pushed to the left is after 4 s; its k_x and theta_x follow Eq. 37."""
    damping, stiffness = gains
    inertia = INERTIA[0, 0]

    def rates(_time, state):
        xi, k, theta = state
        k_rate = -damping * k - stiffness * inertia * theta
        return OMEGA * (xi - (cop - k_rate / (MASS * GRAVITY))), k_rate, k / inertia

    solved = solve_ivp(rates, (0.0, 4.0), (capture_point, momentum, tilt), rtol=1e-12, atol=1e-14)
    return float(solved.y[0, -1])


@pytest.mark.parametrize("gains", [(5.0, 4.0), (8.0, 16.0), (3.0, 0.0)])
@pytest.mark.parametrize(("momentum", "tilt"), [(-6.0, -0.1), (-12.0, 0.05), (0.0, -0.3)])
def test_a_capture_point_stays_inside_if_the_point_to_hold_is(gains, momentum, tilt):
    """The CoP stays on the left edge while k is brought back: 1 mm decides on which side the fall ends."""
    cop, com = 0.15, np.array([0.0, 0.02, HEIGHT])
    turning = (np.array([momentum, 0.0, 0.0]), np.array([tilt, 0.0, 0.0]))
    cost = held(com, np.zeros(3), *turning, *gains)[1] - com[1]
    assert end_of(cop - cost - 0.001, cop, momentum, tilt, gains) < cop - 0.1
    assert end_of(cop - cost + 0.001, cop, momentum, tilt, gains) > cop + 0.1


def test_without_turning_the_point_to_hold_is_the_capture_point():
    com, velocity = np.array([0.01, 0.02, HEIGHT]), np.array([0.2, -0.1, 0.0])
    found = held(com, velocity, np.zeros(3), np.zeros(3), 5.0, 4.0)
    assert found == pytest.approx(com[:2] + velocity[:2] / OMEGA, abs=1e-12)


def urgency(com: tuple[float, float], spin: np.ndarray, missing: np.ndarray) -> float:
    level, momentum = np.eye(3), np.concatenate([np.zeros(3), INERTIA @ spin])
    return _urgency(
        missing,
        np.array([*com, HEIGHT]),
        np.zeros(3),
        np.zeros(3),
        momentum,
        np.zeros(3),
        INERTIA,
        level,
        level,
        SOLES,
        0.0,
        5.0,
        4.0,
        MASS,
    )


LEFT, FORWARD = np.array([0.0, 0.05]), np.array([0.05, 0.0])
# A body that will turn by 0.8 rad to the left until Gamma_11 = 5 / s has braked it.
FALLING_LEFT = np.array([-4.0, 0.0, 0.0])


def test_angular_momentum_is_urgent_once_the_body_runs_out_of_room():
    assert urgency((0.0, 0.0), FALLING_LEFT, LEFT) == 1.0
    assert 0.0 < urgency((0.0, 0.0), 0.45 * FALLING_LEFT, LEFT) < 1.0
    assert urgency((0.0, 0.0), 0.25 * FALLING_LEFT, LEFT) == 0.0


def test_it_is_not_while_the_fall_has_not_been_caught():
    assert urgency((0.0, 0.14), FALLING_LEFT, LEFT) == 0.0


def test_it_is_not_where_both_rates_can_be_had_or_where_more_of_it_brings_the_body_back():
    assert urgency((0.0, 0.0), FALLING_LEFT, np.zeros(2)) == 0.0
    assert urgency((0.0, 0.0), FALLING_LEFT, -LEFT) == 0.0


def test_legs_that_fold_leave_more_room_forward():
    falling_forward = np.array([0.0, 4.0, 0.0])
    assert urgency((0.0, 0.0), falling_forward, FORWARD) == 0.0
    assert urgency((-0.05, 0.0), 1.4 * falling_forward, FORWARD) > 0.0


@pytest.mark.parametrize(("direction", "missing", "axis"), [("sideways", LEFT, 0), ("forward", FORWARD, 1)])
def test_angular_momentum_takes_precedence_between_the_turns_that_the_readme_names(direction, missing, axis):
    readme = " ".join((Path(__file__).parents[2] / "README.md").read_text().split())
    found = re.search(rf"([\d.]+) to ([\d.]+) rad {direction}", readme)
    assert found
    least, most = map(float, found.groups())
    # Gamma_11 = 5 / s: a body that spins at 5 theta will have turned by theta.
    spin = np.zeros(3)
    spin[axis] = 5.0 if axis else -5.0
    behind = (-0.15, 0.0) if axis else (0.0, 0.0)
    assert urgency(behind, 0.98 * least * spin, missing) == 0.0
    assert 0.0 < urgency(behind, 1.02 * least * spin, missing) < 0.2
    assert 0.8 < urgency(behind, 0.98 * most * spin, missing) < 1.0
    assert urgency(behind, 1.02 * most * spin, missing) == 1.0
