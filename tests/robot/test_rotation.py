"""Quaternions and rotation vectors against Pinocchio's."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.robot.rotation import quaternion_of, rotation_error
from tests.conftest import assert_close, random_rotation


def turned(axis: int, angle: float) -> np.ndarray:
    return pin.exp3(angle * np.eye(3)[axis])


ANGLES = [0.0, 1e-12, 1e-6, 0.3, 2.0, 3.0, np.pi - 1e-6]


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("angle", [*ANGLES, np.pi])
def test_quaternions_of_turns_about_each_axis(axis, angle):
    """From the trace below two thirds of a turn, from the largest of x, y, z beyond."""
    expected = np.append(np.sin(0.5 * angle) * np.eye(3)[axis], np.cos(0.5 * angle))
    assert_close(quaternion_of(turned(axis, angle)), expected, 1e-12)


def test_quaternions_of_any_rotation(rng):
    """The same rotation as Pinocchio's, which may have the other sign."""
    for _ in range(200):
        rotation = random_rotation(rng)
        quaternion = quaternion_of(rotation)
        assert_close(pin.Quaternion(quaternion).toRotationMatrix(), rotation, 1e-12)
        assert np.linalg.norm(quaternion) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("angle", ANGLES)
def test_the_error_is_the_logarithm(axis, angle, rng):
    desired = random_rotation(rng)
    assert_close(rotation_error(turned(axis, angle) @ desired, desired), angle * np.eye(3)[axis], 1e-9)


def test_the_error_of_any_two_rotations(rng):
    for _ in range(200):
        rotation, desired = random_rotation(rng), random_rotation(rng)
        assert_close(rotation_error(rotation, desired), pin.log3(rotation @ desired.T), 1e-8)


def test_nan_stays_nan():
    assert np.isnan(rotation_error(np.full((3, 3), np.nan), np.eye(3))).all()
