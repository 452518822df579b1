"""Every quantity of a sample, found a second time from the state and the forces."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.control.controller import SLACKS
from momentum_lab.control.fallback import limp
from momentum_lab.control.registry import controller_entry
from momentum_lab.observe import Tick, observe
from momentum_lab.physics.simulator import Step
from momentum_lab.recording import Layout
from momentum_lab.robot.state import State
from momentum_lab.session import Session
from tests.conftest import assert_close
from tests.control.situations import LEVEL
from tests.runs import PUSH_END, PUSH_START, forward_push, play, played

G = 9.81
EVERY = 23


@pytest.fixture(scope="module")
def session(robot) -> Session:
    return played(robot, forward_push(robot))


@pytest.fixture(scope="module")
def column(session):
    """A recorded quantity at some ticks of the run."""
    return lambda name: session.recording.column(name, every=EVERY)


def test_time_is_the_number_of_the_tick_times_its_length(session):
    times = session.recording.column("time")
    assert_close(times, np.arange(len(times)) * 1e-3, 1e-12)


def test_a_row_holds_the_state_and_what_acts_until_the_next(robot, session):
    """q[i+1] = q[i] (+) dt v[i+1], and A_G (v[i+1] - v[i]) / dt + dA_G v is the measured rate (Eq. 20)."""
    q, v, rate = (session.recording.column(name) for name in ("q", "v", "momentum_rate_measured"))
    for i in range(0, len(q) - 1, EVERY):
        assert_close(q[i + 1], pin.integrate(robot.model, q[i], 1e-3 * v[i + 1]), 1e-12)
        dynamics = robot.at(State(q[i], v[i]))
        explained = dynamics.centroidal_map @ (v[i + 1] - v[i]) / 1e-3 + dynamics.centroidal_bias
        assert_close(explained, rate[i], 1e-9 * robot.mass * G)


@pytest.mark.parametrize("missing", [-1, 1, 40])
def test_a_row_of_another_width_is_refused(robot, missing):
    state = State(played(robot, forward_push(robot)).recording.column("q")[0], np.zeros(robot.nv))
    dynamics, feet = robot.at(state), len(robot.soles)
    nothing, six = np.zeros(robot.na), np.zeros(6)
    step = Step(state, nothing, nothing, np.zeros((feet, 6)), six, six, six, 0.0)
    tick = Tick(robot, 0.0, 1e-3, dynamics, limp(robot, dynamics, None), step, LEVEL, 0.0, False)
    observe(np.empty(Layout.of(robot).width), tick)
    with pytest.raises(ValueError, match="do not fill a row"):
        observe(np.empty(Layout.of(robot).width - missing), tick)


def test_com_and_momentum_are_the_states(robot, column):
    """By Pinocchio's centre of mass and link by link momenta: l = sum m c', k = sum (c - r) x m c' + I w."""
    model, data = robot.model, robot.model.createData()
    for q, v, com, speed, momentum in zip(
        *(column(name) for name in ("q", "v", "com", "com_velocity", "momentum")), strict=True
    ):
        pin.forwardKinematics(model, data, q, v)
        r = pin.centerOfMass(model, data, q)
        linear, angular = np.zeros(3), np.zeros(3)
        for j in range(1, model.njoints):
            body, placement, twist = model.inertias[j], data.oMi[j], data.v[j]
            spin = placement.rotation @ twist.angular
            c = placement.act(body.lever)
            rate = placement.rotation @ (twist.linear + np.cross(twist.angular, body.lever))
            inertia = placement.rotation @ body.inertia @ placement.rotation.T
            linear += body.mass * rate
            angular += np.cross(c - r, body.mass * rate) + inertia @ spin
        assert_close(com, r, 1e-12)
        assert_close(speed, linear / robot.mass, 1e-10)
        assert_close(momentum, np.concatenate([linear, angular]), 1e-10)


def test_sole_poses_are_the_states(robot, column):
    data = robot.model.createData()
    for q, poses in zip(column("q"), column("sole_pose"), strict=True):
        pin.framesForwardKinematics(robot.model, data, q)
        for sole, pose in zip(robot.soles, poses, strict=True):
            assert_close(pose[:3], data.oMf[sole.frame].translation, 1e-12)
            assert_close(pin.Quaternion(pose[3:]).toRotationMatrix(), data.oMf[sole.frame].rotation, 1e-12)


def test_cop_explains_the_measured_momentum_rate(robot, column):
    """Eq. 1 without the push: about the CoP the ground has no horizontal moment."""
    com, rate, push, cop = (
        column(name) for name in ("com", "momentum_rate_measured", "push_wrench", "cop_measured")
    )
    force = rate[:, :3] - push[:, :3] + [0.0, 0.0, robot.mass * G]
    moment = rate[:, 3:] - (push[:, 3:] - np.cross(com, push[:, :3]))
    arm = np.column_stack([cop, np.zeros(len(cop))]) - com
    assert_close((moment - np.cross(arm, force))[:, :2], np.zeros((len(com), 2)), 1e-8 * robot.mass * G)


def test_cmp_lies_on_the_line_of_the_force_through_the_com(column):
    """Eq. 22: (s - r) x f = 0; Eq. 23: s - p = (dk_y, -dk_x) / f_z with the rate of the ground alone."""
    com, soles, wrench = column("com"), column("sole_pose")[:, :, :3], column("foot_wrench_measured")
    force = wrench[:, :, :3].sum(axis=1)
    arm = np.column_stack([column("cmp"), np.zeros(len(com))]) - com
    assert_close(np.cross(arm, force), np.zeros_like(force), 1e-9 * np.abs(force).max())
    moment = (np.cross(soles - com[:, None], wrench[:, :, :3]) + wrench[:, :, 3:]).sum(axis=1)
    gap = np.column_stack([moment[:, 1], -moment[:, 0]]) / force[:, 2:]
    assert_close(column("cmp") - column("cop_measured"), gap, 1e-9)


def test_the_capture_point_is_where_a_pendulum_comes_to_rest(column):
    com, speed = column("com"), column("com_velocity")
    omega = np.sqrt(G / com[:, 2])
    assert_close(column("capture_point"), com[:, :2] + speed[:, :2] / omega[:, None], 1e-12)


def test_foot_cops_are_moment_free_points_of_their_soles(robot, column):
    for poses, wrenches, cops in zip(
        *(column(name) for name in ("sole_pose", "foot_wrench_measured", "foot_cop_measured")), strict=True
    ):
        for pose, wrench, cop in zip(poses, wrenches, cops, strict=True):
            rotation = pin.Quaternion(pose[3:]).toRotationMatrix()
            arm = rotation @ [*cop, 0.0]
            moment = rotation.T @ (wrench[3:] - np.cross(arm, wrench[:3]))
            assert_close(moment[:2], np.zeros(2), 1e-9 * robot.mass * G)


def test_the_push_is_seen_while_it_lasts(robot, session):
    """Force and moment of a horizontal push through the CoM, about the world origin."""
    column = session.recording.column
    times, push, com = column("time"), column("push_wrench"), column("com")
    force = session.pushes[0].force
    during = (times > PUSH_START - 1e-6) & (times < PUSH_END - 1e-6)
    assert_close(push[during, :3], np.tile([force, 0.0, 0.0], (during.sum(), 1)), 1e-6)
    assert_close(push[during, 3:], np.cross(com[during], push[during, :3]), 1e-6)
    assert np.abs(push[~during]).max() < 1e-6
    assert 1e-3 * push[:, 0].sum() == pytest.approx(0.1 * force, rel=1e-9)


def test_the_equation_residual_is_the_contracts(robot, session):
    """Largest of |A_G a + dA_G v - dh_measured| / (m g), here from neighbouring rows; and it is next to nothing."""
    residual = session.recording.column("equation_residual")
    q, v, rate = (session.recording.column(name) for name in ("q", "v", "momentum_rate_measured"))
    assert residual.max() < 1e-9
    for i in range(0, len(q) - 1, 10 * EVERY):
        dynamics = robot.at(State(q[i], v[i]))
        missed = dynamics.centroidal_map @ (v[i + 1] - v[i]) / 1e-3 + dynamics.centroidal_bias - rate[i]
        assert residual[i] == pytest.approx(np.abs(missed).max() / (robot.mass * G), abs=1e-12)


def test_a_rate_that_does_not_explain_the_motion_has_a_residual(robot, session):
    """One percent of the weight too much, in one direction."""
    before, after = (
        State(*(session.recording.column(name)[row] for name in ("q", "v"))) for row in (300, 301)
    )
    dynamics = robot.at(before)
    rate = dynamics.centroidal_map @ (after.v - before.v) / 1e-3 + dynamics.centroidal_bias
    rate[1] += 0.01 * robot.mass * G
    carried = np.zeros((2, 6))
    carried[:, 2] = 0.5 * robot.mass * G
    idle = np.zeros(robot.na)
    step = Step(after, idle, idle, carried, np.zeros(6), np.zeros(6), rate, 0.0)
    layout = Layout.of(robot)
    row = np.zeros(layout.width)
    observe(row, Tick(robot, 0.3, 1e-3, dynamics, limp(robot, dynamics, None), step, LEVEL, 0.0, False))
    assert row[layout.slices["equation_residual"]][0] == pytest.approx(0.01, rel=1e-6)


def test_every_number_of_a_row_is_written(robot):
    """Nothing of an earlier round of the ring shines through."""
    session = Session(forward_push(robot), robot=robot)
    session.recording.next_row()[:] = 12345.678
    session.recording.clear()
    row = session.tick().row
    assert not (row == 12345.678).any()


def test_in_the_air_there_is_no_cop(robot):
    """Points that do not exist are not a number; forces are zero, and the capture point remains."""
    lifted = play(robot, forward_push(robot, seconds=0.01))
    q = lifted.state.q.copy()
    q[2] += 1.0
    lifted.state = State(q, np.zeros(robot.nv))
    sample = lifted.tick()
    assert np.isnan(sample["cop_measured"]).all()
    assert np.isnan(sample["cmp"]).all()
    assert np.isnan(sample["foot_cop_measured"]).all()
    assert not sample["foot_wrench_measured"].any()
    assert_close(sample["momentum_rate_measured"], [0.0, 0.0, -robot.mass * G, 0.0, 0.0, 0.0], 1e-9)
    assert np.isfinite(sample["capture_point"]).all()


def test_slacks_and_torque_ratio_are_the_controllers(robot):
    """Asked again at every state of a recovery: slacks by name, and the largest torque against its limit."""
    session = played(robot, forward_push(robot, seconds=0.6, controller="slack-qp"))
    entry = controller_entry("slack-qp")
    controller = entry.make(robot, 1e-3)
    column = session.recording.column
    for i in range(210, 600, 40):
        dynamics = robot.at(State(column("q")[i], column("v")[i]))
        reference = session.steering._goal.reference(dynamics, LEVEL)
        out = controller.compute(dynamics, reference, entry.gains, 0.0, None)
        assert_close(column("slack")[i], np.array([out.slack.get(name, 0.0) for name in SLACKS]), 1e-6)
        assert column("torque_ratio")[i] == pytest.approx(np.abs(out.torque / robot.effort_limit).max())
    assert np.abs(column("slack")).max() > 0.1
    ours = played(robot, forward_push(robot)).recording
    assert not ours.column("slack").any()
    assert (
        ours.column("torque_ratio") >= np.abs(ours.column("torque") / robot.effort_limit).max(axis=1) - 1e-12
    ).all()


def test_every_quantity_is_where_the_layout_says(robot):
    """A row whose every quantity is recognised by its size and place: nothing is written over or left out."""
    recording = played(robot, forward_push(robot)).recording
    layout, row = recording.layout, recording.latest.row
    assert sum(np.prod(shape, dtype=int) for shape in layout.shapes.values()) == row.size
    assert np.isfinite(row).all()
    sample = recording.latest
    assert 0.0 < sample.number("torque_ratio") < 1.0
    assert sample.number("priority") == 0.0
    assert sample.number("fallen") == 0.0
    assert sample["slack"].shape == (len(SLACKS),)
