"""The goal of standing follows the feet."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.control.standing import StandingGoal
from momentum_lab.robot.state import State
from tests.conftest import assert_close, yaw_rotation
from tests.control.situations import BOTH, LEVEL, home


@pytest.mark.parametrize("stance", [BOTH, (0,), (1,)])
def test_at_home_nothing_is_asked_for(robot, stance):
    """CoM above the middle of the stance soles at its height, pelvis, posture and feet as they are."""
    dynamics = home(robot, stance)
    reference = StandingGoal(robot, dynamics, stance).reference(dynamics, LEVEL)
    assert_close(reference.com, dynamics.com_in_world, 2e-5)
    assert_close(reference.com_velocity, np.zeros(3), 0.0)
    assert_close(reference.angular_momentum, np.zeros(3), 0.0)
    assert_close(reference.pelvis_rotation, dynamics.pelvis_rotation, 1e-12)
    assert_close(reference.posture, dynamics.state.q[7:], 0.0)
    assert reference.ground is LEVEL
    assert reference.stance == stance


def test_the_goal_is_above_the_mean_of_the_sole_centres(robot):
    dynamics = home(robot)
    corners = [
        dynamics.sole_position[i] + sole.corners @ dynamics.sole_rotation[i].T
        for i, sole in enumerate(robot.soles)
    ]
    reference = StandingGoal(robot, dynamics, BOTH).reference(dynamics, LEVEL)
    assert_close(reference.com[:2], np.concatenate(corners)[:, :2].mean(axis=0), 1e-9)


def test_the_goal_moves_and_turns_with_the_feet(robot):
    dynamics = home(robot)
    turn, shift = yaw_rotation(2.4), np.array([7.0, -3.0, 0.0])
    q = dynamics.state.q.copy()
    q[:3] = turn @ q[:3] + shift
    rotation = turn @ pin.Quaternion(dynamics.state.q[3:7]).toRotationMatrix()
    q[3:7] = pin.Quaternion(rotation).coeffs()
    standing = StandingGoal(robot, dynamics, BOTH)
    here = standing.reference(dynamics, LEVEL)
    there = standing.reference(robot.at(State(q, dynamics.state.v)), LEVEL)
    assert_close(there.com, turn @ here.com + shift, 1e-9)
    assert_close(there.pelvis_rotation, turn @ here.pelvis_rotation, 1e-9)
    assert_close(there.posture, here.posture, 0.0)


def test_the_goal_does_not_follow_the_body(robot, rng):
    """Joints of the upper body may move as they like; the feet decide."""
    dynamics = home(robot)
    q = dynamics.state.q.copy()
    q[7 + robot.upper_body] += rng.uniform(-0.05, 0.05, robot.upper_body.size)
    standing = StandingGoal(robot, dynamics, BOTH)
    here, there = (
        standing.reference(dynamics, LEVEL),
        standing.reference(robot.at(State(q, dynamics.state.v)), LEVEL),
    )
    assert_close(there.com, here.com, 1e-12)
    assert_close(there.pelvis_rotation, here.pelvis_rotation, 1e-12)
