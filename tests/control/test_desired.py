"""Eqs. 37 and 38: what balance asks of the momentum."""

from __future__ import annotations

import dataclasses

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.control.desired import desired_angular_rate, desired_linear_rate
from tests.conftest import assert_close
from tests.control.situations import goal, home, swaying


def at_its_goal(robot, dynamics):
    """A reference that the state meets in every respect."""
    return dataclasses.replace(
        goal(robot, dynamics),
        com=dynamics.com_in_world,
        com_velocity=dynamics.com_velocity,
        angular_momentum=dynamics.momentum[3:],
        pelvis_rotation=dynamics.pelvis_rotation,
    )


def test_no_error_asks_for_no_rate(robot, rng):
    dynamics = swaying(robot, rng)
    reference = at_its_goal(robot, dynamics)
    assert_close(desired_linear_rate(robot.mass, dynamics, reference, 8.0, 16.0), np.zeros(3), 1e-12)
    assert_close(desired_angular_rate(dynamics, reference, 5.0, 4.0), np.zeros(3), 1e-12)


def test_linear_rate_is_mass_times_spring_and_damper(robot, rng):
    """Eq. 38 by known errors: 1 cm forward and 0.2 m/s to the left."""
    dynamics = swaying(robot, rng)
    reference = dataclasses.replace(
        goal(robot, dynamics),
        com=dynamics.com_in_world - [0.01, 0.0, 0.0],
        com_velocity=dynamics.com_velocity - [0.0, 0.2, 0.0],
    )
    rate = desired_linear_rate(robot.mass, dynamics, reference, damping=7.0, stiffness=20.0)
    assert_close(rate, robot.mass * np.array([-0.2, -1.4, 0.0]), 1e-9)


def test_angular_rate_brakes_what_exceeds_the_wish(robot, rng):
    """Eq. 37 with K_theta = 0: the chapter's law, -Gamma_11 times the error."""
    dynamics = swaying(robot, rng)
    excess = np.array([0.3, -0.2, 0.1])
    reference = dataclasses.replace(goal(robot, dynamics), angular_momentum=dynamics.momentum[3:] - excess)
    assert_close(desired_angular_rate(dynamics, reference, 6.0, 0.0), -6.0 * excess, 1e-12)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_turned_pelvis_is_turned_back_about_the_same_axis(robot, axis):
    """The extension: -K_theta I_G times the rotation vector from the reference to the pelvis."""
    dynamics = home(robot)
    turn = 0.2 * np.eye(3)[axis]
    reference = dataclasses.replace(
        at_its_goal(robot, dynamics), pelvis_rotation=pin.exp3(-turn) @ dynamics.pelvis_rotation
    )
    rate = desired_angular_rate(dynamics, reference, 5.0, 4.0)
    assert_close(rate, -4.0 * dynamics.locked_inertia @ turn, 1e-9)
    assert rate[axis] < 0.0


def test_the_unsaturated_loop_is_a_spring_and_damper(robot, rng):
    """dl/dt = m r'': with Eq. 38 the CoM error obeys r'' + G21 r' + G22 r = 0, here by one explicit step."""
    dynamics = swaying(robot, rng)
    reference = goal(robot, dynamics)
    acceleration = desired_linear_rate(robot.mass, dynamics, reference, 8.0, 16.0) / robot.mass
    error, speed = dynamics.com_in_world - reference.com, dynamics.com_velocity
    assert_close(acceleration + 8.0 * speed + 16.0 * error, np.zeros(3), 1e-12)
