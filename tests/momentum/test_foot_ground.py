"""Plates under the feet: distances along their normals, and what they carry along."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from momentum_lab.momentum.foot_ground import (
    FootGround,
    acceleration_at,
    distance_above,
    height_below,
    velocity_at,
)
from tests.conftest import assert_close, random_rotation

STEP = 1e-4


def test_level_ground_is_still():
    ground = FootGround.level(2, 0.3)
    assert_close(ground.position, [[0.0, 0.0, 0.3]] * 2, 0.0)
    assert_close(ground.rotation, [np.eye(3)] * 2, 0.0)
    assert not ground.velocity.any()
    assert not ground.acceleration.any()
    assert ground.height == 0.3


def test_the_height_is_the_mean_of_the_plates():
    position = np.array([[0.0, 0.1, 0.2], [0.0, -0.1, -0.1]])
    assert FootGround.still(position, np.tile(np.eye(3), (2, 1, 1))).height == 0.05


def test_distance_and_height_of_a_known_point(rng):
    """A point built from coordinates in the plate, and the foot of a vertical on it."""
    rotation, origin = random_rotation(rng), rng.normal(size=3)
    point = origin + rotation @ [0.3, -0.2, 0.07]
    assert abs(distance_above(origin, rotation, point) - 0.07) < 1e-14
    on_it = origin + rotation @ [0.3, -0.2, 0.0]
    assert abs(height_below(origin, rotation, on_it[0], on_it[1]) - on_it[2]) < 1e-13


def test_a_carried_frame_moves_as_its_plate_does(rng):
    """Against finite differences of a plate that flies and tumbles: exp(t w + t^2 a / 2) about a parabola."""
    origin, velocity, acceleration = rng.normal(size=3), rng.normal(size=6), rng.normal(size=6)
    fixed = rng.normal(size=3)

    def at(t: float) -> np.ndarray:
        turn = pin.exp3(t * velocity[3:] + 0.5 * t**2 * acceleration[3:])
        return origin + t * velocity[:3] + 0.5 * t**2 * acceleration[:3] + turn @ fixed

    point = at(0.0)
    speed = (at(STEP) - at(-STEP)) / (2 * STEP)
    change = (at(STEP) - 2 * at(0.0) + at(-STEP)) / STEP**2
    assert_close(velocity_at(point, origin, velocity)[:3], speed, 1e-6)
    assert_close(acceleration_at(point, origin, velocity, acceleration)[:3], change, 1e-5)
    assert_close(velocity_at(point, origin, velocity)[3:], velocity[3:], 0.0)
    assert_close(acceleration_at(point, origin, velocity, acceleration)[3:], acceleration[3:], 0.0)
