"""Noise of encoders and inertial unit: as large as declared, where declared, and the same in every run."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.physics.mismatch import Mismatch
from momentum_lab.physics.sensors import measured

ENCODER, IMU, TICKS = 1e-4, 1e-3, 2000
NOISY = Mismatch(encoder_noise=ENCODER, imu_noise=IMU)


def errors(robot, state, mismatch=NOISY, ticks=TICKS) -> tuple[np.ndarray, np.ndarray]:
    """What is measured minus what is (ticks, nv), of configuration and velocity."""
    seen = [measured(robot, state, mismatch, 7, tick) for tick in range(ticks)]
    q = [pin.difference(robot.model, state.q, one.q) for one in seen]
    return np.array(q), np.array([one.v - state.v for one in seen])


def test_without_noise_the_state_itself_is_measured(robot, random_states):
    assert measured(robot, random_states[0], Mismatch(mass_error=0.2), 1, 2) is random_states[0]


def test_noise_has_its_standard_deviation_and_no_mean(robot, random_states):
    """Of 2000 normal numbers the standard deviation is off by 1.6 %, the mean by 2.2 % of it (one sigma)."""
    q, v = errors(robot, random_states[0])
    for error, joints, base in ((q, ENCODER, IMU), (v, 100.0 * ENCODER, 10.0 * IMU)):
        assert not error[:, :3].any()
        assert error[:, 3:6].std(axis=0) == pytest.approx(np.full(3, base), rel=0.08)
        assert error[:, 6:].std(axis=0) == pytest.approx(np.full(robot.na, joints), rel=0.08)
        assert np.abs(error[:, 6:].mean(axis=0)).max() < 0.12 * joints


def test_errors_are_independent(robot, random_states):
    """Correlations of 2000 independent numbers are 0.022 (one sigma)."""
    q, v = errors(robot, random_states[0])
    series = np.column_stack([q[:, 3:], v[:, 3:]])
    both = np.corrcoef(np.vstack([series[:-1].T, series[1:].T]))
    assert np.abs(both - np.eye(len(both))).max() < 0.12


def test_one_sensor_alone(robot, random_states):
    q, v = errors(robot, random_states[0], Mismatch(imu_noise=IMU), ticks=3)
    assert not q[:, 6:].any()
    assert not v[:, 6:].any()
    assert q[:, 3:6].all()


def test_seed_and_tick_decide_alone(robot, random_states):
    state = random_states[0]
    one, same = (measured(robot, state, NOISY, 3, 5) for _ in range(2))
    assert one.q.tobytes() + one.v.tobytes() == same.q.tobytes() + same.v.tobytes()
    for seed, tick in ((3, 6), (4, 5), (5, 3)):
        assert not np.array_equal(one.q, measured(robot, state, NOISY, seed, tick).q)
