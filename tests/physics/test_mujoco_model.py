from __future__ import annotations

import sys

import mujoco
import numpy as np
import pytest

from momentum_lab.errors import LabError, RobotError
from momentum_lab.physics.mujoco_model import CONTACTS_PER_FOOT, mujoco_model
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.posture import standing_posture
from momentum_lab.robot.state import Dynamics, State
from tests.conftest import assert_close

STEP = 1e-3


@pytest.fixture(scope="module")
def models(talos: RobotModel, g1: RobotModel) -> dict[str, mujoco.MjModel]:
    return {robot.spec.name: mujoco_model(robot, STEP) for robot in (talos, g1)}


@pytest.fixture
def model(robot: RobotModel, models: dict[str, mujoco.MjModel]) -> mujoco.MjModel:
    return models[robot.spec.name]


def test_same_mass_and_names(robot: RobotModel, model: mujoco.MjModel) -> None:
    assert model.body_mass.sum() == pytest.approx(robot.mass, abs=1e-9)
    assert tuple(model.actuator(i).name for i in range(model.nu)) == robot.joint_names
    assert model.nq == robot.nq
    assert model.nv == robot.nv


def test_same_limits(robot: RobotModel, model: mujoco.MjModel) -> None:
    """Motors end at the effort limit, joints at their range; nothing else slows a joint."""
    assert model.jnt_actfrclimited[1:].all()
    assert_close(model.jnt_actfrcrange[1:], np.stack([-robot.effort_limit, robot.effort_limit], 1), 1e-9)
    assert model.jnt_limited[1:].all()
    assert_close(model.jnt_range[1:], np.stack([robot.position_lower, robot.position_upper], 1), 1e-9)
    assert not model.dof_damping.any()
    assert not model.dof_frictionloss.any()


def test_same_com_mass_matrix_and_forces(
    robot: RobotModel, model: mujoco.MjModel, random_dynamics: list[Dynamics]
) -> None:
    """MuJoCo's base velocity is that of the origin in world axes, Pinocchio's in base axes.

    With v_mj = T v, T = diag(R, 1, 1): H = T^T M_mj T, and C v + tau_g = T^T (bias_mj - M_mj T w), w being the
    apparent acceleration -omega x v of the base origin in base axes.
    """
    data = mujoco.MjData(model)
    for dynamics in random_dynamics[:10]:
        turn = put(data, dynamics.state)
        mujoco.mj_forward(model, data)
        matrix = mass_matrix(model, data)
        scale = np.abs(dynamics.mass_matrix).max()
        assert_close(data.subtree_com[1], dynamics.com_in_world, 1e-9)
        assert_close(turn.T @ matrix @ turn, dynamics.mass_matrix, 1e-9 * scale)
        apparent = np.zeros(robot.nv)
        apparent[:3] = np.cross(dynamics.state.v[3:6], dynamics.state.v[:3])
        forces = turn.T @ (data.qfrc_bias + matrix @ turn @ apparent)
        assert_close(forces, dynamics.nonlinear_effects, 1e-8 * np.abs(dynamics.nonlinear_effects).max())


def test_touches_at_the_corners_of_the_soles(robot: RobotModel, model: mujoco.MjModel) -> None:
    """Sunk in by a tenth of a millimetre, exactly the corners touch, level and with the robot's friction."""
    data = mujoco.MjData(model)
    home = State(standing_posture(robot), np.zeros(robot.nv))
    put(data, home)
    data.qpos[2] -= 1e-4
    mujoco.mj_forward(model, data)
    assert data.ncon == CONTACTS_PER_FOOT * len(robot.soles) == 8
    assert_close(data.contact.dist, -1e-4, 3e-5)
    assert_close(data.contact.friction[:, :2], robot.spec.friction, 1e-12)
    dynamics = robot.at(home)
    corners = np.concatenate(
        [
            position + sole.corners @ rotation.T
            for sole, position, rotation in zip(
                robot.soles, dynamics.sole_position, dynamics.sole_rotation, strict=True
            )
        ]
    )
    assert_close(data.contact.pos[:, :2], corners[:, :2], 1e-5)


def test_falls_freely(robot: RobotModel, model: mujoco.MjModel) -> None:
    """In the air, without torques and with still joints, the CoM falls with g."""
    data = mujoco.MjData(model)
    put(data, State(standing_posture(robot) + np.eye(robot.nq)[2], np.zeros(robot.nv)))
    mujoco.mj_forward(model, data)
    jacobian = np.zeros((3, robot.nv))
    mujoco.mj_jacSubtreeCom(model, data, jacobian, 1)
    assert data.ncon == 0
    assert_close(jacobian @ data.qacc, (0.0, 0.0, -9.81), 1e-9)


def test_impossible_inertia_is_refused_in_words() -> None:
    with pytest.raises(RobotError, match=r"urdf of romeo: got .*inertia.*; allowed: a robot that MuJoCo"):
        mujoco_model(RobotModel.named("romeo"), STEP)


def test_missing_mujoco_is_said(monkeypatch: pytest.MonkeyPatch, g1: RobotModel) -> None:
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(LabError, match=r"pip install 'momentum-lab\[mujoco\]'"):
        mujoco_model(g1, STEP)


def mass_matrix(model: mujoco.MjModel, data: mujoco.MjData) -> np.ndarray:
    """All of it (nv, nv), column by column, because its storage differs between releases of MuJoCo."""
    columns = np.zeros((model.nv, model.nv))
    for column, unit in zip(columns, np.eye(model.nv), strict=True):
        mujoco.mj_mulM(model, data, column, unit)
    return columns.T


def put(data: mujoco.MjData, state: State) -> np.ndarray:
    """Put MuJoCo into a state; what turns Pinocchio's velocities into MuJoCo's (nv, nv)."""
    data.qpos[:] = state.q
    data.qpos[3:7] = state.q[[6, 3, 4, 5]]
    rotation = np.zeros(9)
    mujoco.mju_quat2Mat(rotation, data.qpos[3:7])
    turn = np.eye(state.v.size)
    turn[:3, :3] = rotation.reshape(3, 3)
    data.qvel[:] = turn @ state.v
    return turn
