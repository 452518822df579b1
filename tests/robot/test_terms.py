"""Frames out of Pinocchio's memory, against Pinocchio's own functions for them."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import State
from momentum_lab.robot.terms import Frames, memory_of, state_terms
from tests.conftest import assert_close, random_state

ALIGNED = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
PLACES, AXES, JACOBIANS, DRIFTS, LAST_AXES, LAST_JACOBIAN, LAST_DRIFT = range(8, 15)


@pytest.fixture
def state(any_robot: RobotModel) -> State:
    return random_state(any_robot, np.random.default_rng(7))


def terms_of(robot: RobotModel, state: State, indices: list[int]) -> tuple[np.ndarray, ...]:
    """The terms of any frames of a robot, from data of their own."""
    data, frames = robot.model.createData(), Frames.of(robot.model, indices)
    memory = memory_of(data)
    pin.crba(robot.model, data, state.q, pin.Convention.WORLD)
    pin.nonLinearEffects(robot.model, data, state.q, state.v)
    gravity = robot.model.gravity.linear
    return state_terms(
        *memory,
        state.v,
        frames.joint,
        frames.moved_by,
        frames.position,
        frames.rotation,
        robot.mass,
        gravity.copy(),
    )


def test_every_frame_is_where_pinocchio_says_and_moves_as_it_says(
    any_robot: RobotModel, state: State
) -> None:
    model, data = any_robot.model, any_robot.model.createData()
    indices = list(range(1, len(model.frames)))
    terms = terms_of(any_robot, state, indices)
    pin.forwardKinematics(model, data, state.q, state.v, np.zeros(model.nv))
    pin.computeJointJacobians(model, data, state.q)
    pin.updateFramePlacements(model, data)
    for row, index in enumerate(indices[:-1]):
        drift = pin.getFrameClassicalAcceleration(model, data, index, ALIGNED).vector
        assert_close(terms[PLACES][row], data.oMf[index].translation, 1e-12)
        assert_close(terms[AXES][row], data.oMf[index].rotation, 1e-12)
        assert_close(terms[JACOBIANS][row], pin.getFrameJacobian(model, data, index, ALIGNED), 1e-12)
        assert_close(terms[DRIFTS][row], drift, 1e-10)


def test_the_last_frame_is_given_apart(any_robot: RobotModel, state: State) -> None:
    sole, pelvis = any_robot.soles[0].frame, any_robot.pelvis
    apart, among = (terms_of(any_robot, state, order) for order in ([sole, pelvis], [pelvis, sole]))
    assert np.array_equal(apart[LAST_AXES], among[AXES][0])
    assert np.array_equal(apart[LAST_JACOBIAN], among[JACOBIANS][0])
    assert np.array_equal(apart[LAST_DRIFT], among[DRIFTS][0])


def test_memory_shows_the_latest_pass_and_only_that(any_robot: RobotModel, state: State) -> None:
    data = any_robot.model.createData()
    memory = memory_of(data)
    for q in (pin.neutral(any_robot.model), state.q):
        pin.crba(any_robot.model, data, q, pin.Convention.WORLD)
        assert np.array_equal(memory.joint_position[-1], data.oMi[any_robot.model.njoints - 1].translation)
        assert np.array_equal(memory.joint_rotation[-1], data.oMi[any_robot.model.njoints - 1].rotation)
        assert np.array_equal(memory.joint_jacobian, data.J)
