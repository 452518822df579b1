"""Support polygon and friction cone against other algorithms and against what defines them."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
from scipy.spatial import ConvexHull

from momentum_lab.errors import InputError
from momentum_lab.momentum.support import (
    clamp_tangential_force,
    distance_to_edge,
    friction_margin,
    friction_pyramid_edges,
    in_friction_cone,
    inset_polygon,
    inset_rectangle,
    nearest_in_polygon,
    project_on_friction_cone,
    support_margin,
    support_polygon,
)
from tests.conftest import assert_close, yaw_rotation

SQUARE = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
NOTHING, ONE_POINT, LINE = np.zeros((0, 2)), np.array([[0.3, 0.1]]), np.array([[0.0, 0.0], [1.0, 0.0]])


@pytest.fixture
def polygons(rng) -> list[np.ndarray]:
    return [support_polygon(rng.normal(scale=0.2, size=(8, 2))) for _ in range(50)]


def test_polygon_is_scipys_convex_hull(rng):
    for count in (3, 4, 8, 40):
        points = rng.normal(size=(count, 2))
        expected = points[ConvexHull(points).vertices]
        polygon = support_polygon(points)
        start = int(np.argmin(np.linalg.norm(polygon - expected[0], axis=1)))
        assert_close(np.roll(polygon, -start, axis=0), expected, 0.0)


def test_polygon_of_two_feet_leaves_out_points_on_its_edges():
    foot = np.array([[-0.1, -0.05, 0.0], [0.1, -0.05, 0.01], [0.1, 0.05, 0.0], [-0.1, 0.05, 0.02]])
    aside = np.array([0.0, 0.1, 0.0])
    polygon = support_polygon(np.vstack((foot + aside, foot - aside)))
    assert_close(polygon, [[-0.1, -0.15], [0.1, -0.15], [0.1, 0.15], [-0.1, 0.15]], 1e-15)


def test_polygon_ignores_the_rounding_of_points_that_coincide(rng):
    noisy = np.vstack([SQUARE + rng.uniform(-1e-16, 1e-16, SQUARE.shape) for _ in range(5)])
    assert_close(support_polygon(noisy), SQUARE, 1e-15)


def test_two_feet_that_are_aligned_but_for_rounding_keep_all_their_corners(rng):
    """Corners of both heels have the same x, as far as a machine can tell."""
    feet = np.array([[x, y + s] for s in (0.085, -0.085) for x in (-0.1, 0.091) for y in (-0.06, 0.06)])
    for _ in range(200):
        polygon = support_polygon(feet + rng.normal(scale=1e-16, size=feet.shape))
        assert len(polygon) == 4
        assert support_margin(np.array([-0.0045, 0.0]), polygon) == pytest.approx(0.0955, abs=1e-9)


def test_polygon_of_degenerate_contacts():
    assert support_polygon(np.zeros((0, 3))).shape == (0, 2)
    assert_close(support_polygon(np.array([[0.3, 0.1, 0.0]] * 4)), ONE_POINT, 0.0)
    assert_close(support_polygon(np.array([[1.0, 0.0], [0.5, 0.0], [0.0, 0.0]])), LINE, 0.0)


def test_margin_inside_is_the_distance_to_the_nearest_edge(polygons, rng):
    """Scipy's hull knows its edges as n.p + b <= 0 with unit normals."""
    for polygon in polygons:
        point = rng.dirichlet(np.ones(len(polygon))) @ polygon
        equations = ConvexHull(polygon).equations
        expected = -np.max(equations[:, :2] @ point + equations[:, 2])
        assert support_margin(point, polygon) == pytest.approx(expected, abs=1e-12)


def test_nearest_point_satisfies_the_condition_of_a_projection(polygons, rng):
    """(point - nearest) makes no acute angle with any way into the polygon."""
    for polygon in polygons:
        point = rng.normal(size=2)
        nearest = nearest_in_polygon(point, polygon)
        assert np.max((polygon - nearest) @ (point - nearest)) <= 1e-12
        assert support_margin(nearest, polygon) >= -1e-12


def test_margin_outside_is_minus_the_distance_to_the_nearest_point(polygons, rng):
    for polygon in polygons:
        point = polygon.mean(axis=0) + 2.0 * yaw_rotation(rng.uniform(0.0, 6.0))[:2, 0]
        distance = np.linalg.norm(point - nearest_in_polygon(point, polygon))
        assert support_margin(point, polygon) == pytest.approx(-distance, abs=1e-12)
        assert distance > 0.1


def test_points_inside_stay(polygons):
    for polygon in polygons:
        centre = polygon.mean(axis=0)
        assert_close(nearest_in_polygon(centre, polygon), centre, 0.0)


@pytest.mark.parametrize(
    ("point", "margin"),
    [((0.0, 0.0), 1.0), ((0.9, 0.2), 0.1), ((1.0, 0.0), 0.0), ((1.5, 0.0), -0.5), ((4.0, 5.0), -5.0)],
)
def test_margin_of_a_square(point, margin):
    assert support_margin(np.array(point), SQUARE) == pytest.approx(margin, abs=1e-15)


def test_a_polygon_without_an_inside_has_no_positive_margin():
    point = np.array([0.3, 0.5])
    assert support_margin(point, NOTHING) == -np.inf
    assert support_margin(point, ONE_POINT) == pytest.approx(-0.4, abs=1e-15)
    assert support_margin(point, LINE) == pytest.approx(-0.5, abs=1e-15)
    assert support_margin(np.array([2.0, 0.0]), LINE) == pytest.approx(-1.0, abs=1e-15)
    assert support_margin(np.array([0.5, 0.0]), LINE) == 0.0


def test_nearest_point_of_a_polygon_without_an_inside():
    point = np.array([0.3, 0.5])
    assert np.isnan(nearest_in_polygon(point, NOTHING)).all()
    assert_close(nearest_in_polygon(point, ONE_POINT), ONE_POINT[0], 0.0)
    assert_close(nearest_in_polygon(point, LINE), [0.3, 0.0], 0.0)


def test_a_cop_that_does_not_exist_has_no_margin():
    nowhere = np.array([np.nan, np.nan])
    assert np.isnan(support_margin(nowhere, SQUARE))
    assert np.isnan(nearest_in_polygon(nowhere, SQUARE)).all()
    assert distance_to_edge(nowhere, np.array([1.0, 0.0]), SQUARE) == 0.0


def test_way_to_the_edge_ends_on_the_edge(polygons, rng):
    for polygon in polygons:
        start = rng.dirichlet(np.ones(len(polygon))) @ polygon
        angle = rng.uniform(0.0, 2.0 * np.pi)
        direction = np.array([np.cos(angle), np.sin(angle)])
        distance = distance_to_edge(start, 0.01 * direction, polygon)
        assert support_margin(start + distance * direction, polygon) == pytest.approx(0.0, abs=1e-12)
        assert support_margin(start + 0.99 * distance * direction, polygon) > 0.0
        assert distance > 0.0


def test_there_is_no_way_to_the_edge_from_outside():
    forward = np.array([1.0, 0.0])
    assert distance_to_edge(np.array([-3.0, 0.0]), forward, SQUARE) == 0.0
    assert distance_to_edge(np.array([0.5, 0.0]), forward, LINE) == 0.0
    assert distance_to_edge(np.array([0.5, 0.0]), forward, NOTHING) == 0.0


@pytest.mark.parametrize("direction", [(0.0, 0.0), (float("nan"), 1.0)])
def test_way_to_the_edge_needs_a_direction(direction):
    with pytest.raises(
        InputError, match=r"^direction: got \[.*\]; allowed: a vector with a length above zero$"
    ):
        distance_to_edge(np.zeros(2), np.array(direction), SQUARE)


def test_inset_polygon_holds_exactly_the_points_with_that_margin(polygons, rng):
    for polygon in polygons:
        safe = inset_polygon(polygon, 0.02)
        for corner in safe:
            assert support_margin(corner, polygon) == pytest.approx(0.02, abs=1e-12)
        for point in rng.dirichlet(np.ones(len(polygon)), size=20) @ polygon:
            assert (support_margin(point, safe) > 0.0) == (support_margin(point, polygon) > 0.02)


def test_inset_of_nothing_changes_nothing():
    assert_close(inset_polygon(SQUARE, 0.0), SQUARE, 1e-15)


def test_inset_can_leave_nothing():
    assert inset_polygon(SQUARE, 1.01).shape == (0, 2)
    assert inset_polygon(LINE, 0.001).shape == (0, 2)
    assert inset_polygon(NOTHING, 0.001).shape == (0, 2)


@pytest.mark.parametrize("inset", [-0.001, float("nan")])
def test_inset_must_not_be_negative(inset):
    with pytest.raises(InputError, match=r"^inset: got .*; allowed: 0 m or more$"):
        inset_polygon(SQUARE, inset)


def test_inset_rectangle_is_the_inset_polygon_of_the_sole(robot):
    for sole in robot.soles:
        lower, upper = inset_rectangle(sole.lower, sole.upper, 0.005)
        safe = inset_polygon(support_polygon(sole.corners), 0.005)
        assert_close(safe.min(axis=0), lower, 1e-15)
        assert_close(safe.max(axis=0), upper, 1e-15)


@pytest.mark.parametrize("inset", [-0.001, 0.025, float("nan")])
def test_inset_rectangle_must_leave_something(inset):
    with pytest.raises(InputError, match=r"^inset: got .*; allowed: from 0 m to less than 0.025 m, half"):
        inset_rectangle(np.array([-0.05, -0.025]), np.array([0.12, 0.025]), inset)


def test_polygon_moves_and_turns_with_its_points(polygons, rng):
    turn, shift = yaw_rotation(np.deg2rad(137.0))[:2, :2], np.array([100.0, -30.0])
    for polygon in polygons[:10]:
        point, direction = rng.normal(scale=0.2, size=(2, 2))
        moved = support_polygon(polygon @ turn.T + shift)
        moved_point = turn @ point + shift
        assert support_margin(moved_point, moved) == pytest.approx(support_margin(point, polygon), abs=1e-9)
        assert_close(
            nearest_in_polygon(moved_point, moved), turn @ nearest_in_polygon(point, polygon) + shift, 1e-9
        )
        distance = distance_to_edge(moved_point, turn @ direction, moved)
        assert distance == pytest.approx(distance_to_edge(point, direction, polygon), abs=1e-9)


@pytest.mark.parametrize("friction", [0.1, 0.7, 1.5])
def test_projection_on_the_cone_is_pinocchios(friction, rng):
    cone = pin.CoulombFrictionCone(friction)
    for force in rng.normal(scale=100.0, size=(200, 3)):
        assert_close(project_on_friction_cone(force, friction), cone.project(force), 1e-9)


def test_projection_is_closest_in_the_cone(rng):
    """f - f' is normal to f' and makes no acute angle with any force in the cone."""
    edges = friction_pyramid_edges(0.7, 64)
    for force in rng.normal(scale=100.0, size=(100, 3)):
        projected = project_on_friction_cone(force, 0.7)
        assert (force - projected) @ projected == pytest.approx(0.0, abs=1e-9)
        assert np.max(edges @ (force - projected)) <= 1e-9
        assert friction_margin(projected, 0.7) >= -1e-9


def test_projection_leaves_forces_in_the_cone_alone(rng):
    for force in rng.uniform(0.0, 1.0, (50, 4)) @ friction_pyramid_edges(0.7):
        assert in_friction_cone(force, 0.7 + 1e-12)
        assert_close(project_on_friction_cone(force, 0.7), force, 1e-12)
        assert_close(clamp_tangential_force(force, 0.7), force, 1e-12)


@pytest.mark.parametrize(
    ("force", "inside"),
    [
        ((0.0, 0.0, 0.0), True),
        ((0.0, 0.0, 1.0), True),
        ((3.0, 4.0, 10.0), True),
        ((3.0, 4.1, 10.0), False),
        ((0.0, 0.0, -1.0), False),
        ((float("nan"), 0.0, 1.0), False),
    ],
)
def test_friction_cone(force, inside):
    assert in_friction_cone(np.array(force), 0.5) is inside


def test_friction_margin_counts_newtons():
    assert friction_margin(np.array([3.0, 4.0, 20.0]), 0.5) == pytest.approx(5.0, abs=1e-15)


def test_clamp_keeps_normal_force_and_direction(rng):
    for force in rng.normal(scale=100.0, size=(100, 3)) * [5.0, 5.0, 1.0]:
        clamped = clamp_tangential_force(force, 0.7)
        assert clamped[2] == pytest.approx(max(force[2], 0.0), abs=1e-12)
        assert friction_margin(clamped, 0.7) >= -1e-9
        assert clamped[0] * force[1] == pytest.approx(clamped[1] * force[0], abs=1e-6)
        assert clamped[:2] @ force[:2] >= 0.0


def test_projection_trades_normal_force_for_slip_and_clamp_does_not():
    slipping = np.array([100.0, 0.0, 100.0])
    assert project_on_friction_cone(slipping, 0.5)[2] > 100.0
    assert_close(clamp_tangential_force(slipping, 0.5), [50.0, 0.0, 100.0], 1e-12)


@pytest.mark.parametrize("count", [3, 4, 8])
def test_pyramid_edges_lie_on_the_cone(count):
    edges = friction_pyramid_edges(0.7, count)
    assert edges.shape == (count, 3)
    assert_close([friction_margin(edge, 0.7) for edge in edges], np.zeros(count), 1e-12)
    assert_close(edges.sum(axis=0), [0.0, 0.0, count], 1e-12)


def test_pyramid_needs_three_edges():
    with pytest.raises(InputError, match=r"^count: got 2; allowed: 3 edges or more$"):
        friction_pyramid_edges(0.7, 2)
