"""What the ground can give: the support polygon for the CoP, the friction cone for the force.

A polygon is an array of its corners (K, 2), m, convex and counter-clockwise, as `support_polygon` returns it.
Nothing on the ground is (0, 2), one contact point (1, 2), a line of contact (2, 2); these have no inside.
A contact force is (3,): two tangential components and the normal one, positive when the ground pushes.
"""

from __future__ import annotations

import math

import numpy as np

from momentum_lab.compiled import compiled
from momentum_lab.errors import InputError
from momentum_lab.momentum.polygon import closest_in_polygon, convex_hull, depth

Vertex = tuple[float, float]


def support_polygon(contact_points: np.ndarray) -> np.ndarray:
    """The region of the ground that the CoP cannot leave: the convex hull of the contact points.

    Args:
        contact_points: points in the world (N, 3), projected along z, or points of the plane (N, 2), m.

    Returns:
        The corners, counter-clockwise, points on edges left out (K, 2), m.
    """
    return convex_hull(np.array(contact_points[:, :2], dtype=float, order="C"))


def support_margin(point: np.ndarray, polygon: np.ndarray) -> float:
    """How far inside the polygon a point lies.

    Args:
        point: (2,), m.
        polygon: corners, counter-clockwise (K, 2), m.

    Returns:
        Distance to the nearest edge, m: positive inside, negative outside; minus infinity if nothing
        supports, NaN if the point is.
    """
    inside = depth(point, polygon)
    if inside > 0.0 or not len(polygon):
        return inside
    x, y = (point - closest_in_polygon(point, polygon)).tolist()
    return -math.hypot(x, y)


def nearest_in_polygon(point: np.ndarray, polygon: np.ndarray) -> np.ndarray:
    """The point of the polygon closest to a point: the point itself, if it is inside.

    Args:
        point: (2,), m.
        polygon: corners, counter-clockwise (K, 2), m.

    Returns:
        The closest point, edges included (2,), m; NaN if nothing supports or the point is NaN.
    """
    return closest_in_polygon(point, polygon)


def distance_to_edge(point: np.ndarray, direction: np.ndarray, polygon: np.ndarray) -> float:
    """How far one can go from a point in a direction before leaving the polygon.

    delta = min over the edges ahead of (distance to the edge) / (direction . outward normal).

    Args:
        point: (2,), m.
        direction: any length but zero (2,).
        polygon: corners, counter-clockwise (K, 2), m.

    Returns:
        Distance, m; 0 if the point is not inside.

    Raises:
        InputError: the direction has no length.
    """
    x, y = point.tolist()
    dx, dy = direction.tolist()
    length = math.hypot(dx, dy)
    if not length > 0.0:
        raise InputError("direction", direction, "a vector with a length above zero")
    if not depth(point, polygon) > 0.0:
        return 0.0
    reach = math.inf
    for (ax, ay), (bx, by) in _edges(polygon.tolist()):
        approach = dx * (by - ay) - dy * (bx - ax)
        if approach > 0.0:
            reach = min(reach, length * ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / approach)
    return reach


def inset_polygon(polygon: np.ndarray, inset: float) -> np.ndarray:
    """The part of a polygon that keeps a distance from all its edges: the safe area.

    {p : support_margin(p) >= inset}.

    Args:
        polygon: corners, counter-clockwise (K, 2), m.
        inset: distance from every edge, m.

    Returns:
        The smaller polygon's corners, counter-clockwise (L, 2), m; (0, 2) if nothing is left.

    Raises:
        InputError: the inset is negative or not a number.
    """
    if not inset >= 0.0:
        raise InputError("inset", inset, "0 m or more")
    if len(polygon) < 3:
        return np.zeros((0, 2))
    kept: list[Vertex] = [(x, y) for x, y in polygon.tolist()]
    for (ax, ay), (bx, by) in _edges(polygon.tolist()):
        length = math.hypot(bx - ax, by - ay)
        normal_x, normal_y = (ay - by) / length, (bx - ax) / length
        kept = _clip(kept, normal_x, normal_y, normal_x * ax + normal_y * ay + inset)
    return support_polygon(np.array(kept).reshape(-1, 2))


def inset_rectangle(lower: np.ndarray, upper: np.ndarray, inset: float) -> tuple[np.ndarray, np.ndarray]:
    """The safe area of one sole: its rectangle without a border.

    Args:
        lower: rear right corner in the sole frame (2,), m.
        upper: front left corner in the sole frame (2,), m.
        inset: width of the border, m.

    Returns:
        Lower and upper corner of what is left, each (2,), m.

    Raises:
        InputError: the inset is negative, not a number, or leaves nothing.
    """
    widest = 0.5 * float(np.min(upper - lower))
    if not 0.0 <= inset < widest:
        raise InputError("inset", inset, f"from 0 m to less than {widest:.4g} m, half of the narrow side")
    return lower + inset, upper - inset


def friction_margin(force: np.ndarray, friction: float) -> float:
    """How much more tangential force a contact could bear.

    mu f_n - |f_t|.

    Args:
        force: (f_x, f_y, f_n) in contact axes (3,), N.
        friction: mu.

    Returns:
        Newtons left before slipping; negative outside the friction cone.
    """
    fx, fy, fn = force.tolist()
    return friction * fn - math.hypot(fx, fy)


def in_friction_cone(force: np.ndarray, friction: float) -> bool:
    """Whether a contact can bear a force: it does not pull and does not slip.

    |f_t| <= mu f_n.

    Args:
        force: (f_x, f_y, f_n) in contact axes (3,), N.
        friction: mu.

    Returns:
        True inside the friction cone and on its surface.
    """
    return friction_margin(force, friction) >= 0.0


@compiled("f8[::1](f8[:], f8)")
def project_on_friction_cone(force: np.ndarray, friction: float) -> np.ndarray:
    """The force in the friction cone that is closest to a force (chapter, section 5.1.2).

    With t = |f_t|: f if t <= mu f_n; 0 if mu t <= -f_n; otherwise f_n' = (mu t + f_n) / (1 + mu^2) and
    f_t' = mu f_n' f_t / t.

    Args:
        force: (f_x, f_y, f_n) in contact axes (3,), N.
        friction: mu.

    Returns:
        The projected force (3,), N; its normal part is larger than before when it slipped.
    """
    fx, fy, fn = force
    tangential = math.hypot(fx, fy)
    if tangential <= friction * fn:
        return np.array((fx, fy, fn))
    if friction * tangential <= -fn:
        return np.zeros(3)
    normal = (friction * tangential + fn) / (1.0 + friction * friction)
    scale = friction * normal / tangential
    return np.array((scale * fx, scale * fy, normal))


@compiled("f8[::1](f8[:], f8)")
def clamp_tangential_force(force: np.ndarray, friction: float) -> np.ndarray:
    """The force in the friction cone with the same normal part, so that the vertical momentum is kept.

    f_n' = f_n, f_t' = f_t min(1, mu f_n / |f_t|); 0 if f_n < 0, since the ground does not pull.

    Args:
        force: (f_x, f_y, f_n) in contact axes (3,), N.
        friction: mu.

    Returns:
        The clamped force (3,), N.
    """
    fx, fy, fn = force
    if fn <= 0.0:
        return np.zeros(3)
    tangential, limit = math.hypot(fx, fy), friction * fn
    scale = 1.0 if tangential <= limit else limit / tangential
    return np.array((scale * fx, scale * fy, fn))


def friction_pyramid_edges(friction: float, count: int = 4) -> np.ndarray:
    """Edges of a pyramid inside the friction cone: f = sum rho_j beta_j with rho >= 0.

    beta_j = (mu cos theta_j, mu sin theta_j, 1), theta_j = 2 pi j / count (Lee and Goswami 2012).

    Args:
        friction: mu.
        count: number of edges.

    Returns:
        beta_j, one per row, in contact axes (count, 3).

    Raises:
        InputError: fewer than three edges.
    """
    if count < 3:
        raise InputError("count", count, "3 edges or more")
    angles = 2.0 * np.pi / count * np.arange(count)
    return np.column_stack((friction * np.cos(angles), friction * np.sin(angles), np.ones(count)))


def _edges(vertices: list[Vertex]) -> zip[tuple[Vertex, Vertex]]:
    return zip(vertices, vertices[1:] + vertices[:1], strict=True)


def _clip(vertices: list[Vertex], normal_x: float, normal_y: float, offset: float) -> list[Vertex]:
    """The part of a polygon where normal . p >= offset."""
    kept: list[Vertex] = []
    for (ax, ay), (bx, by) in _edges(vertices):
        start, end = normal_x * ax + normal_y * ay - offset, normal_x * bx + normal_y * by - offset
        if start >= 0.0:
            kept.append((ax, ay))
        if start * end < 0.0:
            along = start / (start - end)
            kept.append((ax + along * (bx - ax), ay + along * (by - ay)))
    return kept
