"""Points of bodies near the floor: where they are, how they move, and that none is overlooked."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from momentum_lab.physics.body_touch import BodyPoints
from momentum_lab.physics.ground import Ground, Patch
from momentum_lab.physics.simulator import Simulator
from momentum_lab.physics.touch import Touches
from momentum_lab.robot.posture import standing_posture
from momentum_lab.robot.state import State
from tests.conftest import assert_close
from tests.physics.test_touch import EPS, near_the_ground


def test_bodies_of_a_standing_robot_are_clear(robot):
    state = State(standing_posture(robot), np.zeros(robot.nv))
    assert BodyPoints(robot, 1e-3).touches(state, Patch(0.7)) is None


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
    assert set(touches.foot.tolist()) == {-1}
    assert_close(touches.position, position[near], 1e-12)
    assert_close(touches.contacts.gap, position[near, 2] - 0.8, 1e-12)
    velocity = (touches.contacts.jacobian @ state.v).reshape(-1, 3)
    assert_close(velocity, difference[near] / (2 * EPS), 1e-6)


def gaps_of(touches: Touches | None) -> list[float]:
    return [] if touches is None else touches.contacts.gap.tolist()


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
            assert gaps_of(followed) == gaps_of(fresh)
            seen += len(gaps_of(fresh))
        damping = -8e-3 * robot.effort_limit * state.v[6:]
        state = simulator.step(robot.at(state), damping, (), 0.0).state
        following.follow(state)
    assert seen > 0


def test_no_point_is_faster_than_its_reach_says(robot, rng):
    """Random states far from home: each body's points, by finite differences, against the bound from the levers."""
    bodies = BodyPoints(robot, 1.0)
    links = list(robot.spec.fall_points.items())

    def points_at(q):
        data = robot.model.createData()
        pin.framesForwardKinematics(robot.model, data, q)
        return [np.array([data.oMf[robot.frame(link)].act(np.array(p)) for p in ps]) for link, ps in links]

    closest = 0.0
    for _ in range(20):
        q = pin.integrate(robot.model, standing_posture(robot), rng.normal(scale=1.0, size=robot.nv))
        v = rng.normal(size=robot.nv)
        after, before = points_at(pin.integrate(robot.model, q, EPS * v)), points_at(q)
        for body, bound in enumerate(bodies.reach @ np.abs(v)):
            speed = np.linalg.norm(after[body] - before[body], axis=1).max() / EPS
            assert speed <= bound
            closest = max(closest, speed / bound)
    assert closest > 0.3  # a bound that is never nearly needed would look away too seldom
