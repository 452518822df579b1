"""Curves of another run in the plots of this one: a few of them, at the times of the others."""

from __future__ import annotations

import numpy as np

from momentum_lab.app.series import History

POINTS = ("com", "cop")
"""The points that say most: where the CoM went, and what pushed it there."""

COUNTS = (len(POINTS), 1, 1, 2)
"""How many curves there are in each plot: points, rates of linear and angular momentum (measured), both momenta."""

Curve = np.ndarray


def curves_at(history: History | None, direction: np.ndarray, times: np.ndarray) -> list[list[Curve]]:
    """The curves of each plot; NaN where the run has nothing, and after a fall, which would dwarf all others.

    Args:
        history: the run; None: there is none.
        direction: along which (2,), on the ground, of unit length.
        times: of the curves (n,), s of the other run's time.
    """
    if history is None or not len(history):
        return [[np.full(len(times), np.nan)] * count for count in COUNTS]
    found = history.curves(direction, float(times[-1]))
    stands = np.where(found.fallen, np.nan, 1.0)
    plots = (
        [found.points[name] for name in POINTS],
        [found.linear["measured"]],
        [found.angular["measured"]],
        [found.momentum, found.angular_momentum],
    )
    return [
        [np.interp(times, found.time, stands * curve, left=np.nan, right=np.nan) for curve in curves]
        for curves in plots
    ]
