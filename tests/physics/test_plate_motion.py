"""Courses of moving plates: velocities and accelerations are derivatives, and nothing ever jerks."""

from __future__ import annotations

import math

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.errors import InputError
from momentum_lab.physics.ground import Ground, Patch
from momentum_lab.physics.plate import FrictionChange, PlateMotion
from tests.conftest import assert_close, random_rotation, yaw_rotation

STEP = 1e-5
TIMES = (0.4, 0.9, 1.7, 2.6, 4.1, 5.3, 6.5)
EVERY_AXIS = (
    PlateMotion("x", 0.05),
    PlateMotion("y", -0.03, period=1.3, start=0.2),
    PlateMotion("z", 0.04, "step", period=2.0, start=0.8),
    PlateMotion("roll", 5.0, period=1.7, stop=6.0),
    PlateMotion("pitch", -7.0, "step", period=3.0),
)


def moving(rng, *motions: PlateMotion, facing: np.ndarray | None = None) -> Ground:
    patches = tuple(Patch(0.7, rng.normal(size=3), random_rotation(rng)) for _ in range(2))
    return Ground(patches, Patch(0.7), facing, tuple((1, motion) for motion in motions))


def test_velocity_and_acceleration_are_derivatives_of_the_pose(rng):
    ground = moving(rng, *EVERY_AXIS, facing=yaw_rotation(0.7))
    for time in TIMES:
        now, ahead, behind = ground.at(time), ground.at(time + STEP), ground.at(time - STEP)
        speed = (ahead.position - behind.position) / (2 * STEP)
        change = (ahead.velocity - behind.velocity) / (2 * STEP)
        assert_close(now.velocity[:, :3], speed, 1e-8)
        assert_close(now.acceleration, change, 1e-7)
        turned = pin.log3(ahead.rotation[1] @ behind.rotation[1].T) / (2 * STEP)
        assert_close(now.velocity[1, 3:], turned, 1e-8)
        assert_close(now.rotation[1].T @ now.rotation[1], np.eye(3), 1e-14)


def test_the_other_foot_stays_where_it_is(rng):
    ground = moving(rng, *EVERY_AXIS)
    for time in TIMES:
        assert_close(ground.at(time).position[0], ground.under_feet[0].origin, 0.0)
        assert not ground.at(time).velocity[0].any()


def test_nothing_jerks(rng):
    """From tick to tick the acceleration changes by no more than its largest slope, at starts and stops too."""
    ground = moving(rng, *EVERY_AXIS)
    times = np.arange(0.0, 8.0, 1e-3)
    acceleration = np.array([ground.at(t).acceleration[1] for t in times])
    assert np.abs(np.diff(acceleration, axis=0)).max() < 0.02 * np.abs(acceleration).max()
    assert not ground.at(0.15).velocity.any()
    assert not ground.at(6.5).velocity[1, 3:].any()


def test_amplitudes_are_reached(rng):
    """A sine goes to both sides by its amplitude, a step ends at it; x is where the scenario faces."""
    facing = yaw_rotation(math.pi / 2)
    patch = Patch(0.7)
    ground = Ground(
        (patch,), patch, facing, ((0, PlateMotion("x", 0.05)), (0, PlateMotion("z", 0.02, "step", 1.0)))
    )
    way = np.array([ground.at(t).position[0] for t in np.arange(3.0, 9.0, 1e-3)])
    assert_close([way[:, 1].min(), way[:, 1].max()], [-0.05, 0.05], 1e-6)
    assert_close(way[:, 2], np.full(len(way), 0.02), 1e-15)
    assert_close(way[:, 0], np.zeros(len(way)), 1e-15)


def test_positive_roll_lifts_the_left_and_positive_pitch_lowers_the_front():
    patch = Patch(0.7)
    for motion, ahead in (
        (PlateMotion("roll", 5.0, "step"), [0, 1, 0]),
        (PlateMotion("pitch", -5.0, "step"), [1, 0, 0]),
    ):
        rotation = Ground((patch,), patch, None, ((0, motion),)).at(9.0).rotation[0]
        assert (rotation @ ahead)[2] == pytest.approx(math.sin(math.radians(5.0)))


def test_coming_to_rest_takes_a_period():
    patch = Patch(0.7)
    ground = Ground(
        (patch,), patch, None, ((0, PlateMotion("x", 0.05)), (0, PlateMotion("y", 0.05, start=9.0)))
    )
    resting = ground.coming_to_rest(5.0)
    assert_close(resting.at(4.9).position, ground.at(4.9).position, 0.0)
    assert abs(resting.at(6.0).velocity[0, 0]) > 1e-3
    assert_close(resting.at(7.01).position[0], np.zeros(3), 1e-15)
    assert not resting.at(12.0).velocity.any()


def test_friction_changes_when_it_is_to():
    ground = Ground(
        (Patch(0.7), Patch(0.6)),
        Patch(0.7),
        None,
        (),
        ((1, FrictionChange(0.2, 1.0)), (1, FrictionChange(0.4, 0.5))),
    )
    assert ground.friction(0.4).tolist() == [0.7, 0.6]
    assert ground.friction(0.5).tolist() == [0.7, 0.4]
    assert ground.friction(1.0).tolist() == [0.7, 0.2]
    assert ground.as_slippery_as(0.9, (0, 1), 2.0).friction(2.0).tolist() == [0.9, 0.9]


@pytest.mark.parametrize(
    ("motion", "named"),
    [
        (PlateMotion("x", 0.5), "amplitude"),
        (PlateMotion("roll", 16.0), "amplitude"),
        (PlateMotion("pitch", float("nan")), "amplitude"),
        (PlateMotion("x", 0.1, period=0.0), "period"),
        (PlateMotion("x", 0.1, period=float("nan")), "period"),
    ],
)
def test_what_goes_too_far_is_refused(motion, named):
    with pytest.raises(InputError, match=named):
        Ground((Patch(0.7),), Patch(0.7), None, ((0, motion),))
