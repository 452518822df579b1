"""Fig. 6 as a whole: from a state to torques, and what must be true on the way."""

from __future__ import annotations

import dataclasses

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.control.computed_torque import ComputedTorque
from momentum_lab.control.computed_torque_gains import ComputedTorqueGains
from momentum_lab.control.gains import with_gains
from momentum_lab.momentum.support import nearest_in_polygon
from momentum_lab.physics.push import Push
from momentum_lab.robot.state import State
from momentum_lab.scenario import Scenario
from tests.conftest import assert_close
from tests.control.situations import BOTH, G, goal, home, moments_of_a_push, null_space, swaying
from tests.runs import CHAPTER_PUSH, played

GAINS = ComputedTorqueGains()
# The chapter's own law: no pelvis in Eq. 34, feet held by the constraint alone.
CHAPTER = {"pelvis_weight": 0.0, "contact_damping": 0.0}


def answer(robot, dynamics, gains=GAINS, priority=0.0, stance=BOTH, memory=None, reference=None):
    controller = ComputedTorque(robot, 1e-3)
    return controller.compute(
        dynamics,
        reference or goal(robot, dynamics, stance),
        gains,
        priority,
        memory or controller.initial_memory(dynamics),
    )


def falling_forward(robot, speed: float, stance=BOTH):
    """The home posture with a CoM velocity (m/s) along x and feet that stay, by the least joint motion."""
    still = home(robot, stance)
    free = null_space(still.sole_jacobian[list(stance)].reshape(-1, robot.nv))
    com = still.centroidal_map[:3] / robot.mass
    v = free @ np.linalg.pinv(com @ free) @ np.array([speed, 0.0, 0.0])
    return robot.at(State(still.state.q, v))


@pytest.mark.parametrize("stance", [BOTH, (0,), (1,)])
def test_torques_are_those_of_inverse_dynamics(robot, rng, stance):
    """Eq. 33 by Pinocchio's recursion with the admissible foot wrenches as external forces."""
    for _ in range(5):
        dynamics = swaying(robot, rng, stance)
        output = answer(robot, dynamics, stance=stance)
        data = robot.model.createData()
        state = dynamics.state
        pin.framesForwardKinematics(robot.model, data, state.q)
        external = pin.StdVec_Force()
        external.extend([pin.Force.Zero() for _ in range(robot.model.njoints)])
        for foot, sole in enumerate(robot.soles):
            joint = robot.model.frames[sole.frame].parentJoint
            aligned = pin.SE3(np.eye(3), dynamics.sole_position[foot])
            force = pin.Force(output.foot_wrench_admissible[foot])
            external[joint] += data.oMi[joint].actInv(aligned.act(force))
        tau = pin.rnea(robot.model, data, state.q, state.v, output.acceleration, external)
        assert_close(output.torque, tau[6:], 1e-8 * robot.mass * G)


@pytest.mark.parametrize("stance", [BOTH, (0,)])
def test_the_free_base_is_asked_for_what_the_momentum_misses(robot, rng, stance):
    """Base rows of H a + C v + tau_g - J_c^T f_c: the missed momentum rate, moved to the base (Eq. 29)."""
    for _ in range(5):
        dynamics = swaying(robot, rng, stance)
        output = answer(robot, dynamics, stance=stance)
        base = dynamics.mass_matrix[:6] @ output.acceleration + dynamics.nonlinear_effects[:6]
        base -= np.einsum("fi,fij->j", output.foot_wrench_admissible, dynamics.sole_jacobian[:, :, :6])
        missed = dynamics.centroidal_map @ output.acceleration + dynamics.centroidal_bias
        missed -= output.momentum_rate_admissible
        placement = pin.XYZQUATToSE3(dynamics.state.q[:7])
        about_com = pin.SE3(np.eye(3), dynamics.com_in_world)
        expected = placement.actInv(about_com.act(pin.Force(missed))).vector
        assert_close(base, expected, 1e-9 * robot.mass * G)


@pytest.mark.parametrize("stance", [BOTH, (0,), (1,)])
def test_a_standing_robot_needs_nothing_at_its_free_base(robot, stance):
    dynamics = home(robot, stance)
    output = answer(robot, dynamics, stance=stance)
    base = dynamics.mass_matrix[:6] @ output.acceleration + dynamics.nonlinear_effects[:6]
    base -= np.einsum("fi,fij->j", output.foot_wrench_admissible, dynamics.sole_jacobian[:, :, :6])
    assert np.abs(base).max() < 1e-5 * robot.mass * G


def test_the_chapters_law_needs_next_to_nothing_at_the_free_base_while_moving(robot, rng):
    """Feet, momentum and upper body can all be obeyed: what is left is the ridge of the program."""
    for _ in range(5):
        dynamics = swaying(robot, rng, speed=0.1)
        output = answer(robot, dynamics, with_gains(GAINS, CHAPTER))
        missed = dynamics.centroidal_map @ output.acceleration + dynamics.centroidal_bias
        assert_close(missed, output.momentum_rate_admissible, 1e-3 * robot.mass * G)


def test_momentum_rates_are_gravity_and_the_foot_wrenches(robot, rng):
    """Eqs. 1 and 2 for the admissible rate."""
    for priority in (0.0, 0.5, 1.0):
        dynamics = swaying(robot, rng)
        output = answer(robot, dynamics, priority=priority)
        wrench = output.foot_wrench_admissible
        arms = dynamics.sole_position - dynamics.com_in_world
        rate = np.concatenate([wrench[:, :3].sum(0), (np.cross(arms, wrench[:, :3]) + wrench[:, 3:]).sum(0)])
        rate[2] -= robot.mass * G
        assert_close(output.momentum_rate_admissible, rate, 1e-9 * robot.mass * G)


def test_on_one_foot_priority_0_is_figure_7_left(robot):
    """l as desired, the CoP at the border of the safe sole, k short by (p_d - p_a) x f."""
    stance = (0,)
    dynamics = falling_forward(robot, 0.3, stance)
    output = answer(robot, dynamics, stance=stance)
    desired, admissible = output.momentum_rate_desired, output.momentum_rate_admissible
    force = desired[:3] + np.array([0.0, 0.0, robot.mass * G])
    assert_close(admissible[:3], desired[:3], 1e-6 * robot.mass * G)
    height = dynamics.com_in_world[2] - dynamics.sole_position[0, 2]
    p_d = (
        dynamics.com_in_world[:2]
        + np.array([-height * force[0] - desired[4], -height * force[1] + desired[3]]) / force[2]
    )
    sole = robot.soles[0]
    corners = dynamics.sole_position[0, :2] + np.array(
        [
            [x, y]
            for x, y in (
                (sole.lower[0] + GAINS.safe_border, sole.lower[1] + GAINS.safe_border),
                (sole.upper[0] - GAINS.safe_border, sole.lower[1] + GAINS.safe_border),
                (sole.upper[0] - GAINS.safe_border, sole.upper[1] - GAINS.safe_border),
                (sole.lower[0] + GAINS.safe_border, sole.upper[1] - GAINS.safe_border),
            )
        ]
    )
    p_a = nearest_in_polygon(p_d, corners)
    assert np.linalg.norm(p_d - p_a) > 0.01
    assert_close(output.cop_desired, p_d, 1e-6)
    assert_close(output.cop_admissible, p_a, 1e-6)
    lost = np.cross([*(p_d - p_a), 0.0], force)
    assert_close((desired - admissible)[3:5], lost[:2], 2e-4 * robot.mass * G)
    assert lost[1] < 0.0


def test_on_one_foot_priority_1_is_figure_7_right(robot):
    """k about the horizontal axes as desired, the force tilted about the same CoP, l gives way."""
    stance = (0,)
    dynamics = falling_forward(robot, 0.3, stance)
    left, right = (answer(robot, dynamics, priority=priority, stance=stance) for priority in (0.0, 1.0))
    desired, admissible = right.momentum_rate_desired, right.momentum_rate_admissible
    assert_close(admissible[3:5], desired[3:5], 2e-4 * robot.mass * G)
    assert admissible[2] == pytest.approx(desired[2], abs=1e-6 * robot.mass * G)
    assert_close(right.cop_admissible, left.cop_admissible, 1e-9)
    height = dynamics.com_in_world[2] - dynamics.sole_position[0, 2]
    fz = desired[2] + robot.mass * G
    tilted = ((dynamics.com_in_world[0] - right.cop_admissible[0]) * fz - desired[4]) / height
    assert admissible[0] == pytest.approx(tilted, abs=1e-4 * robot.mass * G)
    assert admissible[0] > desired[0] + 0.01 * robot.mass * G


def test_on_two_feet_the_ends_of_the_slider_keep_one_momentum_each(robot):
    """The net rates of both feet, as far as two programs with small weights are exact."""
    dynamics = falling_forward(robot, 0.3)
    left, right = (answer(robot, dynamics, priority=priority) for priority in (0.0, 1.0))
    weight = robot.mass * G
    assert_close(left.momentum_rate_admissible[:3], left.momentum_rate_desired[:3], 2e-3 * weight)
    assert_close(right.momentum_rate_admissible[3:5], right.momentum_rate_desired[3:5], 2e-3 * weight)
    assert np.abs(left.momentum_rate_admissible - left.momentum_rate_desired)[4] > 0.01 * weight
    assert np.abs(right.momentum_rate_admissible - right.momentum_rate_desired)[0] > 0.01 * weight


def test_the_slider_moves_torques_without_jumps(robot):
    dynamics = falling_forward(robot, 0.3)
    torques = np.array([answer(robot, dynamics, priority=p).torque for p in np.linspace(0, 1, 41)])
    whole = np.abs(torques[-1] - torques[0]).max()
    assert whole > 0.5
    assert np.abs(np.diff(torques, axis=0)).max() < 0.2 * whole


def test_feedback_is_added_to_the_torque(robot, rng):
    """Eq. 36: Gamma_p (theta* - theta) + Gamma_d (dtheta* - dtheta), nothing else changes."""
    dynamics = swaying(robot, rng)
    controller = ComputedTorque(robot, 1e-3)
    memory = controller.initial_memory(dynamics)
    ahead = dataclasses.replace(memory, angle=memory.angle + 0.01, rate=memory.rate - 0.2)
    plain = answer(robot, dynamics, memory=ahead)
    gains = with_gains(GAINS, {"feedback_stiffness": 300.0, "feedback_damping": 7.0})
    fed_back = answer(robot, dynamics, gains, memory=ahead)
    assert_close(fed_back.torque - plain.torque, np.full(robot.na, 300.0 * 0.01 - 7.0 * 0.2), 1e-8)
    assert_close(fed_back.acceleration, plain.acceleration, 0.0)


def test_the_joint_command_integrates_the_accelerations(robot, rng):
    """Eq. 35: one tick from the joints as they are."""
    dynamics = swaying(robot, rng)
    output = answer(robot, dynamics)
    rate = dynamics.state.v[6:] + 1e-3 * output.acceleration[6:]
    assert_close(output.memory.rate, rate, 1e-12)
    assert_close(output.memory.angle, dynamics.state.q[7:] + 1e-3 * rate, 1e-12)


def test_a_command_that_does_not_come_true_is_forgotten(robot):
    """Held in place, the joints pull their command back: it settles, and not far away."""
    dynamics = home(robot)
    controller = ComputedTorque(robot, 1e-3)
    reference = goal(robot, dynamics)
    memory = dataclasses.replace(controller.initial_memory(dynamics), angle=dynamics.state.q[7:] + 0.1)
    for _ in range(300):
        memory = controller.compute(dynamics, reference, GAINS, 0.0, memory).memory
    assert_close(memory.angle, dynamics.state.q[7:], 2e-3)


def test_a_controller_is_a_function_of_what_it_is_given(robot, rng):
    """The same question, after other questions: the same bits."""
    dynamics, other = swaying(robot, rng), swaying(robot, rng, (0,))
    controller = ComputedTorque(robot, 1e-3)
    memory = controller.initial_memory(dynamics)
    question = (dynamics, goal(robot, dynamics), GAINS, 0.3, memory)
    first = controller.compute(*question)
    controller.compute(other, goal(robot, other, (0,)), GAINS, 1.0, controller.initial_memory(other))
    again = controller.compute(*question)
    assert first.torque.tobytes() == again.torque.tobytes()
    assert first.acceleration.tobytes() == again.acceleration.tobytes()


def test_every_moment_of_a_push_has_an_answer(robot):
    for dynamics in moments_of_a_push(robot):
        output = answer(robot, dynamics)
        assert output.failure is None
        assert np.isfinite(output.torque).all()


def mismatch(session) -> np.ndarray:
    """Largest difference of measured and admissible foot wrenches, tick by tick (N,), N and N m."""
    column = session.recording.column
    return np.abs(column("foot_wrench_measured") - column("foot_wrench_admissible")).max(axis=(1, 2))


def pushed(robot, gains):
    push = Push(force=CHAPTER_PUSH[robot.spec.name], duration=0.1, start=0.2)
    return played(robot, Scenario("plant", robot=robot.spec.name, seconds=1.5, pushes=(push,), gains=gains))


def test_physics_gives_the_chapters_controller_the_wrenches_it_counts_on(robot):
    """A law that never sees the contact forces predicts them: to a millinewton, standing and recovering."""
    difference = mismatch(pushed(robot, CHAPTER))
    assert difference[:195].max() < 1e-3
    assert difference[700:].max() < 1e-3


def test_physics_gives_nearly_that_with_the_default_gains(robot):
    """Standing to a millinewton; on the way back the pelvis term and the damping of the feet cost half a percent."""
    difference = mismatch(pushed(robot, {}))
    assert difference[:195].max() < 1e-3
    assert difference[400:].max() < 5e-3 * robot.mass * G
