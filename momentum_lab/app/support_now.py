"""What supports the robot in one sample: the soles that press, their corners and the polygon they span."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
import pinocchio as pin

from momentum_lab.momentum.support import distance_to_edge, inset_rectangle, support_polygon
from momentum_lab.recording import Sample
from momentum_lab.robot.model import RobotModel
from momentum_lab.status import carrying_feet

# A standing foot that creeps by less than this many digits of a metre keeps its polygon.
_DIGITS = 6


def sole_placement(sample: Sample, foot: int) -> pin.SE3:
    """Where a sole frame is in the world."""
    return pin.XYZQUATToSE3(sample["sole_pose"][foot])


def polygon_of(sample: Sample, robot: RobotModel, border: float = 0.0) -> np.ndarray:
    """The support polygon of the feet that carry, without a border along the soles (K, 2), m; not to change.

    Args:
        sample: the sample.
        robot: whose soles they are.
        border: width of the border, m.
    """
    feet = carrying_feet(sample, robot.mass)
    poses = tuple(tuple(sample["sole_pose"][foot].round(_DIGITS).tolist()) for foot in feet)
    return _polygon(robot, feet, poses, border)


@lru_cache(maxsize=64)
def _polygon(
    robot: RobotModel, feet: tuple[int, ...], poses: tuple[tuple[float, ...], ...], border: float
) -> np.ndarray:
    """The polygon of some soles at some poses; standing feet are asked for it again and again."""
    corners = [
        _corners_in_world(pin.XYZQUATToSE3(np.array(pose)), robot, foot, border)
        for foot, pose in zip(feet, poses, strict=True)
    ]
    return support_polygon(np.concatenate(corners)) if corners else np.zeros((0, 2))


def extent(polygon: np.ndarray, direction: np.ndarray) -> tuple[float, float]:
    """Where a line through the middle of a polygon crosses its border, as coordinates along the line.

    Args:
        polygon: corners, counter-clockwise (K, 2), m.
        direction: unit vector of the line (2,).

    Returns:
        The lower and the upper coordinate, m; both NaN when nothing supports.
    """
    if len(polygon) < 3:
        return math.nan, math.nan
    middle = polygon.mean(axis=0)
    at = float(middle @ direction)
    return at - distance_to_edge(middle, -direction, polygon), at + distance_to_edge(
        middle, direction, polygon
    )


def _corners_in_world(placement: pin.SE3, robot: RobotModel, foot: int, border: float) -> np.ndarray:
    sole = robot.soles[foot]
    lower, upper = inset_rectangle(sole.lower, sole.upper, border)
    (rear, right), (front, left) = lower.tolist(), upper.tolist()
    corners = np.array([[rear, right, 0.0], [front, right, 0.0], [front, left, 0.0], [rear, left, 0.0]])
    return corners @ placement.rotation.T + placement.translation
