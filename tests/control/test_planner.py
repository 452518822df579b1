"""The rows of Table 1 as planners: their identities, and what they do to a robot that is pushed."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from momentum_lab.control.planner import OWN, PLANNERS, Support, planned_cop, planner_named
from momentum_lab.control.registry import CONTROLLERS, check_planner
from momentum_lab.errors import InputError
from momentum_lab.events import SelectController, SelectPlanner
from momentum_lab.experiments.table1 import force_beyond
from momentum_lab.momentum.ground import cmp_from_force, cop_from_momentum_rate, ground_reaction_force
from momentum_lab.momentum.pendulum import capture_point, pendulum_frequency
from momentum_lab.momentum.support import support_margin
from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session
from tests.conftest import assert_close
from tests.control.situations import goal, swaying
from tests.runs import CHAPTER_PUSH, forward_push, played

TAKERS = [name for name, entry in CONTROLLERS.items() if len(entry.planners) > 1]
LIMIT = 0.1


@pytest.fixture
def case(robot, rng):
    """A moving robot, its goal, desired rates, and soles as a support."""
    dynamics = swaying(robot, rng, speed=0.05)
    x, y = dynamics.sole_position[:, :2].mean(axis=0)
    corners = np.array([[x - 0.05, y - 0.1], [x + 0.08, y - 0.1], [x + 0.08, y + 0.1], [x - 0.05, y + 0.1]])
    desired = robot.mass * np.array([0.3, -0.2, 0.1, 0.05, -0.08, 0.02])
    return desired, dynamics, goal(robot, dynamics), Support(robot.mass, corners, 0.0)


def test_row_a_is_the_pendulum(case):
    """Eq. 22 and the LIPM: the CMP of the planned force is the desired CoP; at constant height dl = m w^2 (r - p)."""
    desired, dynamics, reference, support = case
    cop = planned_cop(dynamics, reference, support, np.zeros(2))
    rate = PLANNERS["cop-to-com"].plan(desired, dynamics, reference, support)
    force = ground_reaction_force(rate[:3], support.mass)
    assert_close(cmp_from_force(force, dynamics.com_in_world), cop, 1e-9)
    assert_close(rate[2:], desired[2:], 0.0)
    level = desired * np.array([1, 1, 0, 1, 1, 1])
    rate = PLANNERS["cop-to-com"].plan(level, dynamics, reference, support)
    omega = pendulum_frequency(float(dynamics.com_in_world[2]))
    assert_close(rate[:2], support.mass * omega**2 * (dynamics.com_in_world[:2] - cop), 1e-9)


def test_row_c_turns_the_body_until_force_and_cop_fit(case):
    """Eq. 21: the CoP of the planned rates is the desired one, and the linear rate is untouched."""
    desired, dynamics, reference, support = case
    rate = PLANNERS["cop-and-force"].plan(desired, dynamics, reference, support)
    force_z = ground_reaction_force(desired[:3], support.mass)[2]
    shift = np.array([-desired[4], desired[3]]) / force_z
    wanted = planned_cop(dynamics, reference, support, shift)
    assert_close(cop_from_momentum_rate(rate, dynamics.com_in_world, support.mass), wanted, 1e-9)
    assert_close(rate[[0, 1, 2, 5]], desired[[0, 1, 2, 5]], 0.0)
    assert np.abs(rate[3:5] - desired[3:5]).max() > 0.1


def test_the_planned_cop_brings_the_capture_point_back_from_inside_the_support(case):
    _, dynamics, reference, support = case
    far = dataclasses.replace(reference, com=reference.com + [0.0, 5.0, 0.0])
    assert support_margin(planned_cop(dynamics, far, support, np.zeros(2)), support.polygon) == pytest.approx(
        0.0, abs=1e-9
    )
    cop = planned_cop(dynamics, reference, dataclasses.replace(support, polygon=1e3 * SQUARE), np.zeros(2))
    capture = capture_point(dynamics.com_in_world, dynamics.com_velocity)
    # dxi = omega (xi - p) points to r_d
    assert (capture - cop) @ (reference.com[:2] - capture) > 0.0


SQUARE = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])


def run(robot, planner, controller):
    return played(robot, forward_push(robot, planner=planner, controller=controller))


@pytest.mark.parametrize("controller", TAKERS)
@pytest.mark.parametrize("planner", PLANNERS)
def test_the_chapters_push_is_caught(robot, planner, controller):
    session = run(robot, planner, controller)
    assert session.fall is None
    assert session.solver_failures == 0
    assert np.linalg.norm(session.recording.latest["com_velocity"]) < 0.05


@pytest.mark.parametrize("controller", TAKERS)
def test_a_point_mass_is_asked_for_no_force_that_would_turn_it(robot, controller):
    """Row a puts the CMP inside the support; Eq. 38 puts it beyond the toes, and the CoM goes less far."""
    ours, planned = run(robot, OWN, controller), run(robot, "cop-to-com", controller)
    assert force_beyond(planned) < 1e-4
    assert force_beyond(ours) > 1e-3
    way = [np.ptp(each.recording.column("com")[:, 0]) for each in (ours, planned)]
    assert way[1] > way[0]


@pytest.mark.parametrize("planner", ["cop-to-com", "cop-and-force"])
@pytest.mark.parametrize("controller", TAKERS)
def test_another_planner_in_mid_run_is_smooth(robot, planner, controller):
    push = Push(force=0.5 * CHAPTER_PUSH[robot.spec.name], direction_deg=40.0, start=0.1)
    scenario = Scenario("p", robot=robot.spec.name, controller=controller, seconds=1.0, pushes=(push,))
    session = Session(scenario, robot=robot)
    for tick in range(1000):
        if tick in (300, 650):
            session.post(SelectPlanner(planner if tick == 300 else OWN))
        session.tick()
    jumps = np.abs(np.diff(session.recording.column("torque"), axis=0)) / robot.effort_limit
    assert jumps[295:].max() < LIMIT
    assert session.choices.planner == OWN
    assert session.fall is None


def test_planners_go_with_controllers_that_take_rates(talos):
    assert TAKERS == ["computed-torque", "whole-body-qp"]
    with pytest.raises(InputError, match=r"^planner: got cop-to-com; allowed: momentum above slack-qp$"):
        check_planner("cop-to-com", "slack-qp")
    with pytest.raises(InputError, match=r"^planner: got zmp; allowed: one of momentum, cop-to-com"):
        planner_named("zmp")
    session = Session(Scenario("p", planner="cop-to-com"), talos)
    session.post(SelectController("slack-qp"))
    with pytest.raises(InputError, match="above slack-qp"):
        session.post(SelectPlanner("cop-and-force"))
    session.tick()
    assert session.choices.planner == OWN
