"""PlaCo's whole-body program by the laws its answer must obey."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from momentum_lab.control.placo_tasks import Law, PlacoTasks, TaskLaws
from momentum_lab.errors import SolverError
from momentum_lab.momentum.directions import directions
from momentum_lab.momentum.foot_ground import FootGround
from momentum_lab.momentum.wrench import wrench_in_frame_axes
from tests.conftest import assert_close
from tests.control.situations import BOTH, G, goal, home, swaying

DT = 1e-3
LAWS = TaskLaws(
    com=Law(16.0, 8.0),
    pelvis=Law(100.0, 20.0),
    posture=Law(100.0, 20.0),
    contact_rate=50.0,
    safe_border=0.005,
    friction=0.6,
)
STANCES = [BOTH, (0,), (1,)]


def solved(robot, dynamics, stance=BOTH, laws=LAWS, priority=0.0, **changes):
    reference = dataclasses.replace(goal(robot, dynamics, stance), **changes)
    return PlacoTasks(robot, stance, DT).solve(dynamics, reference, laws, priority)


@pytest.mark.parametrize("stance", STANCES)
def test_the_answer_obeys_our_equations_of_motion(robot, rng, stance):
    """H a + C v + tau_g = S^T tau + J_c^T f_c with our own H, C, J_c: frames, axes and rotors are understood."""
    for _ in range(5):
        dynamics = swaying(robot, rng, stance, speed=0.1)
        answer = solved(robot, dynamics, stance)
        force = dynamics.mass_matrix @ answer.acceleration + dynamics.nonlinear_effects
        force -= np.einsum("fi,fij->j", answer.wrench, dynamics.sole_jacobian)
        assert_close(force, np.concatenate([np.zeros(6), answer.torque]), 1e-9 * robot.mass * G)


@pytest.mark.parametrize("stance", STANCES)
def test_feet_come_to_rest_flat_on_the_ground(robot, rng, stance):
    """Eq. 31: J_c a + dJ_c v = -2 kappa J_c v - kappa^2 e about the middle of each sole."""
    dynamics = swaying(robot, rng, stance, speed=0.1)
    answer = solved(robot, dynamics, stance)
    feet = list(stance)
    motion = dynamics.sole_jacobian[feet] @ dynamics.state.v
    rate = dynamics.sole_jacobian[feet] @ answer.acceleration + dynamics.sole_bias[feet]
    height = dynamics.sole_position[feet, 2]
    tilt = dynamics.sole_rotation[feet, :, 2]
    expected = -100.0 * motion
    expected[:, 3] += 2500.0 * tilt[:, 1]
    expected[:, 4] -= 2500.0 * tilt[:, 0]
    assert_close(rate[:, 3:5], expected[:, 3:5], 1e-3)
    assert_close(rate[:, :2], expected[:, :2], 0.02)
    assert_close(rate[:, 2], expected[:, 2] - 2500.0 * height, 0.02)


@pytest.mark.parametrize("stance", STANCES)
def test_wrenches_stay_within_cone_and_safe_sole(robot, rng, stance):
    """The true cone, although PlaCo's is a pyramid; the CoP of each foot 5 mm inside the edge."""
    for _ in range(5):
        dynamics = swaying(robot, rng, stance, speed=0.5)
        answer = solved(robot, dynamics, stance)
        for foot in stance:
            local = wrench_in_frame_axes(answer.wrench[foot], dynamics.sole_rotation[foot])
            assert local[2] >= -1e-6
            assert np.hypot(local[0], local[1]) <= 0.6 * local[2] + 1e-6
            cop = np.array([-local[4], local[3]])
            assert (cop >= (robot.soles[foot].lower + 0.005) * local[2] - 1e-6).all()
            assert (cop <= (robot.soles[foot].upper - 0.005) * local[2] + 1e-6).all()
        assert (np.abs(answer.torque) <= robot.effort_limit + 1e-6).all()
        assert not np.delete(answer.wrench, list(stance), axis=0).any()


@pytest.mark.parametrize("priority", [0.0, 1.0])
def test_the_com_accelerates_as_its_task_says(robot, rng, priority):
    """Costs of torque and force bend it by less than 0.01 m/s^2; PlaCo's defaults by up to 0.5."""
    for _ in range(5):
        dynamics = swaying(robot, rng, speed=0.02)
        reference = goal(robot, dynamics)
        answer = solved(robot, dynamics, priority=priority)
        rate = dynamics.centroidal_map[:3] @ answer.acceleration + dynamics.centroidal_bias[:3]
        expected = 16.0 * (reference.com - dynamics.com_in_world) - 8.0 * dynamics.com_velocity
        assert np.abs(expected).max() > 0.02
        assert_close(rate / robot.mass, expected, 0.01)


def test_a_free_axis_of_the_com_is_left_alone(robot, rng):
    """A far goal along an axis that is not controlled changes nothing (section 5.3.1)."""
    dynamics = swaying(robot, rng, speed=0.02)
    reference = goal(robot, dynamics)
    controlled = directions("lx+lz")
    near = solved(robot, dynamics, controlled=controlled)
    far = solved(robot, dynamics, controlled=controlled, com=reference.com + [0.0, 0.5, 0.0])
    other = solved(robot, dynamics, controlled=controlled, com=reference.com + [0.05, 0.0, 0.0])
    assert far.torque.tobytes() == near.torque.tobytes()
    assert np.abs(other.torque - near.torque).max() > 0.1


def test_the_answer_is_a_function_of_the_question(robot, rng):
    """After other questions, with other gains and priority, and from another instance: the same bits."""
    first, second = PlacoTasks(robot, BOTH, DT), PlacoTasks(robot, BOTH, DT)
    dynamics, other = swaying(robot, rng), swaying(robot, rng)
    reference = goal(robot, dynamics)
    answer = first.solve(dynamics, reference, LAWS, 0.2)
    changed = dataclasses.replace(LAWS, com=Law(3.0, 1.0), friction=0.3, safe_border=0.01, contact_rate=10.0)
    partial = dataclasses.replace(goal(robot, other), controlled=directions("lx"))
    first.solve(other, partial, changed, 0.9)
    for again in (first.solve(dynamics, reference, LAWS, 0.2), second.solve(dynamics, reference, LAWS, 0.2)):
        assert again.torque.tobytes() == answer.torque.tobytes()
        assert again.wrench.tobytes() == answer.wrench.tobytes()


def test_after_a_failure_it_answers_as_before(robot):
    """Limits that no torque meets are an error in words, and leave nothing behind."""
    tasks, dynamics = PlacoTasks(robot, BOTH, DT), home(robot)
    reference = goal(robot, dynamics)
    answer = tasks.solve(dynamics, reference, LAWS, 0.0)
    floating = dataclasses.replace(reference, ground=FootGround.level(2, -2.0))
    with pytest.raises(SolverError, match="PlaCo finds no torques within the limits"):
        tasks.solve(dynamics, floating, LAWS, 0.0)
    assert tasks.solve(dynamics, reference, LAWS, 0.0).torque.tobytes() == answer.torque.tobytes()
