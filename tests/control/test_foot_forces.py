"""A net force and an angular momentum rate as one admissible wrench per foot."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.control.foot_forces import ForceBounds, LoadSharing, _cops, _forces
from momentum_lab.control.footing import Footing
from momentum_lab.robot.state import State
from tests.conftest import assert_close
from tests.control.situations import BOTH, G, home, swaying

BORDER = 0.005
BOUNDS = ForceBounds(friction=0.6, normal_moment=0.018, least_force=10.0)


def weight(robot) -> np.ndarray:
    return np.array([0.0, 0.0, robot.mass * G])


def demands(robot, rng, count=40):
    """Net forces around the weight and angular rates, from modest to impossible."""
    for _ in range(count):
        size = rng.uniform(0.0, 0.5)
        yield (
            weight(robot) + size * robot.mass * G * rng.normal(size=3) * [1.0, 1.0, 0.5],
            size * 0.2 * robot.mass * G * rng.normal(size=3),
        )


def share(robot, dynamics, stance, force, angular_rate, bounds=BOUNDS):
    feet = Footing(robot).stance_feet(dynamics, stance, BORDER)
    return LoadSharing(robot).share(feet, force, angular_rate, bounds)


def momentum_rate(robot, dynamics, wrench):
    """Eqs. 1 and 2 from the wrenches about the sole origins."""
    arms = dynamics.sole_position - dynamics.com_in_world
    angular = (np.cross(arms, wrench[:, :3]) + wrench[:, 3:]).sum(axis=0)
    return np.concatenate([wrench[:, :3].sum(axis=0) - weight(robot), angular])


@pytest.mark.parametrize("stance", [BOTH, (0,), (1,)])
def test_wrenches_and_momentum_rate_tell_the_same(robot, rng, stance):
    dynamics = swaying(robot, rng, stance)
    for force, angular_rate in demands(robot, rng):
        answer = share(robot, dynamics, stance, force, angular_rate)
        assert_close(momentum_rate(robot, dynamics, answer.wrench), answer.momentum_rate, 1e-9)
        for foot in {0, 1} - set(stance):
            assert_close(answer.wrench[foot], np.zeros(6), 0.0)


def test_both_stages_in_one_call_answer_what_two_programs_answer(robot, rng):
    """Where no bound presses; where one does, the call does not claim to have the answer."""
    dynamics, sharing = swaying(robot, rng), LoadSharing(robot)
    feet, certified = Footing(robot).stance_feet(dynamics, BOTH, BORDER), 0
    for force, angular_rate in demands(robot, rng, count=200):
        wrenches, rate, claimed = sharing._quietly(feet, force, angular_rate, BOUNDS)
        forces = _forces(feet, force, angular_rate, BOUNDS)
        staged = sharing._recombine(feet, forces, _cops(feet, forces, angular_rate, BOUNDS))
        difference = np.abs(wrenches - staged.wrench).max()
        assert claimed == (difference < 1e-3)
        if claimed:
            assert_close(wrenches, staged.wrench, 1e-9 * robot.mass * G)
            assert_close(rate, staged.momentum_rate, 1e-9 * robot.mass * G)
        certified += claimed
    assert 3 < certified < 197


@pytest.mark.parametrize("stance", [BOTH, (0,), (1,)])
def test_every_foot_wrench_is_one_that_the_ground_can_give(robot, rng, stance):
    """In sole axes: CoP in the safe sole, normal moment within bounds; on two feet the cone and the least force."""
    dynamics = swaying(robot, rng, stance)
    for force, angular_rate in demands(robot, rng):
        # In single support the net force is the foot's force; it comes from the cone already.
        if len(stance) == 1:
            force = weight(robot) + 0.3 * (force - weight(robot))
        answer = share(robot, dynamics, stance, force, angular_rate)
        for foot in stance:
            sole, rotation = robot.soles[foot], dynamics.sole_rotation[foot]
            f, n = (part @ rotation for part in (answer.wrench[foot, :3], answer.wrench[foot, 3:]))
            cop = np.array([-n[1], n[0]]) / f[2]
            assert (cop >= sole.lower + BORDER - 1e-6).all()
            assert (cop <= sole.upper - BORDER + 1e-6).all()
            twist = n[2] - (cop[0] * f[1] - cop[1] * f[0])
            assert abs(twist) <= BOUNDS.normal_moment * f[2] + 1e-6
            if len(stance) == 2:
                assert np.hypot(f[0], f[1]) <= BOUNDS.friction * f[2] + 1e-5
                assert f[2] >= BOUNDS.least_force - 1e-6


def test_single_support_is_the_closed_form(robot, rng):
    """Moment about the sole origin, CoP from it, clipped to the safe sole; the rest goes into the normal moment."""
    for stance in ((0,), (1,)):
        dynamics = swaying(robot, rng, stance)
        origin, rotation = dynamics.sole_position[stance[0]], dynamics.sole_rotation[stance[0]]
        sole = robot.soles[stance[0]]
        for force, angular_rate in demands(robot, rng):
            moment = rotation.T @ (angular_rate - np.cross(origin - dynamics.com_in_world, force))
            f = rotation.T @ force
            wanted = np.array([-moment[1], moment[0]]) / f[2]
            x, y = np.clip(wanted, sole.lower + BORDER, sole.upper - BORDER)
            limit = BOUNDS.normal_moment * f[2]
            twist = np.clip(moment[2] - (x * f[1] - y * f[0]), -limit, limit)
            about_sole = np.cross([x, y, 0.0], f) + np.array([0.0, 0.0, twist])
            expected = np.concatenate([force, rotation @ about_sole])
            answer = share(robot, dynamics, stance, force, angular_rate)
            assert_close(answer.wrench[stance[0]], expected, 1e-9 * robot.mass * G)


def test_an_admissible_demand_in_single_support_is_met_exactly(robot):
    dynamics = home(robot, (0,))
    force = weight(robot) + robot.mass * np.array([0.1, -0.05, 0.2])
    angular_rate = np.array([0.5, -0.5, 0.02])
    answer = share(robot, dynamics, (0,), force, angular_rate)
    assert_close(answer.momentum_rate[:3], force - weight(robot), 1e-9)
    assert_close(answer.momentum_rate[3:], angular_rate, 1e-9)


def test_an_admissible_demand_in_double_support_is_met(robot, rng):
    """Linear rate within 1e-3 m g, angular rate within what half a millimetre of CoP makes."""
    dynamics = home(robot)
    for _ in range(20):
        force = weight(robot) + robot.mass * rng.uniform(-0.5, 0.5, 3)
        angular_rate = robot.mass * G * rng.uniform(-0.015, 0.015, 3) * [1.0, 1.0, 0.3]
        answer = share(robot, dynamics, BOTH, force, angular_rate)
        assert_close(answer.momentum_rate[:3], force - weight(robot), 1e-3 * robot.mass * G)
        assert_close(answer.momentum_rate[3:], angular_rate, 5e-4 * robot.mass * G)


def test_linear_momentum_has_priority_when_the_soles_are_too_small(robot):
    """A demand for turning that no CoP can give costs angular rate and next to no force."""
    dynamics = home(robot)
    demand = np.array([0.0, 0.5 * robot.mass * G, 0.0])
    answer = share(robot, dynamics, BOTH, weight(robot), demand)
    assert np.abs(answer.momentum_rate[:3]).max() < 0.02 * robot.mass * G
    assert answer.momentum_rate[4] < 0.5 * demand[1]


def ankle_moments(robot, dynamics, wrench) -> np.ndarray:
    """Roll and pitch moments of the ground about each ankle, sole axes (F, 2), N m."""
    moments = []
    for foot, sole in enumerate(robot.soles):
        data = robot.model.createData()
        pin.framesForwardKinematics(robot.model, data, dynamics.state.q)
        ankle = data.oMi[robot.model.frames[sole.frame].parentJoint].translation
        about = wrench[foot, 3:] + np.cross(dynamics.sole_position[foot] - ankle, wrench[foot, :3])
        moments.append((dynamics.sole_rotation[foot].T @ about)[:2])
    return np.array(moments)


def test_what_the_ankles_need_not_do_they_do_not_do(robot):
    """Lee and Goswami's claim: a goal that forces through the ankles can reach leaves the ankles without torque."""
    dynamics = home(robot)
    feet = Footing(robot).stance_feet(dynamics, BOTH, BORDER)
    for tilt, split in (((0.0, 0.0), 0.5), ((0.05, 0.0), 0.5), ((-0.04, 0.06), 0.4), ((0.0, -0.08), 0.7)):
        forces = [part * robot.mass * G * np.array([tilt[0], tilt[1], 1.0]) for part in (split, 1.0 - split)]
        angular_rate = sum(np.cross(ankle, f) for ankle, f in zip(feet.com_to_ankle, forces, strict=True))
        answer = share(robot, dynamics, BOTH, sum(forces), angular_rate)
        # Less than half a millimetre of CoP under the whole weight.
        moments = ankle_moments(robot, dynamics, answer.wrench)
        assert np.abs(moments).max() < 5e-4 * robot.mass * G
        for rotation, ankle, wrench in zip(feet.rotation, feet.safe.ankles, answer.wrench, strict=True):
            f, n = wrench[:3] @ rotation, wrench[3:] @ rotation
            torque_free = ankle[:2] - ankle[2] * f[:2] / f[2]
            assert_close([-n[1] / f[2], n[0] / f[2]], torque_free, 1e-3)


@pytest.mark.parametrize("heavy", [0, 1])
def test_the_least_force_is_held_when_a_foot_wants_to_lift(robot, heavy):
    """A moment about the forward axis that would stand the robot on one foot."""
    dynamics = home(robot)
    light = 1 - heavy
    sign = np.sign(dynamics.sole_position[heavy, 1] - dynamics.com_in_world[1])
    angular_rate = np.array([2.0 * sign * 0.1 * robot.mass * G, 0.0, 0.0])
    answer = share(robot, dynamics, BOTH, weight(robot), angular_rate)
    assert answer.wrench[light, 2] == pytest.approx(BOUNDS.least_force, abs=1e-5)
    assert answer.wrench[heavy, 2] > 0.8 * robot.mass * G


def test_on_a_tilted_sole_forces_and_cops_are_meant_in_its_axes(robot, rng):
    """The whole robot leaning by 0.1 rad: cone and sole lean with it."""
    dynamics = home(robot)
    lean = pin.exp3(np.array([0.05, 0.1, 0.2]))
    q = dynamics.state.q.copy()
    q[:3] = lean @ q[:3]
    q[3:7] = pin.Quaternion(lean @ pin.Quaternion(q[3:7]).toRotationMatrix()).coeffs()
    leaning = robot.at(State(q, np.zeros(robot.nv)))
    force, angular_rate = next(demands(robot, rng, 1))
    upright = share(robot, dynamics, BOTH, force, angular_rate).wrench
    turned = share(robot, leaning, BOTH, lean @ force, lean @ angular_rate).wrench
    expected = np.hstack([upright[:, :3] @ lean.T, upright[:, 3:] @ lean.T])
    assert_close(turned, expected, 1e-5 * robot.mass * G)
