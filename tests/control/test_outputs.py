"""Eqs. 42 to 45 for every output."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.control.outputs import (
    LiftedSoles,
    Spring,
    com_output,
    least_squares,
    pelvis_output,
    posture_output,
    sole_output,
)
from momentum_lab.control.stance_motion import Affine
from momentum_lab.robot.state import State
from tests.conftest import assert_close
from tests.control.situations import goal, home, swaying

SPRING = Spring(16.0, 8.0)
LEFT = (0,)


def all_outputs(robot, dynamics, reference):
    lifted = LiftedSoles(robot)
    pose = lifted.goal(dynamics, reference.posture, 1, 0)
    return [
        com_output(robot.mass, dynamics, reference, SPRING, 1e4),
        pelvis_output(dynamics, reference, SPRING, 10.0),
        sole_output(dynamics, 1, pose, SPRING, 10.0),
        posture_output(dynamics, reference, robot.upper_body, SPRING, 1.0),
    ]


def test_at_the_goal_nothing_is_asked_for(robot):
    """But for the 2e-5 m that the posture may be beside the middle of the foot."""
    dynamics = home(robot, LEFT)
    for output in all_outputs(robot, dynamics, goal(robot, dynamics, LEFT)):
        assert_close(output.desired, np.zeros_like(output.desired), SPRING.stiffness * 2e-5)
        assert_close(output.bias, np.zeros_like(output.bias), 1e-12)


def positions(robot, dynamics):
    """What the outputs are functions of: CoM, pelvis axes, sole position and axes, joint angles."""
    upper = robot.upper_body
    return (
        dynamics.com_in_world,
        dynamics.pelvis_rotation,
        dynamics.sole_position[1],
        dynamics.sole_rotation[1],
        dynamics.state.q[7:][upper],
    )


def test_accelerations_are_second_differences(robot, rng):
    """y'' = J a + Psi (Eq. 45); orientations by the rotation vector from the present one."""
    step = 1e-4
    for _ in range(3):
        now = swaying(robot, rng, LEFT)
        a = rng.normal(size=robot.nv)
        q, v = now.state.q, now.state.v
        moments = [
            robot.at(State(pin.integrate(robot.model, q, s * v + 0.5 * s * s * a), v)) for s in (step, -step)
        ]
        after, before = (positions(robot, moment) for moment in moments)
        here = positions(robot, now)

        def second(i, after=after, before=before, here=here):
            return (after[i] - 2.0 * here[i] + before[i]) / step**2

        def turning(i, after=after, before=before, here=here):
            return (pin.log3(after[i] @ here[i].T) + pin.log3(before[i] @ here[i].T)) / step**2

        expected = [second(0), turning(1), np.concatenate([second(2), turning(3)]), second(4)]
        for output, y in zip(all_outputs(robot, now, goal(robot, now, LEFT)), expected, strict=True):
            assert_close(output.jacobian @ a + output.bias, y, 1e-5)


def test_springs_pull_back_and_dampers_brake(robot, rng):
    """Eq. 42 undone: the desired acceleration of a pure spring turns each output towards its goal."""
    now = swaying(robot, rng, LEFT)
    reference = goal(robot, now, LEFT)
    com = com_output(robot.mass, now, reference, Spring(4.0, 0.0), 1.0)
    assert_close(now.com_in_world + com.desired / 4.0, reference.com, 1e-12)
    pelvis = pelvis_output(now, reference, Spring(4.0, 0.0), 1.0)
    assert_close(pin.exp3(pelvis.desired / 4.0) @ now.pelvis_rotation, reference.pelvis_rotation, 1e-9)
    posture = posture_output(now, reference, robot.upper_body, Spring(0.0, 3.0), 1.0)
    assert_close(posture.desired, -3.0 * now.state.v[6:][robot.upper_body], 1e-12)


def test_the_lifted_sole_goes_where_the_posture_has_it(robot):
    """From a foot that stands somewhere else: the same place seen from there."""
    at_home = home(robot, LEFT)
    lifted = LiftedSoles(robot)
    posture = at_home.state.q[7:]
    pose = lifted.goal(at_home, posture, 1, 0)
    assert_close(pose.translation, at_home.sole_position[1], 1e-9)
    assert_close(pose.rotation, at_home.sole_rotation[1], 1e-9)


def test_the_slack_is_what_is_missing(robot, rng):
    now = swaying(robot, rng, LEFT)
    a = rng.normal(size=robot.nv)
    for output in all_outputs(robot, now, goal(robot, now, LEFT)):
        assert_close(output.slack(a) + output.jacobian @ a + output.bias, output.desired, 1e-9)


def test_least_squares_is_the_weighted_sum(robot, rng):
    now = swaying(robot, rng, LEFT)
    outputs = all_outputs(robot, now, goal(robot, now, LEFT))
    motion = Affine(rng.normal(size=(robot.nv, 7)), rng.normal(size=robot.nv))
    hessian, gradient = least_squares(outputs, motion)

    def cost(x):
        return sum(0.5 * out.weight * out.slack(motion.at(x)) @ out.slack(motion.at(x)) for out in outputs)

    for x in rng.normal(size=(5, 7)):
        quadratic = 0.5 * x @ hessian @ x + gradient @ x
        assert quadratic == pytest.approx(cost(x) - cost(np.zeros(7)), rel=1e-9)
