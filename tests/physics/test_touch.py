"""Points near the ground: where they are, how they move, and that none is overlooked."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from momentum_lab.physics.ground import Ground, Patch
from momentum_lab.physics.touch import SolePoints, near_points
from momentum_lab.robot.posture import standing_posture
from momentum_lab.robot.state import State
from tests.conftest import assert_close, random_rotation

EPS = 1e-6


def near_the_ground(robot, rng) -> State:
    """The standing posture, a little disturbed, moving."""
    q = pin.integrate(robot.model, standing_posture(robot), rng.normal(scale=2e-3, size=robot.nv))
    return State(q, rng.normal(size=robot.nv))


def corners_at(robot, q, foot):
    data = robot.model.createData()
    pin.framesForwardKinematics(robot.model, data, q)
    sole = robot.soles[foot]
    return np.array([data.oMf[sole.frame].act(corner) for corner in sole.corners])


def test_corners_of_soles_and_their_velocities(robot, rng):
    """Against forward kinematics and its finite differences, on planes with any axes."""
    state = near_the_ground(robot, rng)
    rotation = random_rotation(rng)
    patch = Patch(0.7, np.array([0.0, 0.0, 0.5]), rotation)
    touches = SolePoints(robot, 1e-3).touches(robot.at(state), Ground((patch, patch), patch), 0.0)
    assert touches.foot.tolist() == [0, 1]
    velocity = (touches.contacts.jacobian @ state.v).reshape(2, 4, 3)
    for foot, moving in enumerate(velocity):
        position = corners_at(robot, state.q, foot)
        ahead = corners_at(robot, robot.integrate(state.q, EPS * state.v), foot)
        behind = corners_at(robot, robot.integrate(state.q, -EPS * state.v), foot)
        mine = slice(4 * foot, 4 * foot + 4)
        assert_close(touches.position[mine], position, 1e-12)
        height = [rotation[:, 2] @ (p - patch.origin) for p in position]
        assert_close(touches.contacts.gap[mine], height, 1e-12)
        assert_close(moving, (ahead - behind) / (2 * EPS) @ rotation, 1e-6)
        assert_close(touches.contacts.friction[mine], np.full(4, 0.7), 0.0)


def test_a_foot_in_the_air_touches_nothing(robot):
    q = standing_posture(robot, robot.foot_names[:1])
    touches = SolePoints(robot, 1e-3).touches(
        robot.at(State(q, np.zeros(robot.nv))), Ground.level(2, 0.7), 0.0
    )
    assert touches.foot.tolist() == [0]
    assert len(touches.position) == 4


def test_of_a_sole_on_edge_only_that_edge_is_near(robot):
    """Tipped by 0.3 rad about its leading edge: two corners are left, with their own rows."""
    state = State(standing_posture(robot), np.zeros(robot.nv))
    tipped = Patch(0.7, corners_at(robot, state.q, 0)[0], pin.rpy.rpyToMatrix(0.0, 0.3, 0.0))
    touches = SolePoints(robot, 1e-3).touches(robot.at(state), Ground((tipped, tipped), tipped), 0.0)
    near = touches.contacts.gap < 0.01
    left = near_points(touches)
    assert 0 < near.sum() < near.size
    assert_close(left.position, touches.position[near], 0.0)
    assert_close(left.contacts.gap, touches.contacts.gap[near], 0.0)
    assert_close(left.contacts.jacobian, touches.contacts.jacobian[np.repeat(near, 3)], 0.0)
