"""Points of the body that may hit the ground in a fall: few, convex, on every large part."""

from __future__ import annotations

import numpy as np

from momentum_lab.robot.catalog import Point
from momentum_lab.robot.proposal.body import Body
from momentum_lab.robot.proposal.solids import Solids, corners_of

FallPoints = dict[str, tuple[Point, ...]]
# How many points the parts get: pelvis and trunk, head, limbs.
_BIG, _HEAD, _LIMB = 7, 5, 3
# Two points closer than this say the same, m.
_CLOSE = 0.02


def find_fall_points(body: Body, solids: Solids) -> tuple[FallPoints, list[str]]:
    """Points for pelvis, trunk, head, thighs, shanks, upper arms, forearms and hands.

    Returns:
        link -> points in its frame, m; the links without shapes, whose points are joints instead.
    """
    points: FallPoints = {}
    bare = []
    for joint, count in _parts(body, solids).items():
        link = body.link(joint)
        surface = solids.of(joint, "visual", "collision")
        if not len(surface):
            surface = _joints_of(body, joint)
            bare.append(link)
        frame = body.model.frames[body.model.getFrameId(link)].placement
        chosen = (_spread(corners_of(surface), count) - frame.translation) @ frame.rotation
        points[link] = tuple((_mm(x), _mm(y), _mm(z)) for x, y, z in chosen)
    return points, bare


def _parts(body: Body, solids: Solids) -> dict[int, int]:
    """Joints whose shapes may hit the ground -> how many points they get."""
    parts = {body.pelvis: _BIG, body.trunk: _BIG}
    if body.head:
        parts[body.head[-1]] = _HEAD
    for leg in body.legs:
        inner = [joint for joint in leg.joints if joint != leg.joints[-1]]
        parts.update(dict.fromkeys(_largest(inner, solids, 2) or list(leg.pitch[:2]), _LIMB))
    for arm in body.arms:
        if arm:
            parts.update(dict.fromkeys([*(_largest(list(arm[:-1]), solids, 2)), arm[-1]], _LIMB))
            if not _largest(list(arm), solids, 1):
                parts[arm[len(arm) // 2]] = _LIMB
    return parts


def _largest(joints: list[int], solids: Solids, count: int) -> list[int]:
    """Those of the joints that have the largest shapes, in the order of the joints."""
    sizes = {j: float(np.linalg.norm(np.ptp(solids.of(j, "visual", "collision"), axis=0)))
             for j in joints if len(solids.of(j, "visual", "collision"))}  # fmt: skip
    chosen = sorted(sizes, key=lambda joint: -sizes[joint])[:count]
    return [joint for joint in joints if joint in chosen]


def _joints_of(body: Body, joint: int) -> np.ndarray:
    """A joint's own place and those of the joints it carries, in its axes (n, 3), m."""
    model = body.model
    ends = [model.jointPlacements[child].translation for child in model.children[joint]]
    return np.array([np.zeros(3), *ends])


def _spread(points: np.ndarray, count: int) -> np.ndarray:
    """Up to `count` of the points, each as far as possible from those chosen before."""
    distance = np.linalg.norm(points - points.mean(axis=0), axis=1)
    chosen: list[int] = []
    while len(chosen) < count:
        farthest = int(np.argmax(distance))
        if chosen and distance[farthest] < _CLOSE:
            break
        new = np.linalg.norm(points - points[farthest], axis=1)
        distance = np.minimum(distance, new) if chosen else new
        chosen.append(farthest)
    return points[chosen]


def _mm(length: float) -> float:
    return round(float(length), 3) + 0.0
