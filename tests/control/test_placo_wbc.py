"""The peer in the loop: what it says about the ground, and what the robot makes of its torques."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from momentum_lab.control.placo_wbc import PlacoWbc, PlacoWbcGains
from momentum_lab.momentum.foot_ground import FootGround
from momentum_lab.physics.push import Push
from momentum_lab.robot.state import State
from momentum_lab.scenario import Scenario
from tests.conftest import assert_close
from tests.control.situations import BOTH, G, goal, home, null_space, swaying
from tests.runs import CHAPTER_PUSH, played

GAINS = PlacoWbcGains()
NAME = "placo-wbc"


def answer(robot, dynamics, priority=0.0, stance=BOTH, reference=None):
    controller = PlacoWbc(robot, 1e-3)
    return controller.compute(
        dynamics,
        reference or goal(robot, dynamics, stance),
        GAINS,
        priority,
        controller.initial_memory(dynamics),
    )


def pushed(robot, factor, priority=0.0, **changes):
    """A run with a multiple of the chapter's push from behind."""
    push = Push(force=factor * CHAPTER_PUSH[robot.spec.name], duration=0.1, start=0.2)
    scenario = Scenario(
        "pushed",
        robot=robot.spec.name,
        controller=NAME,
        seconds=3.0,
        priority=priority,
        pushes=(push,),
        **changes,
    )
    return played(robot, scenario)


@pytest.mark.parametrize("stance", [BOTH, (0,), (1,)])
def test_at_home_nothing_moves(robot, stance):
    dynamics = home(robot, stance)
    output = answer(robot, dynamics, stance=stance)
    assert_close(output.acceleration, np.zeros(robot.nv), 0.05)
    assert_close(output.momentum_rate_desired, np.zeros(6), 0.01 * robot.mass * G)
    assert_close(output.cop_desired, dynamics.com_in_world[:2], 1e-3)


def test_momentum_rates_are_gravity_and_the_foot_wrenches(robot, rng):
    """Eqs. 1, 2 for the admissible rate; it is also A_G a + dA_G v (Eq. 20), and gives the CoP (Eq. 21)."""
    for priority in (0.0, 0.5, 1.0):
        dynamics = swaying(robot, rng)
        output = answer(robot, dynamics, priority)
        wrench = output.foot_wrench_admissible
        arms = dynamics.sole_position - dynamics.com_in_world
        rate = np.concatenate([wrench[:, :3].sum(0), (np.cross(arms, wrench[:, :3]) + wrench[:, 3:]).sum(0)])
        rate[2] -= robot.mass * G
        assert_close(output.momentum_rate_admissible, rate, 1e-9 * robot.mass * G)
        moved = dynamics.centroidal_map @ output.acceleration + dynamics.centroidal_bias
        assert_close(output.momentum_rate_admissible, moved, 1e-8 * robot.mass * G)
        feet = dynamics.sole_position
        moment = (np.cross(feet, wrench[:, :3]) + wrench[:, 3:]).sum(0)
        cop = np.array([-moment[1], moment[0]]) / wrench[:, 2].sum()
        assert np.ptp(feet[:, 2]) < 0.01
        assert_close(output.cop_admissible, cop, 5e-3)


def test_the_desired_force_is_that_of_the_com_task(robot, rng):
    """m (k e + d de)."""
    dynamics = swaying(robot, rng)
    reference = goal(robot, dynamics)
    output = answer(robot, dynamics)
    expected = 16.0 * (reference.com - dynamics.com_in_world) - 8.0 * dynamics.com_velocity
    assert_close(output.momentum_rate_desired[:3], robot.mass * expected, 1e-9)
    assert_close(output.momentum_rate_desired[3:], output.momentum_rate_admissible[3:], 0.0)


def test_a_foot_in_the_air_carries_nothing(robot):
    dynamics = home(robot, (0,))
    output = answer(robot, dynamics, stance=BOTH)
    assert output.failure is None
    assert not output.foot_wrench_admissible[1].any()
    assert output.foot_wrench_admissible[0, 2] == pytest.approx(robot.mass * G, rel=0.05)


def test_without_an_answer_the_posture_is_held_in_words(robot):
    dynamics = home(robot)
    flying = dataclasses.replace(dynamics, sole_position=dynamics.sole_position + [0.0, 0.0, 0.05])
    output = answer(robot, flying, reference=goal(robot, dynamics))
    assert output.failure is not None
    assert output.failure.startswith("no foot is on the ground; holding the posture")
    sunk = dataclasses.replace(dynamics, sole_position=dynamics.sole_position - [0.0, 0.0, 2.0])
    deep = dataclasses.replace(goal(robot, dynamics), ground=FootGround.level(2, -2.0))
    output = answer(robot, sunk, reference=deep)
    assert output.failure is not None
    assert output.failure.startswith("PlaCo finds no torques within the limits")
    assert not output.foot_wrench_admissible.any()


def test_it_stands_for_ten_seconds(robot):
    session = played(robot, Scenario("still", robot=robot.spec.name, controller=NAME, seconds=10.0))
    com = session.recording.column("com")
    assert session.fall is None
    assert session.solver_failures == 0
    assert np.abs(com - com[0]).max() < 1e-4


def test_standing_the_ground_gives_what_it_counts_on(robot):
    column = pushed(robot, 1.0).recording.column
    difference = np.abs(column("foot_wrench_measured") - column("foot_wrench_admissible")).max(axis=(1, 2))
    assert difference[:195].max() < 1e-3 * robot.mass * G
    assert difference[1000:].max() < 1e-3 * robot.mass * G


@pytest.mark.parametrize("priority", [0.0, 1.0])
def test_it_stands_the_chapters_push(robot, priority):
    session = pushed(robot, 1.0, priority)
    assert session.fall is None
    assert session.solver_failures == 0
    assert np.linalg.norm(session.recording.latest["com_velocity"]) < 0.02


def test_it_stands_on_one_leg_and_recovers_from_a_touch(robot):
    session = pushed(robot, 0.1, stance=("left",))
    assert session.fall is None
    assert np.linalg.norm(session.recording.latest["com_velocity"]) < 0.02


def test_priority_keeps_the_com_or_the_pelvis(robot):
    """Falling forward with the CoP at the toes: the CoM is braked and the body turns, or the other way round."""
    still = home(robot)
    free = null_space(still.sole_jacobian.reshape(-1, robot.nv))
    com = still.centroidal_map[:3] / robot.mass
    v = free @ np.linalg.pinv(com @ free) @ np.array([0.35, 0.0, 0.0])
    dynamics = robot.at(State(still.state.q, v))
    missed, turned = [], []
    for priority in (0.0, 0.5, 1.0):
        output = answer(robot, dynamics, priority)
        missed.append((output.momentum_rate_admissible - output.momentum_rate_desired)[0] / robot.mass)
        pelvis = (dynamics.pelvis_jacobian @ output.acceleration + dynamics.pelvis_bias)[3:]
        wanted = -GAINS.pelvis_damping * (dynamics.pelvis_jacobian @ v)[3:]
        turned.append((pelvis - wanted)[1])
    assert 0.0 <= missed[0] < missed[1] < missed[2]
    assert missed[2] > 0.3
    assert turned[0] > turned[1] > abs(turned[2])
    assert abs(turned[2]) < 0.1 * turned[0]
