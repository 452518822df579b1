"""The sole of a foot: its lowest plane, a level frame in it, and the largest rectangle that rests on it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from scipy.spatial import ConvexHull, QhullError

from momentum_lab.errors import RobotError
from momentum_lab.robot.catalog import FootSpec, Point, Range
from momentum_lab.robot.proposal.body import Body
from momentum_lab.robot.proposal.solids import Kind, Solids
from momentum_lab.robot.proposal.srdf import Semantics

# Depths above the lowest point in which a sole is looked for, m: flat soles fill the first, arched ones a later.
_DEPTHS = (0.0015, 0.003, 0.006, 0.01, 0.015)
# A slice that covers this part of the foot's outline is its sole.
_ENOUGH = 0.5
# A frame that lies within this of the sole and its axes is taken for the sole frame, m and rad.
_NEAR, _ALIGNED = 0.006, 0.02
_GRID = 60
# A foot that is shorter or narrower is a point or a line, and a CoP cannot move in it, m.
_LEAST = 0.01
# Foot length, width and ankle height as parts of the leg from hip to ankle, and the part of the length behind
# the ankle (Winter's body proportions).
_LENGTH, _WIDTH, _HEIGHT, _BEHIND = 0.31, 0.112, 0.08, 0.25


@dataclass(frozen=True, slots=True)
class Sole:
    """A fitted sole.

    Attributes:
        spec: the foot as the robot's file describes it.
        source: where its rectangle comes from, in words.
        tilt: angle between the given frame and the level, forward-looking one, rad.
        drop: how far the sole lies below the given frame, m.
        estimated: whether the rectangle is a guess from body proportions.
    """

    spec: FootSpec
    source: str
    tilt: float
    drop: float
    estimated: bool


def fit_sole(body: Body, side: int, solids: Solids, semantics: Semantics) -> Sole:
    """The sole of the left (0) or right (1) foot, with all joints at zero.

    The given frame is kept if it lies in the sole with z up and x forward. Otherwise a frame is added to it.

    Raises:
        RobotError: the foot touches the ground in a point or a line.
    """
    frame = body.model.frames[body.soles[side]]
    given = body.data.oMf[body.soles[side]]
    level = body.axes.T @ given.rotation
    x, y, height, source, estimated = _rectangle(body, side, solids, semantics)
    if min(x[1] - x[0], y[1] - y[0]) < _LEAST:
        given_size = f"{frame.name}, {1e3 * (x[1] - x[0]):.0f} by {1e3 * (y[1] - y[0]):.0f} mm"
        raise RobotError(
            "soles", given_size, f"feet with soles of at least {1e3 * _LEAST:g} mm: no points, no lines"
        )
    drop = float(given.translation @ body.axes[:, 2]) - height
    tilt = float(np.linalg.norm(pin.log3(level)))
    joints = tuple(body.model.names[joint] for joint in body.legs[side].joints)
    if abs(drop) < _NEAR and tilt < _ALIGNED:
        spec = FootSpec(frame.name, x, y, joints)
    else:
        down = given.rotation.T @ (-drop * body.axes[:, 2])
        rpy = pin.rpy.matrixToRpy(level.T)
        spec = FootSpec(f"{frame.name}_sole", x, y, joints, frame.name, _triple(down, 4), _triple(rpy, 7))
    return Sole(spec, source, tilt, drop, estimated)


def largest_rectangle(points: np.ndarray) -> tuple[Range, Range]:
    """The largest rectangle along the axes inside the convex hull of points of the plane (n, 2), m.

    The hull's lower and upper border are convex and concave in x, so a rectangle fits if its ends do. In a point
    or a line it is one point.
    """
    try:
        hull = points[ConvexHull(points).vertices]
    except (QhullError, ValueError):
        x, y = points[0]
        return (float(x), float(x)), (float(y), float(y))
    xs = np.linspace(hull[:, 0].min(), hull[:, 0].max(), _GRID)
    low, high = _borders(hull, xs)
    width = np.minimum.outer(high, high) - np.maximum.outer(low, low)
    area = np.where(width > 0.0, width, 0.0) * (xs[None, :] - xs[:, None])
    rear, front = np.unravel_index(int(np.argmax(area)), area.shape)
    right, left = max(low[rear], low[front]), min(high[rear], high[front])
    return (float(xs[rear]), float(xs[front])), (float(right), float(left))


def _borders(hull: np.ndarray, xs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Smallest and largest y of a convex polygon (n, 2) at each x."""
    low, high = np.full(len(xs), np.inf), np.full(len(xs), -np.inf)
    for start, end in zip(hull, np.roll(hull, -1, axis=0), strict=True):
        (x0, y0), (x1, y1) = sorted((tuple(start), tuple(end)))
        inside = (xs >= x0 - 1e-12) & (xs <= x1 + 1e-12)
        upright = x1 - x0 < 1e-9
        for y in (y0, y1) if upright else (y0 + (xs[inside] - x0) / (x1 - x0) * (y1 - y0),):
            low[inside], high[inside] = np.minimum(low[inside], y), np.maximum(high[inside], y)
    return low, high


def _rectangle(
    body: Body, side: int, solids: Solids, semantics: Semantics
) -> tuple[Range, Range, float, str, bool]:
    """Rectangle relative to the given frame along forward and left, height of the plane, source, guess or not."""
    joint, given = body.feet[side], body.data.oMf[body.soles[side]]
    origin = given.translation @ body.axes
    kind = solids.kind_of(joint, "collision", "visual")
    if kind is not None:
        points = solids.of(joint, kind) @ body.data.oMi[joint].rotation.T + body.place(joint)
        return _from_shapes(points @ body.axes, origin, kind)
    return _without_shapes(body, side, origin, semantics)


def _from_shapes(points: np.ndarray, origin: np.ndarray, kind: Kind) -> tuple[Range, Range, float, str, bool]:
    lowest = float(points[:, 2].min())
    outline = _area(points)
    for depth in _DEPTHS:
        slice_ = _slice(points, lowest + depth)
        if _area(slice_) > _ENOUGH * outline:
            break
    x, y = largest_rectangle(slice_[:, :2] - origin[:2])
    source = (
        f"largest rectangle in the {kind} shape of the foot within {1e3 * depth:g} mm of its lowest point"
    )
    return _inwards(x), _inwards(y), lowest, source, False


def _without_shapes(
    body: Body, side: int, origin: np.ndarray, semantics: Semantics
) -> tuple[Range, Range, float, str, bool]:
    """The SRDF's foot, or one in proportion to the leg; a frame far below the ankle is taken to be in the sole."""
    ankle = body.place(body.feet[side]) @ body.axes
    foot = semantics.feet[side]
    if foot is not None:
        length, width, centre, height = foot
        x, y = (
            (centre[0] - length / 2, centre[0] + length / 2),
            (centre[1] - width / 2, centre[1] + width / 2),
        )
        source = f"no shapes in the URDF; size of the feet and place of the ankle from {semantics.file}"
        estimated = False
    else:
        leg = body.leg_length
        x, y = (
            (-_BEHIND * _LENGTH * leg, (1 - _BEHIND) * _LENGTH * leg),
            (-_WIDTH * leg / 2, _WIDTH * leg / 2),
        )
        height = _HEIGHT * leg
        source = "estimate: no shapes in the URDF; a human foot in proportion to the leg"
        estimated = True
        if ankle[2] - origin[2] > height / 2:
            height = ankle[2] - origin[2]
    shift = (ankle - origin)[:2]
    return (
        _inwards((x[0] + shift[0], x[1] + shift[0])),
        _inwards((y[0] + shift[1], y[1] + shift[1])),
        float(ankle[2] - height),
        source,
        estimated,
    )


def _slice(points: np.ndarray, height: float) -> np.ndarray:
    """Where the convex hull of points (n, 3) meets a level plane, and what lies below it (m, 2)."""
    low, high = points[points[:, 2] <= height], points[points[:, 2] > height]
    if not len(high):
        return low[:, :2]
    part = (height - low[:, None, 2]) / (high[None, :, 2] - low[:, None, 2])
    crossing = low[:, None, :2] + part[..., None] * (high[None, :, :2] - low[:, None, :2])
    return np.vstack([low[:, :2], crossing.reshape(-1, 2)])


def _area(points: np.ndarray) -> float:
    try:
        return float(ConvexHull(points[:, :2]).volume)
    except (QhullError, ValueError):
        return 0.0


def _inwards(edge: Range) -> Range:
    """Rounded to 1 mm, never outwards."""
    return float(np.ceil(1e3 * edge[0] - 1e-6) / 1e3), float(np.floor(1e3 * edge[1] + 1e-6) / 1e3)


def _triple(values: np.ndarray, digits: int) -> Point:
    x, y, z = (round(float(value), digits) + 0.0 for value in values)
    return x, y, z
