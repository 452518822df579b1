"""Torques when there is no answer: a held posture, said in words, and never silently zero."""

from __future__ import annotations

import dataclasses

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.control import computed_torque
from momentum_lab.control.computed_torque import ComputedTorque
from momentum_lab.control.computed_torque_gains import ComputedTorqueGains
from momentum_lab.control.controller import JointMotion
from momentum_lab.control.fallback import HOLD_IN_WORDS, hold, hold_posture, limp
from momentum_lab.errors import SolverError
from tests.conftest import assert_close
from tests.control.situations import goal, home, swaying


def test_at_rest_in_its_posture_nothing_is_held(robot):
    dynamics = home(robot)
    assert_close(hold_posture(robot, dynamics, goal(robot, dynamics)), np.zeros(robot.na), 0.0)


def test_springs_reach_the_torque_limit_at_three_tenths_of_a_radian(robot):
    dynamics = home(robot)
    reference = dataclasses.replace(goal(robot, dynamics), posture=dynamics.state.q[7:] + 0.3)
    torque = hold_posture(robot, dynamics, reference)
    assert_close(torque, robot.effort_limit, 1e-9)


def test_dampers_act_against_the_joint_rates(robot, rng):
    dynamics = swaying(robot, rng)
    reference = dataclasses.replace(goal(robot, dynamics), posture=dynamics.state.q[7:])
    torque = hold_posture(robot, dynamics, reference)
    assert_close(torque, -robot.effort_limit / 6.0 * dynamics.state.v[6:], 1e-9)


def test_a_posture_that_moves_is_followed_at_its_rate(robot, rng):
    """Where the joints are and move as the posture does, springs and dampers have nothing to do."""
    dynamics = swaying(robot, rng)
    angle, rate = dynamics.state.q[7:], dynamics.state.v[6:]
    reference = dataclasses.replace(goal(robot, dynamics), posture=angle, posture_rate=rate)
    assert_close(hold_posture(robot, dynamics, reference), np.zeros(robot.na), 1e-9)


def test_in_the_air_the_joints_accelerate_as_told(robot, rng):
    """Pinocchio's forward dynamics of the free robot under these torques gives the accelerations back."""
    dynamics = swaying(robot, rng)
    acceleration = rng.standard_normal(robot.na)
    motion = JointMotion(dynamics.state.q[7:], dynamics.state.v[6:], acceleration)
    reference = dataclasses.replace(goal(robot, dynamics), in_the_air=motion)
    torque = np.concatenate([np.zeros(6), hold_posture(robot, dynamics, reference)])
    data = robot.model.createData()
    found = pin.aba(robot.model, data, dynamics.state.q, dynamics.state.v, torque)
    assert_close(found[6:], acceleration, 1e-8)


def test_a_limp_robot_only_brakes_its_joints(robot, rng):
    dynamics, memory = swaying(robot, rng), object()
    output = limp(robot, dynamics, memory)
    assert_close(output.torque, -robot.effort_limit / 6.0 * dynamics.state.v[6:], 1e-9)
    assert not output.foot_wrench_admissible.any()
    assert np.isnan(output.cop_desired).all()
    assert output.failure is None
    assert output.memory is memory


@pytest.fixture
def lost(robot):
    """The answer to a state in which one foot would have to be in two places: Eq. 34 has no solution."""
    dynamics = home(robot)
    torn = dataclasses.replace(dynamics, sole_jacobian=dynamics.sole_jacobian.copy())
    torn.sole_jacobian[1] = torn.sole_jacobian[0]
    torn.sole_position[1, 2] += 0.01
    controller = ComputedTorque(robot, 1e-3)
    reference = goal(robot, home(robot))
    posture = reference.posture + 0.1
    reference = dataclasses.replace(reference, posture=posture)
    memory = controller.initial_memory(torn)
    return torn, reference, controller.compute(torn, reference, ComputedTorqueGains(), 0.0, memory)


def test_a_program_without_a_solution_holds_the_posture(robot, lost):
    dynamics, reference, output = lost
    assert_close(output.torque, hold_posture(robot, dynamics, reference), 0.0)
    assert np.abs(output.torque).max() > 1.0


def test_it_says_what_could_not_be_met_and_what_is_done_instead(lost):
    _, _, output = lost
    assert "cannot be met: " in output.failure
    assert output.failure.endswith(HOLD_IN_WORDS)
    assert not output.foot_wrench_admissible.any()


@pytest.mark.parametrize("step", ["AccelerationProgram.solve", "LoadSharing.share"])
def test_whichever_program_fails_its_reason_is_passed_on(robot, step, monkeypatch):
    def fails(*_):
        raise SolverError("cannot be met: the thing")

    owner, name = step.split(".")
    monkeypatch.setattr(getattr(computed_torque, owner), name, fails)
    dynamics = home(robot)
    controller = ComputedTorque(robot, 1e-3)
    output = controller.compute(
        dynamics, goal(robot, dynamics), ComputedTorqueGains(), 0.0, controller.initial_memory(dynamics)
    )
    assert output.failure == f"cannot be met: the thing; {HOLD_IN_WORDS}"
    assert_close(output.memory.angle, dynamics.state.q[7:], 0.0)


def test_a_controller_without_an_answer_holds_the_posture_and_says_why(robot, rng):
    dynamics, memory = swaying(robot, rng), object()
    reference = goal(robot, dynamics)
    output = hold(robot, dynamics, reference, "the sky is falling", memory)
    assert_close(output.torque, hold_posture(robot, dynamics, reference), 0.0)
    assert output.failure == f"the sky is falling; {HOLD_IN_WORDS}"
    assert output.memory is memory
    assert not output.foot_wrench_admissible.any()
