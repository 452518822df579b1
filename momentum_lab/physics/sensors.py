"""What a robot measures of its own state: encoders and an inertial unit that are noisy."""

from __future__ import annotations

import numpy as np

from momentum_lab.physics.mismatch import Mismatch
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import State

# Joint speeds are differences of angles behind a filter of this bandwidth, rad/s: their noise is that much larger.
_ENCODER_BANDWIDTH = 100.0
# An inertial unit measures the rate itself, and its orientation follows it this fast, rad/s.
_IMU_BANDWIDTH = 10.0


def measured(robot: RobotModel, state: State, mismatch: Mismatch, seed: int, tick: int) -> State:
    """The state as the robot's sensors have it at a tick; it depends on nothing but its arguments.

    theta_m = theta + n, theta'_m = theta' + w n', and likewise for the orientation of the base (its error is a
    rotation about the base's own axes), all n independent, normal, and new at every tick. Position and linear
    velocity of the base are taken to be known: no odometry is simulated.

    Args:
        robot: the robot.
        state: its true state.
        mismatch: holds the standard deviations.
        seed: of the run.
        tick: of the run.
    """
    if not (mismatch.encoder_noise or mismatch.imu_noise):
        return state
    rotation, joints = slice(3, 6), slice(6, robot.nv)
    noise = np.random.default_rng((seed, tick)).standard_normal((2, robot.nv))
    noise[:, :3] = 0.0
    noise[:, rotation] *= mismatch.imu_noise
    noise[:, joints] *= mismatch.encoder_noise
    noise[1, rotation] *= _IMU_BANDWIDTH
    noise[1, joints] *= _ENCODER_BANDWIDTH
    return State(robot.integrate(state.q, noise[0]), state.v + noise[1])
