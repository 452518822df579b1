"""What plots show of a robot that has fallen: its scale stays that of the robot that stood."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def within_standing(curves: Sequence[np.ndarray], fallen: np.ndarray, least: float) -> list[np.ndarray]:
    """The curves of one plot, NaN where a fallen robot leaves the range that they had while it stood.

    A body that hits the floor has forces and momenta ten times those of a push; a plot that showed them would show
    the answer to the push as a level line.

    Args:
        curves: curves (n,) each, of one plot.
        fallen: whether the robot has fallen (n,), bool.
        least: the plot shows at least from minus this to this.
    """
    if not fallen.any():
        return list(curves)
    standing = np.concatenate([[0.0], *(curve[~fallen] for curve in curves)])
    low, high = min(-least, np.nanmin(standing)), max(least, np.nanmax(standing))
    return [np.where(fallen & ~((curve >= low) & (curve <= high)), np.nan, curve) for curve in curves]
