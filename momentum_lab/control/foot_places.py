"""Where the stance feet are, seen from the CoM, and which of them are near the ground."""

from __future__ import annotations

import numpy as np

from momentum_lab.compiled import compiled
from momentum_lab.momentum.foot_ground import distance_above
from momentum_lab.momentum.polygon import convex_hull

_MATRIX, _VECTOR, _STACK = "f8[:, ::1]", "f8[::1]", "f8[:, :, ::1]"


@compiled(
    f"Tuple(({_MATRIX}, {_MATRIX}, {_STACK}, {_MATRIX}, f8))"
    f"(i8[::1], {_MATRIX}, {_STACK}, {_VECTOR}, {_MATRIX}, {_STACK})"
)
def placed_feet(
    stance: np.ndarray,
    position: np.ndarray,
    rotation: np.ndarray,
    com: np.ndarray,
    ankles: np.ndarray,
    corners: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, float]:
    """Where the stance feet are, seen from the CoM.

    Args:
        stance: indices of the stance feet (S,).
        position: all sole origins in the world (F, 3), m.
        rotation: axes of all soles in the world (F, 3, 3).
        com: r_G (3,), m.
        ankles: the stance feet's ankles in the sole frames (S, 3), m.
        corners: corners of their safe rectangles in the sole frames (S, 4, 2), m.

    Returns:
        From the CoM to the soles and to the ankles (S, 3), axes (S, 3, 3), convex hull of the safe corners in the
        world, seen from above (K, 2), mean height of the soles, m.
    """
    count = len(stance)
    to_sole, to_ankle, axes = np.empty((count, 3)), np.empty((count, 3)), np.empty((count, 3, 3))
    placed, height = np.empty((4 * count, 2)), 0.0
    for place, foot in enumerate(stance):
        turn = rotation[foot]
        axes[place] = turn
        to_sole[place] = position[foot] - com
        to_ankle[place] = to_sole[place] + turn @ ankles[place]
        height += position[foot, 2] / count
        for corner in range(4):
            x, y = corners[place, corner]
            for i in range(2):
                placed[4 * place + corner, i] = position[foot, i] + turn[i, 0] * x + turn[i, 1] * y
    return to_sole, to_ankle, axes, convex_hull(placed), height


@compiled(f"b1[::1]({_MATRIX}, {_STACK}, {_MATRIX}, {_MATRIX}, {_MATRIX}, {_STACK}, f8)")
def near_the_ground(
    position: np.ndarray,
    rotation: np.ndarray,
    lower: np.ndarray,
    upper: np.ndarray,
    plate_position: np.ndarray,
    plate_rotation: np.ndarray,
    margin: float,
) -> np.ndarray:
    """Whether the lowest corner of each sole is less than a margin (m) above its plate (F,).

    Args:
        position: sole origins in the world (F, 3), m.
        rotation: axes of the soles in the world (F, 3, 3).
        lower: rear right corners in the sole frames (F, 2), m.
        upper: front left corners likewise (F, 2), m.
        plate_position: a point of the plate under each sole (F, 3), m.
        plate_rotation: axes of those plates, normals last (F, 3, 3).
        margin: m.
    """
    near = np.empty(len(position), dtype=np.bool_)
    for foot in range(len(position)):
        normal = plate_rotation[foot, :, 2]
        height = distance_above(plate_position[foot], plate_rotation[foot], position[foot])
        for k in range(2):
            slope = 0.0
            for i in range(3):
                slope += normal[i] * rotation[foot, i, k]
            height += min(slope * lower[foot, k], slope * upper[foot, k])
        near[foot] = height < margin
    return near
