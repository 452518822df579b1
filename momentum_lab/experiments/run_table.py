"""A run as a table: every number of every sample, one column each, named after it."""

from __future__ import annotations

import csv
import io

import numpy as np

from momentum_lab.experiments.run_columns import column_names
from momentum_lab.finished import FinishedRun
from momentum_lab.trace import SECOND

MOST_ROWS = 10_000
"""More than a spreadsheet likes."""


def table(run: FinishedRun, most: int = MOST_ROWS) -> bytes:
    """The run as a CSV file, SI units, world axes; a robot beside the first follows in columns of its own.

    Args:
        run: the run.
        most: how many rows at most: of a longer run every second tick is written, or every third, and so on.
    """
    file = io.StringIO(newline="")
    writer = csv.writer(file)
    writer.writerow(header(run))
    rows = run.recording.rows(max(1, -(-len(run.recording) // most)))
    if run.beside is not None:
        times = rows[:, run.recording.slices["time"]].ravel()
        rows = np.hstack([rows, _rows_at(run.beside, times)])
    np.savetxt(file, rows, fmt="%.9g", delimiter=",", newline="\r\n")
    return file.getvalue().encode()


def thinned_words(content: bytes, timestep: float) -> str:
    """What to say of a table that does not hold every tick; nothing of one that does.

    Args:
        content: the CSV file.
        timestep: of the run, s.
    """
    times = [float(row.partition(b",")[0]) for row in content.split(b"\r\n", 3)[1:3] if row]
    every = round((times[1] - times[0]) / timestep) if len(times) == 2 else 1
    if every == 1:
        return ""
    pace = f"a row each {1e3 * every * timestep:g} ms, to have {MOST_ROWS:,} rows at most"
    return f"The table holds one tick in {every}, {pace}. The trace (.npz) holds every tick."


def header(run: FinishedRun) -> list[str]:
    """The names of the columns: `quantity/foot or joint/component [unit]`, without a unit where there is none.

    Those of a robot beside the first begin with `second/`.
    """
    names = column_names(run.recording.layout)
    return names if run.beside is None else [*names, *(f"{SECOND}{name}" for name in names)]


def _rows_at(run: FinishedRun, times: np.ndarray) -> np.ndarray:
    """The samples of a run at some times (n, width); NaN before it began and after it ended."""
    own = run.recording.rows()
    found = np.full((len(times), run.recording.layout.width), np.nan)
    if len(own):
        begin = own[0, run.recording.slices["time"]]
        ticks = np.rint((times - begin) / run.scenario.timestep).astype(int)
        there = (ticks >= 0) & (ticks < len(own))
        found[there] = own[ticks[there]]
    return found
