"""The momentum regulator on the robots."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.control.momentum_lqr import LqrCosts, momentum_feedback
from momentum_lab.control.regulated import RegulatedMomentum
from momentum_lab.robot.state import State
from tests.conftest import assert_close, yaw_rotation
from tests.control.situations import BOTH, goal, home, swaying

COSTS = LqrCosts(position=0.02, velocity=0.1, spin=0.5, force=0.03)


@pytest.mark.parametrize("stance", [BOTH, (0,), (1,)])
def test_the_operating_point_is_the_standing_posture(robot, stance):
    """The middle of the soles is below the CoM, at its height."""
    dynamics = home(robot, stance)
    arms = np.array(RegulatedMomentum(robot).operating_point(dynamics.state.q[7:], stance).arms)
    assert_close(arms.mean(axis=0)[:2], np.zeros(2), 1e-6)
    assert_close(arms[:, 2], -dynamics.com_in_world[2], 1e-4)
    for foot, arm in zip(stance, arms, strict=True):
        sole = robot.soles[foot]
        center = dynamics.sole_position[foot] + np.append((sole.lower + sole.upper) / 2.0, 0.0)
        assert_close(arm, center - dynamics.com_in_world, 1e-4)


def test_its_closed_loop_is_hurwitz_on_every_stance(robot):
    regulated = RegulatedMomentum(robot)
    for stance in (BOTH, (0,), (1,)):
        point = regulated.operating_point(home(robot, stance).state.q[7:], stance)
        assert np.linalg.eigvals(momentum_feedback(point, COSTS)).real.max() < -0.1


def test_no_error_no_rate(robot):
    for stance in (BOTH, (0,)):
        dynamics = home(robot, stance)
        rate = RegulatedMomentum(robot).rate(dynamics, goal(robot, dynamics, stance), COSTS)
        assert np.abs(rate).max() < 1e-2 * robot.mass


def test_a_moving_com_is_braked_and_pulled_back(robot, rng):
    for _ in range(5):
        dynamics = swaying(robot, rng)
        reference = goal(robot, dynamics)
        rate = RegulatedMomentum(robot).rate(dynamics, reference, COSTS)
        error = dynamics.com_in_world - reference.com
        pull = 30.0 * error + 12.0 * dynamics.com_velocity
        assert rate[:2] @ pull[:2] < 0.0


def test_it_turns_with_the_robot(robot, rng):
    here = swaying(robot, rng)
    turn = yaw_rotation(2.5)
    q = here.state.q.copy()
    rotation = turn @ pin.Quaternion(q[3:7]).toRotationMatrix()
    q[:3], q[3:7] = turn @ q[:3] + [5.0, 7.0, 0.0], pin.Quaternion(rotation).normalized().coeffs()
    there = robot.at(State(q, here.state.v))
    regulated = RegulatedMomentum(robot)
    a = regulated.rate(here, goal(robot, here), COSTS)
    b = regulated.rate(there, goal(robot, there), COSTS)
    for part in (slice(0, 3), slice(3, 6)):
        assert_close(turn @ a[part], b[part], 1e-6 * robot.mass)
