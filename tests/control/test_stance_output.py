"""The answer of a minimiser: wrenches, momentum rates and CoPs belong together."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.control.stance_motion import stance_motion
from momentum_lab.control.stance_output import stance_output
from momentum_lab.momentum.ground import cop_from_wrench
from momentum_lab.momentum.wrench import sum_wrenches
from tests.conftest import assert_close
from tests.control.situations import BOTH, G, goal, swaying


@pytest.mark.parametrize("stance", [BOTH, (1,)])
def test_everything_follows_from_the_minimiser(robot, rng, stance):
    dynamics = swaying(robot, rng, stance)
    motion = stance_motion(dynamics, goal(robot, dynamics, stance), stance, 50.0)
    x = 0.1 * rng.normal(size=motion.acceleration.matrix.shape[1])
    x[robot.na :][2::6] += 0.5
    desired = rng.normal(size=6)
    out = stance_output(robot, dynamics, motion, x, stance, desired, {"com x": 1.0})
    assert not np.delete(out.foot_wrench_admissible, stance, axis=0).any()
    assert_close(out.torque, motion.torque.at(x), 0.0)
    rate = dynamics.centroidal_map @ out.acceleration + dynamics.centroidal_bias
    assert_close(out.momentum_rate_admissible, rate, 1e-9 * robot.mass * G)
    height = float(dynamics.sole_position[list(stance), 2].mean())
    net = sum_wrenches(out.foot_wrench_admissible, dynamics.sole_position, np.zeros(3))
    assert_close(out.cop_admissible, cop_from_wrench(net, np.zeros(3), height), 1e-9)
    assert out.slack == {"com x": 1.0}
    assert out.momentum_rate_desired is desired
    assert out.failure is None
