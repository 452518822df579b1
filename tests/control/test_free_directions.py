"""Directions of momentum that nobody asks for (section 5.3.1): left to the posture, and physics stays true."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from momentum_lab.control.computed_torque_gains import ComputedTorqueGains
from momentum_lab.control.registry import CONTROLLERS
from momentum_lab.momentum.centroidal import momentum_rate
from momentum_lab.momentum.directions import NAMES, directions
from tests.conftest import assert_close
from tests.control.situations import goal, swaying

# Controllers that work out momentum rates; the linear ones of slack-qp are its CoM output.
RATES = {"computed-torque": NAMES, "whole-body-qp": NAMES, "slack-qp": NAMES[:3]}
TEXTS = ["linear+kz", "linear", "lx+lz+ky", "angular"]


def answer(robot, dynamics, reference, controller="computed-torque"):
    entry = CONTROLLERS[controller]
    made = entry.make(robot, 1e-3)
    return made.compute(dynamics, reference, entry.gains, 0.0, made.initial_memory(dynamics))


def asked_for(robot, dynamics, text, **changes):
    return dataclasses.replace(goal(robot, dynamics), controlled=directions(text), **changes)


@pytest.mark.parametrize(
    ("controller", "name"), [(controller, name) for controller, names in RATES.items() for name in names]
)
def test_a_far_goal_in_a_free_direction_changes_nothing(robot, rng, controller, name):
    """And the same goal does change something once the direction is asked for."""
    dynamics = swaying(robot, rng, speed=0.05)
    i = NAMES.index(name)
    far = np.zeros(3)
    far[i % 3] = 0.01 if i < 3 else 0.5
    at = goal(robot, dynamics)
    change = {"com": at.com + far} if i < 3 else {"angular_momentum": at.angular_momentum + far}
    free = "+".join(other for other in NAMES if other != name)
    near = answer(robot, dynamics, asked_for(robot, dynamics, free), controller)
    away = answer(robot, dynamics, asked_for(robot, dynamics, free, **change), controller)
    assert near.failure is None
    assert_close(away.acceleration, near.acceleration, 1e-9)
    assert_close(away.torque, near.torque, 1e-7)
    asked = answer(robot, dynamics, asked_for(robot, dynamics, "all", **change), controller)
    still = answer(robot, dynamics, asked_for(robot, dynamics, "all"), controller)
    assert np.abs(asked.torque - still.torque).max() > 0.05


@pytest.mark.parametrize("text", TEXTS)
@pytest.mark.parametrize("controller", list(RATES))
def test_forces_accelerations_and_torques_belong_together(robot, rng, text, controller):
    """Eqs. 20, 28: momentum and motion follow from the granted wrenches, the base needs no motor."""
    dynamics = swaying(robot, rng, speed=0.05)
    out = answer(robot, dynamics, asked_for(robot, dynamics, text), controller)
    assert out.failure is None
    weight = robot.mass * 9.81
    assert_close(momentum_rate(dynamics, out.acceleration), out.momentum_rate_admissible, 2e-3 * weight)
    forces = dynamics.mass_matrix @ out.acceleration + dynamics.nonlinear_effects
    for jacobian, wrench in zip(dynamics.sole_jacobian, out.foot_wrench_admissible, strict=True):
        forces -= jacobian.T @ wrench
    assert_close(forces[6:], out.torque, 1e-6 * weight)
    assert np.abs(forces[:6]).max() < 2e-3 * weight


@pytest.mark.parametrize("text", TEXTS)
def test_what_is_asked_for_is_met_and_what_is_free_serves_the_posture(robot, rng, text):
    """Computed torque near rest, where the ground gives all: the posture gets nearer to what it wants."""
    dynamics = swaying(robot, rng, speed=0.05)
    some = answer(robot, dynamics, asked_for(robot, dynamics, text))
    every = answer(robot, dynamics, asked_for(robot, dynamics, "all"))
    asked = np.array(directions(text))
    assert_close(some.momentum_rate_desired[asked], every.momentum_rate_desired[asked], 1e-9)
    assert np.abs(some.momentum_rate_desired - every.momentum_rate_desired)[~asked].max() > 0.05
    gains, reference = ComputedTorqueGains(), goal(robot, dynamics)
    joints = robot.upper_body
    wanted = gains.posture_stiffness * (reference.posture - dynamics.state.q[7:])[joints]
    wanted -= gains.posture_damping * dynamics.state.v[6 + joints]
    misses = [np.linalg.norm(out.acceleration[6 + joints] - wanted) for out in (some, every)]
    assert misses[0] < misses[1]


def test_all_directions_cost_and_change_nothing(robot, rng, monkeypatch):
    dynamics = swaying(robot, rng)
    monkeypatch.setattr(
        "momentum_lab.control.accelerations.AccelerationProgram.rate_with_free_directions", None
    )
    assert answer(robot, dynamics, asked_for(robot, dynamics, "all")).failure is None
