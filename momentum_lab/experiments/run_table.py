"""A run as a table: every number of every sample, one column each, named after it."""

from __future__ import annotations

import csv
import io

import numpy as np

from momentum_lab.experiments.run_columns import column_names
from momentum_lab.finished import FinishedRun

MOST_ROWS = 10_000
"""More than a spreadsheet likes."""


def table(run: FinishedRun, most: int = MOST_ROWS) -> bytes:
    """The run as a CSV file, SI units, world axes.

    Args:
        run: the run.
        most: how many rows at most: of a longer run every second tick is written, or every third, and so on.
    """
    file = io.StringIO(newline="")
    writer = csv.writer(file)
    writer.writerow(header(run))
    rows = run.recording.rows(max(1, -(-len(run.recording) // most)))
    np.savetxt(file, rows, fmt="%.9g", delimiter=",", newline="\r\n")
    return file.getvalue().encode()


def header(run: FinishedRun) -> list[str]:
    """The names of the columns: `quantity/foot or joint/component [unit]`, without a unit where there is none."""
    return column_names(run.recording.layout)
