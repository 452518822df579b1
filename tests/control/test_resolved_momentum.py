"""Section 4.1 in the loop: what the set-point does, what the servos do, and what the robot makes of it."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from momentum_lab.control.gains import with_gains
from momentum_lab.control.held_feet import holding_torque, weight_on_feet
from momentum_lab.control.resolved_momentum import ResolvedMomentum, ResolvedMomentumGains
from momentum_lab.momentum.directions import ALL, directions
from momentum_lab.physics.push import Push
from momentum_lab.robot.state import State
from momentum_lab.scenario import Scenario
from tests.conftest import assert_close
from tests.control.situations import BOTH, G, goal, home, swaying
from tests.runs import CHAPTER_PUSH, forward_push, played

GAINS = ResolvedMomentumGains()
DT = 1e-3
NAME = "resolved-momentum"


def answer(robot, dynamics, gains=GAINS, stance=BOTH, memory=None, reference=None):
    controller = ResolvedMomentum(robot, DT)
    return controller.compute(
        dynamics,
        reference or goal(robot, dynamics, stance),
        gains,
        0.0,
        memory or controller.initial_memory(dynamics),
    )


def pushed(robot, factor, **changes):
    """A run with a multiple of the chapter's push from behind."""
    push = Push(force=factor * CHAPTER_PUSH[robot.spec.name], duration=0.1, start=0.2)
    scenario = Scenario(
        "pushed", robot=robot.spec.name, controller=NAME, seconds=3.0, pushes=(push,), **changes
    )
    return played(robot, scenario)


@pytest.mark.parametrize("stance", [BOTH, (0,), (1,)])
def test_at_home_nothing_moves_and_the_torques_hold_the_weight(robot, stance):
    dynamics = home(robot, stance)
    output = answer(robot, dynamics, stance=stance)
    weight = weight_on_feet(robot, dynamics, stance)
    assert_close(output.memory.v, np.zeros(robot.nv), 1e-3)
    assert_close(output.torque, holding_torque(dynamics, weight), 1e-3 * robot.mass)
    assert_close(output.foot_wrench_admissible, weight, 1e-2 * robot.mass * G)


@pytest.mark.parametrize("text", ["all", "linear+kz", "lx+ly+ky", "linear"])
def test_the_set_point_has_the_momentum_that_is_asked_for(robot, rng, text):
    """A_G(q*) v* is h_d in the controlled directions, the soles of the set-point stay on their footholds."""
    controller, rows = ResolvedMomentum(robot, DT), np.array(directions(text))
    dynamics = swaying(robot, rng, speed=0.05)
    memory = controller.initial_memory(dynamics)
    reference = dataclasses.replace(
        goal(robot, dynamics), controlled=directions(text), angular_momentum=np.array([0.3, -0.4, 0.2])
    )
    output = answer(robot, dynamics, memory=memory, reference=reference)
    setpoint = robot.at(State(memory.q, output.memory.v))
    desired = controller.desired_momentum(dynamics, reference, GAINS, memory.q)
    assert np.abs(desired).min() > 1e-3
    assert_close((setpoint.momentum - desired)[rows], 0.0, 1e-3)
    assert_close(setpoint.sole_jacobian.reshape(-1, robot.nv) @ output.memory.v, np.zeros(12), 1e-9)
    assert_close(output.memory.q, robot.integrate(memory.q, DT * output.memory.v), 0.0)


def test_the_desired_momentum_is_zero_at_the_goal_and_follows_its_laws(robot):
    """m kappa per metre of the set-point, - m kappa T per speed of the real CoM; k_d as the reference says."""
    controller, dynamics = ResolvedMomentum(robot, DT), home(robot)
    reference, q = goal(robot, dynamics), dynamics.state.q
    assert_close(controller.desired_momentum(dynamics, reference, GAINS, q), np.zeros(6), 1e-8)
    ahead = dataclasses.replace(
        reference, com=reference.com + [0.01, 0.0, -0.02], angular_momentum=np.array([1.0, 2.0, 3.0])
    )
    expected = [robot.mass * GAINS.com_rate * 0.01, 0.0, -robot.mass * GAINS.com_rate * 0.02, 1.0, 2.0, 3.0]
    assert_close(controller.desired_momentum(dynamics, ahead, GAINS, q), expected, 1e-8)
    drifting = dataclasses.replace(dynamics, com_velocity=np.array([0.0, 0.1, 0.0]))
    lean = controller.desired_momentum(drifting, reference, GAINS, q)
    assert lean[1] == pytest.approx(-robot.mass * GAINS.com_rate * GAINS.com_lead * 0.1, abs=1e-8)


def test_only_asked_directions_of_angular_momentum_are_kept(robot):
    """Raising both arms forward turns the body, unless the body must not turn (section 5.3.1)."""
    dynamics = home(robot)
    reference = goal(robot, dynamics)
    posture = reference.posture.copy()
    for i, name in enumerate(robot.joint_names):
        if name in ("arm_left_1_joint", "left_shoulder_pitch_joint", "right_shoulder_pitch_joint"):
            posture[i] -= 0.5
        if name in ("arm_left_2_joint", "arm_right_2_joint"):
            posture[i] += 0.3
    spin = []
    for controlled in (ALL, directions("linear")):
        asked = dataclasses.replace(reference, posture=posture, controlled=controlled)
        rates = answer(robot, dynamics, reference=asked).memory.v
        spin.append(np.linalg.norm(dynamics.centroidal_map[3:] @ rates))
    assert spin[0] < 1e-3
    assert spin[1] > 0.05


def test_a_servo_pulls_as_at_the_end_of_the_tick(robot, rng):
    """In the air: move on under the torque for a tick, then k and T give that very torque."""
    controller, dynamics = ResolvedMomentum(robot, DT), swaying(robot, rng)
    ahead = controller.initial_memory(dynamics)
    ahead = dataclasses.replace(ahead, v=rng.normal(size=robot.nv))
    ahead.q[7:] += rng.normal(scale=0.01, size=robot.na)
    torque = controller._servo_torque(dynamics, ahead, GAINS)
    gained = np.linalg.solve(dynamics.mass_matrix, np.concatenate([np.zeros(6), torque]))[6:]
    rate = dynamics.state.v[6:] + DT * gained
    angle = dynamics.state.q[7:] + DT * rate
    behind = ahead.q[7:] - angle + GAINS.servo_damping * (ahead.v[6:] - rate)
    assert_close(torque, GAINS.servo_stiffness * robot.effort_limit * behind, 1e-8)


def test_nobody_looks_at_the_cop(robot):
    """In a push the servos ask for a CoP centimetres beyond the toes, and nobody tells them it is not there."""
    column = pushed(robot, 1.5).recording.column
    toes = column("sole_pose")[0, 0, 0] + robot.soles[0].upper[0]
    assert column("cop_desired")[200:310, 0].max() > toes + 0.01
    assert column("cop_measured")[200:310, 0].max() < toes + 1e-4
    assert column("cop_admissible").tobytes() == column("cop_desired").tobytes()


def test_a_controller_is_a_function_of_what_it_is_given(robot, rng):
    """The same question, after other questions: the same bits."""
    dynamics, other = swaying(robot, rng), swaying(robot, rng, (0,))
    controller = ResolvedMomentum(robot, DT)
    question = (dynamics, goal(robot, dynamics), GAINS, 0.3, controller.initial_memory(dynamics))
    first = controller.compute(*question)
    controller.compute(other, goal(robot, other, (0,)), GAINS, 1.0, controller.initial_memory(other))
    again = controller.compute(*question)
    assert first.torque.tobytes() == again.torque.tobytes()
    assert first.memory.q.tobytes() == again.memory.q.tobytes()


def test_in_the_air_and_out_of_reach_the_posture_is_held_in_words(robot):
    dynamics = home(robot)
    reference = goal(robot, dynamics)
    flying = dataclasses.replace(dynamics, sole_position=dynamics.sole_position + [0.0, 0.0, 0.05])
    output = answer(robot, flying, reference=reference)
    assert output.failure is not None
    assert output.failure.startswith("no foot is on the ground; holding the posture")
    memory = ResolvedMomentum(robot, DT).initial_memory(dynamics)
    memory.footholds[0, 0, 3] += 0.5
    output = answer(robot, dynamics, memory=memory)
    assert output.failure is not None
    assert output.failure.startswith("PlaCo finds no joint rates")
    assert output.memory is memory


def test_it_stands_for_ten_seconds(robot):
    session = played(robot, Scenario("still", robot=robot.spec.name, controller=NAME, seconds=10.0))
    com = session.recording.column("com")
    assert session.fall is None
    assert session.solver_failures == 0
    assert np.abs(com - com[0]).max() < 1e-5


def test_it_stands_on_one_leg_and_recovers_from_a_touch(robot):
    session = pushed(robot, 0.1, stance=("left",))
    assert session.fall is None
    assert np.linalg.norm(session.recording.latest["com_velocity"]) < 0.02


def test_it_stands_half_again_the_chapters_push(robot):
    """From behind it has stood 362 N (TALOS) and 135 N (G1); this is 325 N and 120 N."""
    session = pushed(robot, 1.5)
    assert session.fall is None
    assert session.solver_failures == 0
    assert np.linalg.norm(session.recording.latest["com_velocity"]) < 0.02


def test_standing_the_ground_answers_as_glue_would(robot):
    """Before the push and after it: measured wrenches are the predicted ones, to a thousandth of the weight."""
    column = played(robot, forward_push(robot, controller=NAME)).recording.column
    difference = np.abs(column("foot_wrench_measured") - column("foot_wrench_admissible")).max(axis=(1, 2))
    assert difference[:195].max() < 1e-3 * robot.mass * G
    assert difference[1500:].max() < 1e-3 * robot.mass * G


def test_without_the_lead_a_push_rings_longer(robot):
    """The set-point that leans against the motion is what damps it."""
    speed = {}
    for lead in (0.0, GAINS.com_lead):
        gains = {"com_lead": with_gains(GAINS, {"com_lead": lead}).com_lead}
        session = played(robot, forward_push(robot, controller=NAME, gains=gains))
        speed[lead] = np.linalg.norm(session.recording.column("com_velocity")[1000:1500], axis=1).max()
    assert speed[GAINS.com_lead] < 0.5 * speed[0.0]
