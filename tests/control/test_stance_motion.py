"""The equations of motion (Eqs. 28 to 31) hold for whatever is chosen."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.control.accelerations import contact_constraint
from momentum_lab.control.stance_motion import stance_motion
from momentum_lab.momentum.wrench import sum_wrenches
from tests.conftest import assert_close
from tests.control.situations import BOTH, G, goal, swaying


@pytest.mark.parametrize("stance", [BOTH, (0,), (1,)])
def test_every_choice_is_a_motion_of_the_robot(robot, rng, stance):
    """H a + C v + tau_g = S tau + J_c^T f_c for all rows, the base's included (Eq. 28)."""
    for _ in range(5):
        dynamics = swaying(robot, rng, stance)
        motion = stance_motion(dynamics, goal(robot, dynamics, stance), stance, 50.0)
        x = rng.normal(size=motion.acceleration.matrix.shape[1])
        a, wrench = motion.acceleration.at(x), motion.wrench.at(x).reshape(-1, 6)
        left = dynamics.mass_matrix @ a + dynamics.nonlinear_effects
        left[6:] -= motion.torque.at(x)
        for foot, w in zip(stance, wrench, strict=True):
            left -= dynamics.sole_jacobian[foot].T @ w
        assert_close(left, np.zeros(robot.nv), 1e-9 * robot.mass * G)


@pytest.mark.parametrize("stance", [BOTH, (0,), (1,)])
def test_the_first_foot_stands_still_and_the_other_one_is_a_row(robot, rng, stance):
    """Eq. 31."""
    dynamics = swaying(robot, rng, stance)
    reference = goal(robot, dynamics, stance)
    motion = stance_motion(dynamics, reference, stance, 50.0)
    x = rng.normal(size=motion.acceleration.matrix.shape[1])
    rows, target = contact_constraint(dynamics, stance, reference, 50.0)
    missed = rows @ motion.acceleration.at(x) - target
    assert_close(missed[:6], np.zeros(6), 1e-9)
    assert_close(missed[6:], motion.still.at(x), 1e-9)
    assert motion.still.offset.size == 6 * (len(stance) - 1)


@pytest.mark.parametrize("stance", [BOTH, (0,)])
def test_wrenches_are_the_momentum_rate(robot, rng, stance):
    """Eqs. 1, 2 with Eq. 20: the base rows about the CoM."""
    dynamics = swaying(robot, rng, stance)
    motion = stance_motion(dynamics, goal(robot, dynamics, stance), stance, 50.0)
    x = rng.normal(size=motion.acceleration.matrix.shape[1])
    rate = dynamics.centroidal_map @ motion.acceleration.at(x) + dynamics.centroidal_bias
    wrench = motion.wrench.at(x).reshape(-1, 6)
    found = sum_wrenches(wrench, dynamics.sole_position[list(stance)], dynamics.com_in_world)
    found[2] -= robot.mass * G
    assert_close(found, rate, 1e-9 * robot.mass * G)


def test_a_stance_foot_in_the_air_carries_nothing(robot, rng):
    """It still has to follow its row, and the other one bears everything."""
    dynamics = swaying(robot, rng)
    motion = stance_motion(dynamics, goal(robot, dynamics), (1,), 50.0)
    assert motion.wrench.offset.size == 6
    assert motion.acceleration.matrix.shape[1] == robot.na
    assert motion.still.offset.size == 6
