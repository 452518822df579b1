"""The momentum of a kinematic motion, and what it is good for."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.momentum.reference_motion import ReferenceMotion, reference_motion
from momentum_lab.momentum.resolved import resolved_rates
from momentum_lab.robot.state import State
from tests.conftest import assert_close
from tests.control.situations import BOTH, home

DT, TICKS = 2e-3, 250
SWING = {"talos": "arm_left_1_joint", "g1": "left_shoulder_pitch_joint"}


def arm(robot) -> int:
    return robot.joint_names.index(SWING[robot.spec.name])


def arm_swing(robot, com_speed: float = 0.0) -> ReferenceMotion:
    """One arm forward and back in half a second, the CoM still or moving to the left."""
    rates = np.zeros((TICKS, robot.na))
    rates[:, arm(robot)] = -1.5 * np.sin(2.0 * np.pi * np.arange(TICKS) / TICKS)
    velocity = np.tile([0.0, com_speed, 0.0], (TICKS, 1))
    return reference_motion(robot, home(robot).state.q, BOTH, velocity, rates, DT)


@pytest.mark.parametrize("com_speed", [0.0, 0.04])
def test_its_momentum_is_that_of_its_motion(robot, com_speed):
    """Pinocchio's own recursion along the path (Eq. 15), and linear momentum as told."""
    motion, data = arm_swing(robot, com_speed), robot.model.createData()
    for q, v, momentum in zip(motion.q[::10], motion.v[::10], motion.momentum[::10], strict=True):
        pin.computeCentroidalMomentum(robot.model, data, q, v)
        assert_close(momentum, data.hg.vector, 1e-11 * robot.mass)
    assert_close(motion.momentum[:, :3], np.tile([0.0, robot.mass * com_speed, 0.0], (TICKS, 1)), 1e-9)
    assert np.abs(motion.momentum[:, 4]).max() > 0.05


def test_feet_stay_and_the_com_goes_where_it_is_sent(robot):
    """To a thousandth of the way: each step is straight in the joints, and so not quite for the CoM."""
    motion, start = arm_swing(robot, 0.04), home(robot)
    end = robot.at(State(motion.q[-1], motion.v[-1]))
    assert_close(end.sole_position, start.sole_position, 1e-5)
    assert_close(end.sole_rotation, start.sole_rotation, 1e-4)
    way = 0.04 * DT * (TICKS - 1)
    assert_close(end.com_in_world - start.com_in_world, [0.0, way, 0.0], 1e-3 * way)


def test_path_and_rates_belong_together(robot):
    motion = arm_swing(robot)
    for i in range(0, TICKS - 1, 25):
        step = pin.difference(robot.model, motion.q[i], motion.q[i + 1])
        assert_close(step, DT * motion.v[i], 1e-12)


def test_zero_angular_momentum_bends_the_body_and_the_motions_own_does_not(robot):
    """The chapter's example of section 5.3: an arm swing under k_d = 0, and under the k_d of the swing itself."""
    motion = arm_swing(robot)
    middle = TICKS // 4
    here = robot.at(State(motion.q[middle], np.zeros(robot.nv)))
    feet = here.sole_jacobian.reshape(-1, robot.nv)
    still = feet @ motion.v[middle]
    others = np.delete(np.arange(robot.nv), 6 + arm(robot))

    def compensation(momentum: np.ndarray) -> float:
        v = resolved_rates(feet, still, here.centroidal_map, momentum, motion.v[middle])
        return float(np.abs(v - motion.v[middle])[others].max())

    assert compensation(motion.momentum[middle]) < 1e-9
    assert compensation(np.zeros(6)) > 0.1
