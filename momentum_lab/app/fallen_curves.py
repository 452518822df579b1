"""What plots show of a robot that has fallen: its scale stays that of the robot that stood."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

# A fall is told when the CoM has sunk; by then knees and hands may have hit the floor already, s.
FALLING = 0.3


def is_down(times: np.ndarray, fallen: np.ndarray) -> np.ndarray:
    """Whether the robot lies or is about to (n,), out of times, s, and whether it has fallen (n,)."""
    return (
        times > times[int(np.argmax(fallen))] - FALLING if fallen.any() else np.zeros(len(times), dtype=bool)
    )


def within_standing(curves: Sequence[np.ndarray], down: np.ndarray, least: float) -> list[np.ndarray]:
    """The curves of one plot, NaN where a robot that is down leaves the range that they had while it stood.

    A body that hits the floor has forces and momenta ten times those of a push; a plot that showed them would show
    the answer to the push as a level line.

    Args:
        curves: curves (n,) each, of one plot.
        down: whether the robot lies or is about to (n,), bool.
        least: the plot shows at least from minus this to this.
    """
    if not down.any():
        return list(curves)
    standing = np.concatenate([[0.0], *(curve[~down] for curve in curves)])
    low, high = min(-least, np.nanmin(standing)), max(least, np.nanmax(standing))
    return [np.where(down & ~((curve >= low) & (curve <= high)), np.nan, curve) for curve in curves]
