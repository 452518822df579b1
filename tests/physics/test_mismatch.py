"""The real robot and its declaration: what may be wrong with it, and what then really is."""

from __future__ import annotations

import math

import numpy as np
import pytest

from momentum_lab.errors import InputError, ScenarioError
from momentum_lab.physics.mismatch import EXACT, Mismatch, changes, model_errors, real_robot, with_error
from momentum_lab.scenario import Scenario, changed
from tests.conftest import assert_close


@pytest.mark.parametrize("error", model_errors().values(), ids=lambda error: error.name)
def test_a_scenario_and_an_event_allow_the_same_values(error):
    for value in (error.low, error.high, error.default):
        one = changed(Scenario("test"), mismatch=Mismatch(**{error.name: value})).mismatch
        assert one == with_error(EXACT, error.name, value)
    for value in (error.low - 1e-6, error.high + 1e-6, math.nan, math.inf):
        with pytest.raises(ScenarioError, match=f"mismatch.{error.name}"):
            changed(Scenario("test"), mismatch={error.name: value})
        with pytest.raises(InputError, match=f"^mismatch {error.name}: got .*from {error.low:g} to"):
            with_error(EXACT, error.name, value)


def test_an_error_that_does_not_exist_is_answered_with_those_that_do():
    with pytest.raises(
        InputError, match=r"^mismatch: got mass; allowed: one of mass_error, joint_friction, "
    ):
        with_error(EXACT, "mass", 0.1)
    with pytest.raises(ScenarioError, match=r"^mismatch: got mass; allowed: the fields mass_error, "):
        changed(Scenario("test"), mismatch={"mass": 0.1})


def test_changes_lead_from_one_to_another():
    one, other = Mismatch(mass_error=0.1, imu_noise=1e-3), Mismatch(mass_error=-0.1, torque_scale=0.5)
    for name, value in changes(one, other):
        one = with_error(one, name, value)
    assert one == other


def test_a_robot_without_errors_is_the_believed_one(talos):
    assert real_robot(talos, Mismatch()) is talos


@pytest.mark.parametrize("error", [0.1, -0.3])
def test_a_heavier_robot_is_heavier_in_every_link(robot, random_states, error):
    """H without rotors, h, C v + tau_g and the locked inertia are linear in the masses; the CoM stays."""
    real, rotors = real_robot(robot, Mismatch(mass_error=error)), np.diag(robot.model.armature)
    assert real.mass == pytest.approx((1.0 + error) * robot.mass, rel=1e-12)
    for state in random_states[:5]:
        one, other = robot.at(state), real.at(state)
        links = (1.0 + error) * (one.mass_matrix - rotors)
        assert_close(other.mass_matrix - rotors, links, 1e-9)
        assert_close(other.momentum, (1.0 + error) * one.momentum, 1e-9)
        assert_close(other.nonlinear_effects, (1.0 + error) * one.nonlinear_effects, 1e-9)
        assert_close(other.locked_inertia, (1.0 + error) * one.locked_inertia, 1e-9)
        assert_close(other.com_in_world, one.com_in_world, 1e-9)
        assert_close(robot.at(state).momentum, one.momentum, 1e-9)  # the believed robot is as it was


def test_motors_and_friction_come_from_the_limits(talos):
    real = real_robot(talos, Mismatch(torque_scale=0.5, joint_friction=0.02))
    assert_close(real.effort_limit, 0.5 * talos.effort_limit, 1e-9)
    assert_close(real.joint_friction, 0.02 * talos.effort_limit, 1e-9)
    assert not talos.joint_friction.any()
