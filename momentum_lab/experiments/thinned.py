"""Quantities of a run over time, thinned out to what a picture can show."""

from __future__ import annotations

import numpy as np

from momentum_lab.finished import FinishedRun

_MOST_POINTS = 4000


def projected(rows: np.ndarray, axis: np.ndarray) -> np.ndarray:
    """Momenta or their rates (n, 6) along an axis (6,); components that it has no part of may be NaN."""
    used = axis != 0.0
    return np.asarray(rows[:, used] @ axis[used])


class Thinned:
    """The columns of a run's recording, a few thousand samples of them.

    Args:
        run: the run.
    """

    def __init__(self, run: FinishedRun) -> None:
        self._run = run
        self._every = max(1, len(run.recording) // _MOST_POINTS)

    def __call__(self, name: str) -> np.ndarray:
        """A quantity over time (n, *shape), in its own unit."""
        return self._run.recording.column(name, self._every)

    def until_fall(self, name: str) -> np.ndarray:
        """The same, NaN once the robot has fallen: what a limp robot does would dwarf everything else."""
        column = self(name)
        fallen = self("fallen").reshape(-1, *[1] * (column.ndim - 1)) > 0.0
        return np.where(fallen, np.nan, column)
