"""Plane geometry against scipy's hull and against brute force over the edges."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from momentum_lab.momentum.polygon import closest_in_polygon, convex_hull, depth, turn
from tests.conftest import assert_close

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def area(polygon: np.ndarray) -> float:
    return 0.5 * float(sum(turn(polygon[0], a, b) for a, b in pairwise(polygon[1:])))


@pytest.mark.parametrize("count", [3, 4, 8, 40])
def test_the_hull_has_the_corners_and_the_area_that_qhull_finds(rng, count):
    for _ in range(50):
        points = rng.uniform(-0.3, 0.3, (count, 2))
        expected = ConvexHull(points)
        hull = convex_hull(points.copy())
        assert {tuple(corner) for corner in hull} == {tuple(points[i]) for i in expected.vertices}
        assert area(hull) == pytest.approx(expected.volume, rel=1e-9)


def test_two_rectangles_of_feet_side_by_side_keep_their_outer_corners_alone():
    """Columns that differ by rounding, as those of soles do."""
    right = 0.2 * SQUARE + [1e-17, -0.4]
    hull = convex_hull(np.concatenate([0.2 * SQUARE, right]))
    assert len(hull) == 4
    assert area(hull) == pytest.approx(0.2 * 0.6)


def test_the_depth_in_a_square_is_the_way_to_its_nearest_side(rng):
    for x, y in rng.uniform(-0.5, 1.5, (200, 2)):
        assert depth(np.array([x, y]), SQUARE) == pytest.approx(min(x, 1.0 - x, y, 1.0 - y), abs=1e-12)


def test_the_closest_point_is_no_farther_than_any_of_the_polygon(rng):
    """Inside: the point itself. Outside: a point of the border, and ten thousand others are farther away."""
    along = np.linspace(0.0, 1.0, 2000)[:, None]
    for _ in range(40):
        polygon = convex_hull(rng.uniform(-1.0, 1.0, (8, 2)))
        point = rng.uniform(-2.0, 2.0, 2)
        closest = closest_in_polygon(point, polygon)
        if depth(point, polygon) >= 0.0:
            assert_close(closest, point, 0.0)
            continue
        border = np.concatenate(
            [a + along * (b - a) for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True)]
        )
        nearest = np.linalg.norm(border - point, axis=1).min()
        assert np.linalg.norm(closest - point) == pytest.approx(nearest, abs=1e-5)
        assert np.linalg.norm(closest - point) <= nearest + 1e-12
        assert abs(depth(closest, polygon)) < 1e-9


def test_a_line_and_nothing_have_no_inside():
    line = convex_hull(np.array([[0.0, 0.0], [2.0, 0.0], [1.0, 0.0]]))
    assert depth(np.array([1.0, 0.0]), line) == -np.inf
    assert_close(closest_in_polygon(np.array([1.5, 1.0]), line), np.array([1.5, 0.0]), 1e-12)
    assert np.isnan(closest_in_polygon(np.zeros(2), np.empty((0, 2)))).all()
