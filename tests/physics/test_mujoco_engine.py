"""The same robot in MuJoCo: one step by hand, whole runs against the lab's own physics."""

from __future__ import annotations

import sys

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.errors import InputError
from momentum_lab.events import MoveGround
from momentum_lab.physics.engines import world
from momentum_lab.physics.ground import Ground, Patch
from momentum_lab.physics.mujoco_engine import MujocoSimulator
from momentum_lab.physics.plate import PlateMotion
from momentum_lab.physics.push import Push
from momentum_lab.robot.posture import standing_posture
from momentum_lab.robot.state import State
from momentum_lab.scenario import Scenario, changed, load_scenario
from momentum_lab.session import Session
from tests.conftest import assert_close, random_state
from tests.runs import played

STEP = 1e-3
ENGINES = ("pinocchio", "mujoco")


def simulator(robot, friction: float = 0.7) -> MujocoSimulator:
    return MujocoSimulator(robot, Ground.level(len(robot.soles), friction), STEP)


def test_in_the_air_a_step_is_forward_dynamics(robot, rng):
    """v+ = v + dt aba(q, v, tau + J^T F) of Pinocchio, at any state within the joint limits."""
    engine = simulator(robot)
    push = Push(force=200.0, direction_deg=30.0, start=0.0)
    for _ in range(10):
        state = random_state(robot, rng)
        state.q[2] = 5.0
        dynamics = robot.at(state)
        torque = rng.uniform(-0.5, 0.5, robot.na) * robot.effort_limit
        step = engine.step(dynamics, torque, (push,), 0.0)
        data = robot.model.createData()
        jacobian = pin.computeFrameJacobian(
            robot.model, data, state.q, robot.trunk, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        )
        force = push.force * push.direction
        lever = dynamics.com_in_world - data.oMf[robot.trunk].translation
        tau = jacobian.T @ np.concatenate([force, np.cross(lever, force)])
        tau[6:] += torque
        acceleration = pin.aba(robot.model, robot.model.createData(), state.q, state.v, tau)
        assert_close(step.state.v, state.v + STEP * acceleration, 1e-9 * STEP * np.abs(acceleration).max())
        assert_close(step.state.q, pin.integrate(robot.model, state.q, STEP * step.state.v), 1e-12)
        assert not step.foot_wrench.any()
        assert not step.stop_torque.any()


def test_forces_of_a_step_explain_its_motion(robot):
    """H (v+ - v) / dt = tau - C v - tau_g + J^T f for soles, stops and motors."""
    q = standing_posture(robot).copy()
    q[2] -= 1e-5
    knee = robot.matching_joints(["*knee*" if robot.spec.name == "g1" else "leg_*_4_joint"])[0]
    q[7 + knee] = robot.position_upper[knee] + 1e-3
    state = State(q, np.zeros(robot.nv))
    state.v[:2] = 0.3, -0.2
    dynamics = robot.at(state)
    torque = np.full(robot.na, 1e4)
    step = simulator(robot).step(dynamics, torque, (), 0.0)
    assert_close(step.torque, robot.effort_limit, 0.0)
    assert step.stop_torque[knee] < 0.0
    assert np.count_nonzero(step.stop_torque) == 1
    pressed = step.foot_wrench[:, 2] > 0.0
    assert pressed.any()
    force = -dynamics.nonlinear_effects
    force[6:] += step.torque + step.stop_torque
    force += np.einsum("fij,fi->j", dynamics.sole_jacobian, step.foot_wrench)
    change = dynamics.mass_matrix @ (step.state.v - state.v) / STEP
    assert_close(change, force, 1e-6 * np.abs(force).max())


def test_friction_is_that_of_the_ground_under_each_foot(robot):
    """Feet that slide are braked by the coefficient of their own plane, whatever the robot's file says."""
    planes = (Patch(0.2), Patch(1.4))
    state = State(standing_posture(robot), np.zeros(robot.nv))
    state.q[2] -= 1e-5
    state.v[0] = 1.0
    step = MujocoSimulator(robot, Ground(planes, Patch(0.5)), STEP).step(
        robot.at(state), np.zeros(robot.na), (), 0.0
    )
    slope = np.linalg.norm(step.foot_wrench[:, :2], axis=1) / step.foot_wrench[:, 2]
    assert_close(slope, (0.2, 1.4), 1e-3)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_standing_robot_is_carried_and_stays(robot, engine):
    session = played(robot, Scenario("stand", robot=robot.spec.name, engine=engine, seconds=1.0))
    vertical = session.recording.column("foot_wrench_measured")[-1, :, 2].sum()
    assert vertical == pytest.approx(9.81 * robot.mass, rel=1e-4)
    moved = session.recording.column("sole_pose")[-1, :, :3] - session.recording.column("sole_pose")[0, :, :3]
    assert np.abs(moved).max() < 1e-4


def small_push(robot, engine: str) -> Session:
    push = Push(velocity_change=0.1, start=0.2)
    return played(robot, Scenario("small", robot=robot.spec.name, engine=engine, seconds=2.0, pushes=(push,)))


def test_a_push_that_saturates_nothing_moves_the_com_alike(robot):
    """Rigid and soft ground differ by what the floor gives: CoM within 5 mm of each other over 2 s."""
    ours, theirs = (small_push(robot, engine).recording for engine in ENGINES)
    saturated = ours.column("momentum_rate_desired") - ours.column("momentum_rate_admissible")
    assert np.abs(saturated).max() < 1e-4 * 9.81 * robot.mass
    moved = ours.column("com") - ours.column("com")[0]
    assert np.abs(moved).max() > 8e-3
    assert_close(theirs.column("com"), ours.column("com"), 5e-3)


def test_measured_wrenches_are_the_rate_of_the_momentum(robot):
    """Eq. 20: MuJoCo's forces explain what Pinocchio's A_G says about MuJoCo's motion."""
    assert small_push(robot, "mujoco").recording.column("equation_residual").max() < 1e-9


@pytest.mark.parametrize("engine", ENGINES)
def test_the_pair_of_figure_7_holds(robot, engine):
    """The same push: priority 0 stands, priority 1 falls."""
    scenario = changed(load_scenario("fig7"), robot=robot.spec.name, engine=engine)
    assert played(robot, changed(scenario, priority=0.0)).fall is None
    assert played(robot, changed(scenario, priority=1.0)).fall is not None


def test_the_same_run_gives_the_same_bits_from_a_snapshot_too(g1):
    scenario = Scenario(
        "again", robot="g1", engine="mujoco", seconds=0.3, pushes=(Push(force=80.0, start=0.1),)
    )
    first, second = Session(scenario, robot=g1), Session(scenario, robot=g1)
    for _ in range(300):
        first.tick()
    for _ in range(150):
        second.tick()
    snapshot = second.snapshot()
    for _ in range(50):
        second.tick()
    second.resume(snapshot)
    for _ in range(150):
        second.tick()
    assert first.recording.rows().tobytes() == second.recording.rows().tobytes()


def test_a_robot_that_falls_lands_on_its_body(g1):
    scenario = Scenario("flat", robot="g1", engine="mujoco", seconds=2.5, pushes=(Push(force=400.0),))
    session = played(g1, scenario)
    assert session.fall is not None
    weight = 9.81 * g1.mass
    vertical = session.recording.column("other_contact_wrench")[-1, 2]
    assert (
        0.5 * weight
        < vertical + session.recording.column("foot_wrench_measured")[-1, :, 2].sum()
        < 2.0 * weight
    )
    assert vertical > 0.0


def test_ground_that_is_not_level_is_refused_in_words(g1):
    tilted = Patch(0.7, rotation=pin.utils.rotate("y", 0.1))
    high = Patch(0.7, origin=np.array([0.0, 0.0, 0.05]))
    for plate in (tilted, high):
        with pytest.raises(InputError, match="engine: got mujoco; allowed: pinocchio, because the ground"):
            world("mujoco", g1, Ground((plate, Patch(0.7)), Patch(0.7)), STEP)


def test_ground_that_is_to_move_is_refused_before_it_does(g1):
    session = Session(Scenario("calm", robot="g1", engine="mujoco", seconds=0.1), robot=g1)
    with pytest.raises(InputError, match="engine: got mujoco"):
        session.post(MoveGround(PlateMotion(axis="x", amplitude=0.05)))
    session.tick()


def test_friction_changes_under_a_foot_at_its_time(g1):
    """Feet that slide at 1 m/s before and after the change, in the same world."""
    ground = Ground.level(2, 0.7).as_slippery_as(0.1, (1,), 0.5)
    engine, state = MujocoSimulator(g1, ground, STEP), State(standing_posture(g1), np.zeros(g1.nv))
    state.q[2] -= 1e-5
    state.v[0] = 1.0
    for time, expected in ((0.4, (0.7, 0.7)), (0.6, (0.7, 0.1))):
        step = engine.step(g1.at(state), np.zeros(g1.na), (), time)
        slope = np.linalg.norm(step.foot_wrench[:, :2], axis=1) / step.foot_wrench[:, 2]
        assert_close(slope, expected, 1e-3)


def test_without_mujoco_one_line_says_what_to_install(monkeypatch, g1):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(InputError, match=r"engine: got mujoco.*pip install 'momentum-lab\[mujoco\]'"):
        world("mujoco", g1, Ground.level(2, 0.7), STEP)
    world("pinocchio", g1, Ground.level(2, 0.7), STEP)
