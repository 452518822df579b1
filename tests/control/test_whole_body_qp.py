"""Accelerations, forces and torques as one question: what must hold in a tick, and pushes in closed loop."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.control.accelerations import contact_constraint
from momentum_lab.control.desired import desired_angular_rate, desired_linear_rate
from momentum_lab.control.gains import with_gains
from momentum_lab.control.qp import certify, solve, solve_reference
from momentum_lab.control.stance_motion import stance_motion
from momentum_lab.control.whole_body_qp import WholeBodyGains, WholeBodyQP, _bounds
from momentum_lab.control.wrench_cone import wrench_cone
from momentum_lab.events import SelectController
from momentum_lab.momentum.wrench import shift_wrench, wrench_in_frame_axes
from momentum_lab.physics.push import Push
from momentum_lab.robot.state import State
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session
from tests.conftest import assert_close, yaw_rotation
from tests.control.situations import BOTH, G, goal, home, moments_of_a_push, null_space, swaying
from tests.runs import CHAPTER_PUSH, play, played

GAINS = WholeBodyGains()
LQR = with_gains(GAINS, {"lqr_share": 1.0})
MM = 1e-3


def answer(robot, dynamics, stance=BOTH, gains=GAINS, priority=0.0, reference=None):
    reference = reference or goal(robot, dynamics, stance)
    return WholeBodyQP(robot, 1e-3).compute(dynamics, reference, gains, priority, None)


def moving(robot, velocity, stance=BOTH):
    """The home posture with a CoM velocity (m/s) and feet that stay, by the least joint motion."""
    still = home(robot, stance)
    free = null_space(still.sole_jacobian[list(stance)].reshape(-1, robot.nv))
    com = still.centroidal_map[:3] / robot.mass
    return robot.at(State(still.state.q, free @ np.linalg.pinv(com @ free) @ np.array(velocity)))


@pytest.mark.parametrize("stance", [BOTH, (0,), (1,)])
@pytest.mark.parametrize("gains", [GAINS, LQR], ids=["pd", "lqr"])
def test_the_answer_obeys_the_laws_it_was_asked_under(robot, rng, stance, gains):
    """Equations of motion (28), still feet (31), momentum (1, 2, 20), cones of the safe soles, motors."""
    for _ in range(5):
        dynamics = swaying(robot, rng, stance)
        out = answer(robot, dynamics, stance, gains)
        assert out.failure is None
        weight, a = robot.mass * G, out.acceleration
        rows = dynamics.mass_matrix @ a + dynamics.nonlinear_effects
        rows[6:] -= out.torque
        rows -= np.einsum("fi,fij->j", out.foot_wrench_admissible, dynamics.sole_jacobian)
        assert_close(rows / weight, np.zeros(robot.nv), 1e-8)
        reference = goal(robot, dynamics, stance)
        still, target = contact_constraint(dynamics, stance, reference, gains.contact_damping)
        assert_close(still @ a, target, 1e-6)
        rate = dynamics.centroidal_map @ a + dynamics.centroidal_bias
        assert_close(rate / weight, out.momentum_rate_admissible / weight, 1e-8)
        assert (np.abs(out.torque) < robot.effort_limit * (1.0 + 1e-3)).all()
        for foot in stance:
            assert beyond_the_cone(robot, dynamics, out, foot, gains) < 1e-5 * weight


def beyond_the_cone(robot, dynamics, out, foot, gains) -> float:
    sole = robot.soles[foot]
    center = np.append((sole.lower + sole.upper) / 2.0, 0.0)
    local = wrench_in_frame_axes(out.foot_wrench_admissible[foot], dynamics.sole_rotation[foot])
    half = (sole.upper - sole.lower) / 2.0 - gains.safe_border
    least = gains.least_foot_force * robot.mass * G
    matrix, bound = wrench_cone(*half.tolist(), gains.friction, least)
    return float((matrix @ shift_wrench(local, np.zeros(3), center) - bound).max())


def test_feet_in_the_air_get_nothing(robot):
    dynamics = home(robot, (0,))
    assert not answer(robot, dynamics, (0,)).foot_wrench_admissible[1].any()
    q = home(robot).state.q.copy()
    q[2] += 0.1
    out = answer(robot, robot.at(State(q, np.zeros(robot.nv))))
    assert out.failure is not None
    assert out.failure.startswith("no foot is on the ground")


@pytest.mark.parametrize("gains", [GAINS, LQR], ids=["pd", "lqr"])
@pytest.mark.parametrize("stance", [BOTH, (0,)])
def test_at_its_goal_it_only_carries_its_weight(robot, stance, gains):
    dynamics = home(robot, stance)
    out = answer(robot, dynamics, stance, with_gains(gains, {"contact_damping": 0.0}))
    weight = robot.mass * G
    assert_close(out.momentum_rate_admissible / weight, np.zeros(6), 1e-4)
    assert_close(out.foot_wrench_admissible[list(stance), 2] / weight, 1.0 / len(stance), 1e-4)
    assert np.abs(out.acceleration).max() < 1e-2


def test_desired_rates_are_equations_37_and_38(robot, rng):
    dynamics = swaying(robot, rng)
    reference = goal(robot, dynamics)
    linear = desired_linear_rate(robot.mass, dynamics, reference, 8.0, 16.0)
    angular = desired_angular_rate(dynamics, reference, 5.0, 4.0)
    found = answer(robot, dynamics).momentum_rate_desired
    assert_close(found, np.concatenate([linear, angular]), 1e-9 * robot.mass * G)


def test_the_share_of_the_regulator_is_a_mean(robot, rng):
    dynamics = swaying(robot, rng)
    pd, half, lqr = (
        answer(robot, dynamics, gains=with_gains(GAINS, {"lqr_share": share})).momentum_rate_desired
        for share in (0.0, 0.5, 1.0)
    )
    assert np.abs(pd - lqr).max() > 1.0
    assert_close(half, (pd + lqr) / 2.0, 1e-9 * robot.mass * G)


@pytest.mark.parametrize("gains", [GAINS, LQR], ids=["pd", "lqr"])
def test_small_errors_are_answered_in_full(robot, gains):
    """What the ground can give is given: both rates as desired."""
    dynamics = moving(robot, [0.02, 0.02, 0.0])
    out = answer(robot, dynamics, gains=gains)
    weight = robot.mass * G
    assert np.abs(out.momentum_rate_desired[:2]).max() > 1e-3 * weight
    assert_close(out.momentum_rate_admissible / weight, out.momentum_rate_desired / weight, 1e-3)


@pytest.mark.parametrize("stance", [BOTH, (0,)])
def test_the_ends_of_the_slider_keep_one_momentum_each(robot, stance):
    """Fig. 7 as a matter of weights: a CoM that moves at 0.3 m/s towards the toes."""
    dynamics = moving(robot, [0.3, 0.0, 0.0], stance)
    linear, angular = (answer(robot, dynamics, stance, priority=p) for p in (0.0, 1.0))
    lost = [out.momentum_rate_admissible - out.momentum_rate_desired for out in (linear, angular)]
    weight = robot.mass * G
    assert np.abs(lost[0][:3]).max() < 0.02 * weight
    assert lost[0][4] > 0.02 * weight
    assert abs(lost[1][4]) < 0.02 * weight
    assert lost[1][0] > 0.02 * weight
    assert linear.cop_admissible[0] < linear.cop_desired[0] - 5 * MM


def test_the_slider_moves_torques_without_jumps(robot):
    dynamics = moving(robot, [0.3, 0.0, 0.0])
    torques = np.array([answer(robot, dynamics, priority=p).torque for p in np.linspace(0, 1, 41)])
    whole = np.abs(torques[-1] - torques[0]).max()
    assert whole > 0.5
    assert np.abs(np.diff(torques, axis=0)).max() < 0.25 * whole


@pytest.mark.parametrize("stance", [BOTH, (0,)])
def test_the_answer_is_the_minimiser_by_another_solver(robot, rng, stance):
    controller = WholeBodyQP(robot, 1e-3)
    for _ in range(3):
        dynamics = swaying(robot, rng, stance)
        reference = goal(robot, dynamics, stance)
        motion = stance_motion(dynamics, reference, stance, GAINS.contact_damping)
        program = controller._program(stance, stance)
        desired = controller.desired_rate(dynamics, reference, GAINS)
        outputs = controller._outputs(dynamics, reference, desired, GAINS, 0.0)
        uneven = program.centered(dynamics, motion.wrench)
        hessian, gradient = controller._objective(outputs, motion, uneven, GAINS)
        problem = program.problem(hessian, gradient, dynamics, motion, uneven, _bounds(GAINS))
        solution = solve(problem)
        assert certify(problem, solution.x, solution.multipliers).worst < 1e-6
        difference = problem.hessian @ (solution.x - solve_reference(problem))
        assert_close(difference / np.abs(problem.gradient).max(), 0.0, 1e-4)


@pytest.mark.parametrize("gains", [GAINS, LQR], ids=["pd", "lqr"])
def test_where_the_robot_is_and_looks_does_not_matter(robot, rng, gains):
    for stance in (BOTH, (0,)):
        here = swaying(robot, rng, stance)
        turn = yaw_rotation(-2.2)
        q = here.state.q.copy()
        rotation = turn @ pin.Quaternion(q[3:7]).toRotationMatrix()
        q[:3] = turn @ q[:3] + [30.0, -40.0, 0.0]
        q[3:7] = pin.Quaternion(rotation).normalized().coeffs()
        there = robot.at(State(q, here.state.v))
        a, b = answer(robot, here, stance, gains), answer(robot, there, stance, gains)
        assert_close(a.torque, b.torque, 1e-4 * robot.mass)
        for part in (slice(0, 3), slice(3, 6)):
            assert_close(
                turn @ a.momentum_rate_desired[part], b.momentum_rate_desired[part], 1e-6 * robot.mass
            )


def test_it_is_a_function_of_what_it_is_given(robot, rng):
    dynamics, other = swaying(robot, rng), swaying(robot, rng, (0,))
    controller = WholeBodyQP(robot, 1e-3)
    question = (dynamics, goal(robot, dynamics), LQR, 0.3, None)
    first = controller.compute(*question)
    controller.compute(other, goal(robot, other, (0,)), GAINS, 1.0, None)
    again = controller.compute(*question)
    assert first.torque.tobytes() == again.torque.tobytes()


def test_every_moment_of_a_push_has_an_answer(robot):
    for dynamics in moments_of_a_push(robot):
        assert answer(robot, dynamics).failure is None


def pushed(robot, gains, seconds=3.0, priority=0.0, **push) -> Scenario:
    return Scenario(
        "push",
        robot=robot.spec.name,
        controller="whole-body-qp",
        gains=gains,
        priority=priority,
        seconds=seconds,
        pushes=(Push(duration=0.1, start=0.2, **push),),
    )


@pytest.mark.parametrize("gains", [{}, {"lqr_share": 1.0}], ids=["pd", "lqr"])
def test_it_stands_the_chapters_push(robot, gains):
    """217 N on TALOS, 80 N on G1, as computed torque does: no failed solve, the CoM back where it was."""
    session = played(robot, pushed(robot, gains, force=CHAPTER_PUSH[robot.spec.name]))
    assert session.fall is None
    assert session.solver_failures == 0
    com = session.recording.column("com")
    assert np.linalg.norm(com[-1] - com[0]) < 5 * MM


# A forward push of 0.1 s at which keeping linear momentum stands and keeping angular momentum falls, N.
PAIR_PUSH = {"talos": 340.0, "g1": 130.0}


def test_the_pair(robot):
    """The lesson of the chapter in one program: what matters more decides who stands."""
    stands, falls = (
        play(robot, pushed(robot, {}, 2.5, priority=p, force=PAIR_PUSH[robot.spec.name])) for p in (0.0, 1.0)
    )
    assert stands.fall is None
    assert np.linalg.norm(stands.recording.latest["com_velocity"]) < 0.05
    assert falls.fall is not None


def test_physics_gives_the_wrenches_it_counts_on(robot):
    """Before and after the push, on two feet that could share in many ways."""
    session = played(robot, pushed(robot, {}, force=CHAPTER_PUSH[robot.spec.name]))
    column = session.recording.column
    difference = np.abs(column("foot_wrench_measured") - column("foot_wrench_admissible")).max(axis=(1, 2))
    assert difference[:195].max() < 1e-3
    assert difference[1500:].max() < 1e-2 * robot.mass * G


@pytest.mark.parametrize("gains", [{}, {"lqr_share": 1.0}], ids=["pd", "lqr"])
@pytest.mark.parametrize("degrees", range(0, 360, 45))
def test_it_stands_a_modest_push_from_every_side(robot, degrees, gains):
    """0.1 m/s of CoM velocity."""
    session = play(robot, pushed(robot, gains, 2.0, velocity_change=0.1, direction_deg=degrees))
    assert session.fall is None
    assert session.solver_failures == 0
    assert np.linalg.norm(session.recording.latest["com_velocity"]) < 0.05


def test_the_regulator_closes_the_loop_it_promises(robot):
    """A small push: the CoM follows the linear closed loop x' = (A - B K) x on the full model."""
    gains = {"lqr_share": 1.0, "pelvis_stiffness": 0.0, "pelvis_weight": 0.0}
    session = play(robot, pushed(robot, gains, 1.2, velocity_change=0.02))
    column = session.recording.column
    wanted, measured = column("momentum_rate_desired"), column("momentum_rate_measured")
    after = column("time") > 0.31
    scale = np.abs(measured[after]).max()
    assert np.abs(wanted - measured)[after][:, :3].max() < 0.02 * scale
    assert session.fall is None


def test_two_runs_are_the_same_bits(g1):
    scenario = pushed(g1, {"lqr_share": 0.5}, 0.5, velocity_change=0.2)
    first, second = (play(g1, scenario).recording.rows() for _ in range(2))
    assert first.tobytes() == second.tobytes()


def test_selected_live_it_takes_over(g1):
    """From computed torque in the middle of a push, without a fall."""
    push = Push(duration=0.1, start=0.2, velocity_change=0.15)
    session = Session(Scenario("live", robot="g1", seconds=2.0, pushes=(push,)), robot=g1)
    for tick in range(2000):
        if tick == 250:
            session.post(SelectController("whole-body-qp"))
        session.tick()
    assert session.choices.controller == "whole-body-qp"
    assert session.fall is None
    assert session.solver_failures == 0
