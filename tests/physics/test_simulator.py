"""From one state to the next: flight, limits of joints and motors, the account of all forces."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.physics.ground import Ground
from momentum_lab.physics.push import Push
from momentum_lab.physics.simulator import Simulator
from momentum_lab.robot.posture import standing_posture
from momentum_lab.robot.state import State
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session
from tests.conftest import assert_close, random_state

G = 9.81


def level_world(robot, timestep=1e-3) -> Simulator:
    return Simulator(robot, Ground.level(len(robot.soles), 0.7), timestep)


def flight(robot, timestep: float, seconds: float = 0.25) -> np.ndarray:
    """Drift of [l; k] against free fall: half a metre up, joints moving, no torque (6,)."""
    q = standing_posture(robot).copy()
    q[2] += 0.5
    v = np.concatenate([np.zeros(6), np.random.default_rng(3).uniform(-1.0, 1.0, robot.na)])
    state, world = State(q, v), level_world(robot, timestep)
    before = robot.at(state).momentum
    for tick in range(round(seconds / timestep)):
        step = world.step(robot.at(state), np.zeros(robot.na), (), tick * timestep)
        assert not step.foot_wrench.any()
        assert not step.other_wrench.any()
        state = step.state
    gravity = np.array([0.0, 0.0, -robot.mass * G * seconds, 0.0, 0.0, 0.0])
    return robot.at(state).momentum - before - gravity


def test_in_flight_momentum_drifts_with_the_timestep_only(robot):
    """l = l_0 + m g t and k = k_0 up to the order of the step: half the step, half the drift."""
    coarse, fine = flight(robot, 1e-3), flight(robot, 5e-4)
    assert np.linalg.norm(coarse[:3]) < 2.0
    assert np.linalg.norm(coarse[3:]) < 1.0
    assert np.linalg.norm(fine[:3]) / np.linalg.norm(coarse[:3]) == pytest.approx(0.5, abs=0.05)
    assert np.linalg.norm(fine[3:]) / np.linalg.norm(coarse[3:]) == pytest.approx(0.5, abs=0.05)


def test_without_contact_a_step_is_forward_dynamics(robot, rng):
    """v+ = v + dt aba(q, v, tau), q+ = q (+) dt v+, at any state in the air within its joint limits."""
    for _ in range(10):
        state = random_state(robot, rng)
        q = state.q.copy()
        q[2] = 5.0
        dynamics = robot.at(State(q, state.v))
        torque = rng.uniform(-0.5, 0.5, robot.na) * robot.effort_limit
        after = level_world(robot).step(dynamics, torque, (), 0.0).state
        tau = np.concatenate([np.zeros(6), torque])
        acceleration = pin.aba(robot.model, robot.model.createData(), q, state.v, tau)
        assert_close(after.v, state.v + 1e-3 * acceleration, 1e-9 * np.abs(acceleration).max())
        assert_close(after.q, pin.integrate(robot.model, q, 1e-3 * after.v), 1e-14)


def test_motors_give_their_limit_and_no_more(robot):
    standing = robot.at(State(standing_posture(robot), np.zeros(robot.nv)))
    for sign in (-1.0, 1.0):
        asked = level_world(robot).step(standing, sign * 10.0 * robot.effort_limit, (), 0.0)
        given = level_world(robot).step(standing, sign * robot.effort_limit, (), 0.0)
        assert_close(asked.torque, sign * robot.effort_limit, 0.0)
        assert_close(asked.state.v, given.state.v, 0.0)


def test_no_motor_presses_its_joint_far_beyond_its_limit(robot):
    """Full torque of one joint after the other, in the air: at rest at most 0.02 rad beyond, and no overshoot."""
    for joint in range(robot.na):
        q = standing_posture(robot).copy()
        q[2] += 50.0
        q[7 + joint] = robot.position_upper[joint]
        state, world, excess = State(q, np.zeros(robot.nv)), level_world(robot), []
        for tick in range(60):
            # Springs hold the rest of the body together, so that the joint feels its motor alone.
            torque = 50.0 * (q[7:] - state.q[7:]) - 5.0 * state.v[6:]
            torque[joint] = robot.effort_limit[joint]
            state = world.step(robot.at(state), torque, (), tick * 1e-3).state
            excess.append(state.q[7 + joint] - robot.position_upper[joint])
        assert 0.0 < max(excess) < 0.021, robot.joint_names[joint]
        assert max(excess) < 1.1 * excess[-1], robot.joint_names[joint]


def test_a_joint_that_runs_into_its_limit_stops_softly(robot):
    """At speed w the excess stays below w T / e of a critically damped stop, and it does not bounce back fast."""
    knee = next(i for i, name in enumerate(robot.joint_names) if "knee" in name or name == "leg_left_4_joint")
    q = standing_posture(robot).copy()
    q[2] += 50.0
    q[7 + knee] = robot.position_upper[knee] - 0.02
    v = np.zeros(robot.nv)
    v[6 + knee] = 5.0
    state, world = State(q, v), level_world(robot)
    excess, speed = [], []
    for tick in range(100):
        state = world.step(robot.at(state), np.zeros(robot.na), (), tick * 1e-3).state
        excess.append(state.q[7 + knee] - robot.position_upper[knee])
        speed.append(state.v[6 + knee])
    assert 0.0 < max(excess) < 5.0 * 0.01 / np.e
    assert min(speed) > -0.2 * 5.0


def test_the_account_names_every_force(robot):
    """Gravity, feet and push, about the CoM; H (v+ - v) explains the sum (Eq. 20)."""
    dynamics = robot.at(State(standing_posture(robot), np.zeros(robot.nv)))
    push = Push(force=100.0, direction_deg=20.0, start=0.0, height=1.0)
    step = level_world(robot).step(dynamics, 0.1 * robot.effort_limit, (push,), 0.0)
    acceleration = (step.state.v - dynamics.state.v) / 1e-3
    rate = dynamics.centroidal_map @ acceleration + dynamics.centroidal_bias
    assert_close(step.momentum_rate, rate, 1e-7 * robot.mass * G)
    assert step.foot_wrench[:, 2].min() > 0.0
    assert not step.other_wrench.any()


def test_a_step_depends_on_its_arguments_only(robot):
    """A world that has seen another run answers like a new one."""
    dynamics = robot.at(State(standing_posture(robot), np.zeros(robot.nv)))
    lying = standing_posture(robot).copy()
    lying[2] -= 0.6
    used = level_world(robot)
    used.step(robot.at(State(lying, np.ones(robot.nv))), np.zeros(robot.na), (), 0.0)
    torque = 0.2 * robot.effort_limit
    again, fresh = used.step(dynamics, torque, (), 0.0), level_world(robot).step(dynamics, torque, (), 0.0)
    assert again.state.q.tobytes() == fresh.state.q.tobytes()
    assert again.state.v.tobytes() == fresh.state.v.tobytes()


@pytest.mark.parametrize("name", ["talos", "g1"])
def test_every_row_of_the_equations_of_motion_closes_with_the_stops(name, request):
    """H a + C v + tau_g = tau + stops + J^T w after a push so hard that joints reach their ends."""
    robot = request.getfixturevalue(name)
    force = {"talos": 322.0, "g1": 125.0}[name]
    session = Session(
        Scenario("hard", robot=name, seconds=1.0, pushes=(Push(force=force, start=0.0),)), robot
    )
    worst, stopped = 0.0, 0
    for _ in range(1000):
        before = session.dynamics
        sample = session.tick()
        if sample["push_wrench"].any():
            continue
        acceleration = (session.state.v - before.state.v) / 1e-3
        rows = before.mass_matrix @ acceleration + before.nonlinear_effects
        rows[6:] -= sample["torque"] + sample["joint_stop_torque"]
        rows -= np.einsum("fi,fij->j", sample["foot_wrench_measured"], before.sole_jacobian)
        worst = max(worst, np.abs(rows).max())
        stopped += bool(sample["joint_stop_torque"].any())
    assert stopped > 10
    assert worst < 1e-6
