"""Planes under the feet and under everything else."""

from __future__ import annotations

import numpy as np

from momentum_lab.physics.ground import Ground, Patch
from tests.conftest import assert_close, random_rotation


def test_the_gap_is_the_distance_along_the_normal(rng):
    """Points built from a known height over a tilted plane."""
    rotation, origin = random_rotation(rng), rng.normal(size=3)
    heights = rng.normal(size=7)
    along = rng.normal(size=(7, 2))
    points = origin + along @ rotation[:, :2].T + np.outer(heights, rotation[:, 2])
    assert_close(Patch(0.5, origin, rotation).gap(points), heights, 1e-12)


def test_level_ground_measures_height():
    ground = Ground.level(2, 0.6, height=0.3)
    assert len(ground.under_feet) == 2
    for plane in (*ground.under_feet, ground.floor):
        assert plane.friction == 0.6
        assert_close(plane.gap(np.array([[5.0, -3.0, 0.5], [0.0, 0.0, 0.1]])), [0.2, -0.2], 1e-15)


def test_ground_at_rest_is_the_same_at_all_times():
    ground = Ground.level(2, 0.6, height=0.3)
    assert ground.at(0.0) is ground.at(7.0)
    assert ground.at(0.0).height == 0.3
    assert ground.friction(3.0).tolist() == [0.6, 0.6]
