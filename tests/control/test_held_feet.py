"""Glued feet and a shared weight, by the laws they follow from."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.control.held_feet import holding_torque, motion_of_held_feet, weight_on_feet
from momentum_lab.momentum.centroidal import momentum_rate
from tests.conftest import assert_close
from tests.control.situations import BOTH, LEVEL, G, home, null_space, swaying

STANCES = [BOTH, (0,), (1,)]


def about_com(robot, dynamics, wrench) -> np.ndarray:
    """Sum of foot wrenches about the CoM (6,)."""
    arms = dynamics.sole_position - dynamics.com_in_world
    return np.concatenate([wrench[:, :3].sum(0), (np.cross(arms, wrench[:, :3]) + wrench[:, 3:]).sum(0)])


@pytest.mark.parametrize("stance", STANCES)
def test_motion_obeys_the_equations_of_motion_and_the_glue(robot, rng, stance):
    for _ in range(5):
        dynamics = swaying(robot, rng, stance)
        torque = rng.normal(scale=0.1, size=robot.na) * robot.effort_limit
        acceleration, wrench = motion_of_held_feet(dynamics, torque, stance, LEVEL)
        force = dynamics.mass_matrix @ acceleration + dynamics.nonlinear_effects
        force -= np.einsum("fi,fij->j", wrench, dynamics.sole_jacobian)
        assert_close(force, np.concatenate([np.zeros(6), torque]), 1e-8 * robot.mass * G)
        feet = list(stance)
        still = dynamics.sole_jacobian[feet] @ acceleration + dynamics.sole_bias[feet]
        assert_close(still, np.zeros_like(still), 1e-4)
        assert not np.delete(wrench, feet, axis=0).any()


def test_momentum_rate_is_gravity_and_the_wrenches_of_the_glue(robot, rng):
    """Eqs. 1 and 2."""
    dynamics = swaying(robot, rng)
    acceleration, wrench = motion_of_held_feet(dynamics, rng.normal(size=robot.na), BOTH, LEVEL)
    expected = about_com(robot, dynamics, wrench)
    expected[2] -= robot.mass * G
    assert_close(momentum_rate(dynamics, acceleration), expected, 1e-8 * robot.mass * G)


@pytest.mark.parametrize("stance", STANCES)
def test_the_weight_is_carried_and_turns_nothing(robot, rng, stance):
    dynamics = swaying(robot, rng, stance)
    wrench = weight_on_feet(robot, dynamics, stance)
    weight = np.array([0.0, 0.0, robot.mass * G, 0.0, 0.0, 0.0])
    assert_close(about_com(robot, dynamics, wrench), weight, 1e-9 * robot.mass * G)
    assert not np.delete(wrench, list(stance), axis=0).any()


def test_no_other_sharing_is_smaller(robot, rng):
    """Whatever two feet do against each other costs more: the gradient has no part along it."""
    dynamics = swaying(robot, rng)
    wrench = weight_on_feet(robot, dynamics, BOTH)
    total = np.zeros((6, 12))
    for column in range(12):
        unit = np.zeros(12)
        unit[column] = 1.0
        total[:, column] = about_com(robot, dynamics, unit.reshape(2, 6))
    gradient = (wrench * np.array([1.0, 1.0, 1.0, 400.0, 400.0, 400.0])).ravel()
    assert_close(gradient @ null_space(total), 0.0, 1e-8 * robot.mass * G)


def test_a_robot_at_home_carries_half_its_weight_on_each_foot(robot):
    wrench = weight_on_feet(robot, home(robot), BOTH)
    assert_close(wrench[:, 2], np.full(2, robot.mass * G / 2.0), 0.02 * robot.mass * G)


@pytest.mark.parametrize("stance", STANCES)
def test_the_torques_that_hold_the_weight_hold_the_robot(robot, stance):
    """At rest with glued feet nothing moves."""
    dynamics = home(robot, stance)
    torque = holding_torque(dynamics, weight_on_feet(robot, dynamics, stance))
    acceleration, wrench = motion_of_held_feet(dynamics, torque, stance, LEVEL)
    assert_close(acceleration, np.zeros(robot.nv), 1e-5)
    assert_close(wrench, weight_on_feet(robot, dynamics, stance), 1e-4 * robot.mass * G)
