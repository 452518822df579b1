"""The instant that is looked at, in the plots: a line, with the curves before and after it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from momentum_lab.app.series import WINDOW

SERIES: dict[str, Any] = {
    "scale": "push",  # from 0 at the lower edge to 1 at the upper one
    "label": "",
    "stroke": "rgba(128,128,128,0.95)",  # on white as on black
    "width": 1.5,
    "points": {"show": False},
}
"""How the line is drawn."""

BELOW, ABOVE = -1.0, 2.0
"""What is not in sight, where 0 and 1 are the edges."""


def end_around(cursor: float) -> float:
    """Where the window of the plots ends so that the cursor has curves on both sides, s; infinity without one."""
    return max(cursor + 0.5 * WINDOW, WINDOW) if math.isfinite(cursor) else math.inf


def cursor_line(times: np.ndarray, cursor: float) -> np.ndarray:
    """The line over the times of the curves (n,), nowhere without a cursor.

    It lies below the plot until the cursor and above it from there on, so that its rise is all that is seen; uPlot
    would connect values across gaps.
    """
    line = np.full(len(times), BELOW)
    if math.isfinite(cursor):
        line[min(max(1, int(np.searchsorted(times, cursor))), len(times) - 1) :] = ABOVE
    return line
