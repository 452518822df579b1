"""The bounds that controllers of a standing robot share."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.control.qp import solve
from momentum_lab.control.stance_motion import Affine, stance_motion
from momentum_lab.control.stance_program import StanceBounds, StanceProgram, joint_bounds
from momentum_lab.errors import SolverError
from momentum_lab.robot.state import State
from tests.conftest import assert_close
from tests.control.situations import BOTH, G, goal, home, swaying

BOUNDS = StanceBounds(border=0.005, friction=0.6, least_force=0.02, joint_limit_rate=25.0)


def asked(robot, dynamics, stance, x):
    """The point nearest to x under all bounds, and the motion that it is."""
    motion = stance_motion(dynamics, goal(robot, dynamics, stance), stance, 50.0)
    program = StanceProgram(robot, stance, stance)
    centered = program.centered(dynamics, motion.wrench)
    size = motion.acceleration.matrix.shape[1]
    x = np.zeros(size) if x is None else x
    problem = program.problem(np.eye(size), -x, dynamics, motion, centered, BOUNDS)
    return solve(problem).x, motion, problem


@pytest.mark.parametrize("stance", [BOTH, (0,)])
def test_a_robot_at_rest_above_the_middle_carries_evenly(robot, stance):
    """Wrenches about the soles' centres less an even share: nothing but rounding of the posture."""
    dynamics = home(robot, stance)
    motion = stance_motion(dynamics, goal(robot, dynamics, stance), stance, 0.0)
    program = StanceProgram(robot, stance, stance)
    centered = program.centered(dynamics, motion.wrench)
    # On two feet the first one carries half, in the middle of its sole: about its origin that is a moment.
    sole = robot.soles[stance[0]]
    middle = (sole.lower + sole.upper) / 2.0
    x = np.zeros(centered.matrix.shape[1])
    if len(stance) == 2:
        x[robot.na :] = 0.5 * np.array([0.0, 0.0, 1.0, middle[1], -middle[0], 0.0])
    assert_close(centered.at(x), np.zeros(6 * len(stance)), 5e-5)


def test_centered_wrenches_are_the_same_wrenches(robot, rng):
    """The force in sole axes; the moment about the centre has no lever there."""
    dynamics = swaying(robot, rng)
    program = StanceProgram(robot, BOTH, BOTH)
    wrench = rng.normal(size=12)
    found = program.centered(dynamics, Affine(np.zeros((12, 1)), wrench)).at(np.zeros(1)).reshape(2, 6)
    weight = robot.mass * G
    for foot in BOTH:
        axes, sole = dynamics.sole_rotation[foot], robot.soles[foot]
        force, moment = wrench[6 * foot : 6 * foot + 3], wrench[6 * foot + 3 : 6 * foot + 6]
        arm = axes @ np.append((sole.lower + sole.upper) / 2.0, 0.0)
        even = np.array([0.0, 0.0, 0.5])
        assert_close(found[foot, :3], axes.T @ force / weight - even, 1e-12)
        assert_close(found[foot, 3:], axes.T @ (moment - np.cross(arm, force)) / weight, 1e-12)


@pytest.mark.parametrize("stance", [BOTH, (0,)])
def test_whatever_is_asked_the_ground_and_the_motors_can_give_the_answer(robot, rng, stance):
    """Random wishes: CoP in the safe soles, least force, friction; torques within limits."""
    dynamics = home(robot, stance)
    size = robot.na + 6 * (len(stance) - 1)
    for _ in range(5):
        x, motion, _ = asked(robot, dynamics, stance, 5.0 * rng.normal(size=size))
        weight = robot.mass * G
        assert (np.abs(motion.torque.at(x)) < robot.effort_limit * 1.001).all()
        assert_close(motion.still.at(x), np.zeros(motion.still.offset.size), 1e-6)
        for foot, wrench in zip(stance, motion.wrench.at(x).reshape(-1, 6), strict=True):
            fx, fy, fz, nx, ny, _ = wrench
            sole, axes = robot.soles[foot], dynamics.sole_rotation[foot]
            assert_close(axes, np.eye(3), 1e-4)
            assert fz > (BOUNDS.least_force - 1e-5) * weight
            assert np.hypot(fx, fy) < BOUNDS.friction * fz + 1e-4 * weight
            cop = np.array([-ny, nx]) / fz
            assert (cop > sole.lower + BOUNDS.border - 1e-4).all()
            assert (cop < sole.upper - BOUNDS.border + 1e-4).all()


def test_a_joint_near_its_limit_has_to_brake_before_it(robot):
    """At the highest braking the bound allows, the joint approaches without passing: (d/dt + kappa)^2 e = 0."""
    still = home(robot)
    q, v = still.state.q.copy(), still.state.v.copy()
    joint = robot.upper_body[0]
    stop = robot.position_upper[joint] - 0.03
    angle, speed, step = stop - 0.05, 1.2, 1e-4
    for _ in range(4000):
        q[7 + joint], v[6 + joint] = angle, speed
        _, high = joint_bounds(robot, robot.at(State(q, v)), 25.0)
        speed += step * high[joint]
        angle += step * speed
        assert angle < stop + 1e-4
    assert angle == pytest.approx(stop, abs=1e-3)


def test_a_contradiction_is_named(talos):
    """More force than there is weight: the message says on which foot."""
    dynamics = home(talos, (0,))
    motion = stance_motion(dynamics, goal(talos, dynamics, (0,)), (0,), 50.0)
    program = StanceProgram(talos, (0,), (0,))
    centered = program.centered(dynamics, motion.wrench)
    nothing = Affine(np.zeros_like(centered.matrix), centered.offset - [0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
    size = talos.na
    problem = program.problem(np.eye(size), np.zeros(size), dynamics, motion, nothing, BOUNDS)
    with pytest.raises(SolverError, match="force, friction and CoP of the left foot"):
        solve(problem)
