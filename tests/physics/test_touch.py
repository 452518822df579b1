"""Points near the ground: where they are, how they move, and that none is overlooked."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from momentum_lab.physics.ground import Ground, Patch
from momentum_lab.physics.simulator import Simulator
from momentum_lab.physics.touch import BodyPoints, sole_touches
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
    touches = sole_touches(robot, robot.at(state), Ground((patch, patch), patch))
    assert [touch.foot for touch in touches] == [0, 1]
    for foot, touch in enumerate(touches):
        position = corners_at(robot, state.q, foot)
        ahead = corners_at(robot, robot.integrate(state.q, EPS * state.v), foot)
        behind = corners_at(robot, robot.integrate(state.q, -EPS * state.v), foot)
        assert_close(touch.position, position, 1e-12)
        assert_close(touch.gap, [rotation[:, 2] @ (p - patch.origin) for p in position], 1e-12)
        velocity = (touch.spread @ touch.frame_jacobian @ state.v).reshape(-1, 3)
        assert_close(velocity, (ahead - behind) / (2 * EPS) @ rotation, 1e-6)


def test_a_foot_in_the_air_touches_nothing(robot):
    q = standing_posture(robot, robot.foot_names[:1])
    touches = sole_touches(robot, robot.at(State(q, np.zeros(robot.nv))), Ground.level(2, 0.7))
    assert [touch.foot for touch in touches] == [0]


def test_bodies_of_a_standing_robot_are_clear(robot):
    state = State(standing_posture(robot), np.zeros(robot.nv))
    assert BodyPoints(robot, 1e-3).touches(state, Patch(0.7)) == []


def test_bodies_near_the_floor_are_found_where_they_are(robot, rng):
    """A floor raised to the hips: every point below it, at its place, with its velocity."""
    state = near_the_ground(robot, rng)
    floor = Patch(0.7, origin=np.array([0.0, 0.0, 0.8]))

    def points_at(q):
        data = robot.model.createData()
        pin.framesForwardKinematics(robot.model, data, q)
        links = robot.spec.fall_points.items()
        return np.array([data.oMf[robot.frame(link)].act(np.array(p)) for link, ps in links for p in ps])

    position = points_at(state.q)
    near = position[:, 2] < 0.8 + 0.01
    difference = points_at(robot.integrate(state.q, EPS * state.v)) - points_at(
        robot.integrate(state.q, -EPS * state.v)
    )
    touches = BodyPoints(robot, 1e-3).touches(state, floor)
    assert {touch.foot for touch in touches} == {None}
    assert_close(np.concatenate([touch.position for touch in touches]), position[near], 1e-12)
    assert_close(np.concatenate([touch.gap for touch in touches]), position[near, 2] - 0.8, 1e-12)
    velocity = np.concatenate([touch.spread @ touch.frame_jacobian @ state.v for touch in touches]).reshape(
        -1, 3
    )
    assert_close(velocity, difference[near] / (2 * EPS), 1e-6)


def test_looking_away_misses_no_touch(robot):
    """A limp robot falls: the points that are seen while following it are those that a fresh look sees."""
    start = State(standing_posture(robot), np.zeros(robot.nv))
    simulator = Simulator(robot, Ground.level(2, 0.7), 1e-3)
    floor, following, state = Patch(0.7), BodyPoints(robot, 1e-3), start
    seen = 0
    for tick in range(900):
        followed = following.touches(state, floor)
        if tick > 300:
            fresh = BodyPoints(robot, 1e-3).touches(state, floor)
            assert [touch.gap.tolist() for touch in followed] == [touch.gap.tolist() for touch in fresh]
            seen += len(fresh)
        damping = -8e-3 * robot.effort_limit * state.v[6:]
        state = simulator.step(robot.at(state), damping, (), 0.0).state
        following.follow(state)
    assert seen > 0
