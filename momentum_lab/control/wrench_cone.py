"""What a flat sole can bear, as linear inequalities in its wrench."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

ROWS = 17
"""Rows per foot: least force, friction, CoP, moment about the normal."""


@lru_cache(maxsize=64)
def wrench_cone(
    x_half: float, y_half: float, friction: float, least_force: float
) -> tuple[np.ndarray, np.ndarray]:
    """The wrenches that friction pyramids at the four corners of a rectangle can add up to: C w <= d.

    The closed form of Caron, Pham and Nakamura (ICRA 2015), for w = [f; n] about the rectangle's centre in
    its axes, with mu' = mu / sqrt(2) so that the pyramids stay within the cones:

        |f_x|, |f_y| <= mu' f_z,   |n_x| <= Y f_z,   |n_y| <= X f_z   (the CoP is in the rectangle),
        n_z >= -mu' (X + Y) f_z + |Y f_x - mu' n_x| + |X f_y - mu' n_y|,
        n_z <=  mu' (X + Y) f_z - |Y f_x + mu' n_x| - |X f_y + mu' n_y|.

    Args:
        x_half: X, half of the rectangle's length, m.
        y_half: Y, half of its width, m.
        friction: Coulomb coefficient mu.
        least_force: least normal force, N.

    Returns:
        C (17, 6) and d (17,), N and N m.
    """
    mu = friction / math.sqrt(2.0)
    simple = [
        (0.0, 0.0, -1.0, 0.0, 0.0, 0.0),
        *((s, 0.0, -mu, 0.0, 0.0, 0.0) for s in (1.0, -1.0)),
        *((0.0, s, -mu, 0.0, 0.0, 0.0) for s in (1.0, -1.0)),
        *((0.0, 0.0, -y_half, s, 0.0, 0.0) for s in (1.0, -1.0)),
        *((0.0, 0.0, -x_half, 0.0, s, 0.0) for s in (1.0, -1.0)),
    ]
    yaw = [
        (a * y_half, b * x_half, -mu * (x_half + y_half), side * a * mu, side * b * mu, side)
        for side in (1.0, -1.0)
        for a in (1.0, -1.0)
        for b in (1.0, -1.0)
    ]
    bound = np.zeros(ROWS)
    bound[0] = -least_force
    return np.array(simple + yaw), bound
