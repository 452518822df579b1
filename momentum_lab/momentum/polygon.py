"""Plane geometry that every tick needs: the hull of some points, and the point of a polygon nearest to one."""

from __future__ import annotations

import math

import numpy as np

from momentum_lab.compiled import compiled

_POINTS, _POINT = "f8[:, ::1]", "f8[::1]"

_SAME = 1e-9
"""Points whose x differs by less than this are in one column, m."""

_FLAT = 1e-12
"""A corner that spans less than this area with its neighbours is no corner, m^2."""


@compiled(f"f8({_POINT}, {_POINT}, {_POINT})")
def turn(start: np.ndarray, corner: np.ndarray, end: np.ndarray) -> float:
    """Twice the area of a triangle of points (2,), positive if it is counter-clockwise, m^2."""
    return (corner[0] - start[0]) * (end[1] - start[1]) - (corner[1] - start[1]) * (end[0] - start[0])


@compiled(f"void({_POINTS})")
def sort_points(points: np.ndarray) -> None:
    """Put points (N, 2) into the order of x, then of y, in place."""
    for i in range(1, len(points)):
        x, y = points[i]
        place = i
        while place > 0 and (
            points[place - 1, 0] > x or (points[place - 1, 0] == x and points[place - 1, 1] > y)
        ):
            points[place] = points[place - 1]
            place -= 1
        points[place] = (x, y)


@compiled(f"void({_POINTS})")
def align_columns(points: np.ndarray) -> None:
    """Give sorted points (N, 2) one x where it differs by rounding alone, and sort them again, in place.

    Otherwise rounding would decide the order along a column, and the hull would turn back and lose a corner.
    """
    for i in range(1, len(points)):
        if points[i, 0] - points[i - 1, 0] < _SAME:
            points[i, 0] = points[i - 1, 0]
    sort_points(points)


@compiled(f"{_POINTS}({_POINTS})")
def convex_hull(points: np.ndarray) -> np.ndarray:
    """Corners of the convex hull (K, 2), counter-clockwise, by a monotone chain.

    Args:
        points: (N, 2), m; they are sorted in place.

    Returns:
        Every point once, at least one fewer than three where all lie on a line.
    """
    sort_points(points)
    align_columns(points)
    count = len(points)
    if count < 2:
        return points.copy()
    hull, size = np.empty((2 * count, 2)), 0
    for way in range(2):
        first = size
        for i in range(count):
            point = points[i] if way == 0 else points[count - 1 - i]
            while size - first > 1 and not turn(hull[size - 2], hull[size - 1], point) > _FLAT:
                size -= 1
            if size == first or hull[size - 1, 0] != point[0] or hull[size - 1, 1] != point[1]:
                hull[size] = point
                size += 1
        size -= 1  # where one way ends, the other begins
    return hull[: max(size, 1)].copy()


@compiled(f"f8({_POINT}, {_POINTS})")
def depth(point: np.ndarray, polygon: np.ndarray) -> float:
    """Distance from the nearest edge line, m, negative beyond one; minus infinity without an inside."""
    count = len(polygon)
    if point.size != 2:
        raise ValueError("a point of the plane has two coordinates")
    if count < 3:
        return -math.inf
    least = math.inf
    for i in range(count):
        start, end = polygon[i], polygon[(i + 1) % count]
        distance = turn(start, end, point) / math.hypot(end[0] - start[0], end[1] - start[1])
        if not distance >= least:
            least = distance
    return least


@compiled(f"{_POINT}({_POINT}, {_POINTS})")
def closest_in_polygon(point: np.ndarray, polygon: np.ndarray) -> np.ndarray:
    """The point of a polygon (K, 2) closest to a point (2,); NaN if the polygon is empty or the point NaN."""
    if depth(point, polygon) >= 0.0:
        return point.copy()
    closest, shortest = np.full(2, math.nan), math.inf
    count = len(polygon)
    for i in range(count):
        start, end = polygon[i], polygon[(i + 1) % count]
        dx, dy = end[0] - start[0], end[1] - start[1]
        length_squared = dx * dx + dy * dy
        along = 0.0
        if length_squared > 0.0:
            along = ((point[0] - start[0]) * dx + (point[1] - start[1]) * dy) / length_squared
        along = min(max(along, 0.0), 1.0)
        x, y = start[0] + along * dx, start[1] + along * dy
        distance_squared = (point[0] - x) ** 2 + (point[1] - y) ** 2
        if distance_squared < shortest:
            closest[0], closest[1], shortest = x, y, distance_squared
    return closest
