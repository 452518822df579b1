"""Runs that last as long as a test wants, made of a single sample."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from momentum_lab.experiments.window import Window
from momentum_lab.finished import FinishedRun
from momentum_lab.recording import Recording

STEP = 0.01
"""Between two samples, s."""


def lasting(run: FinishedRun, recorded: Window, *moving: Window, **changes: object) -> FinishedRun:
    """A run whose only sample lasts, but for the times at which its CoM moves."""
    times = np.arange(recorded.start, recorded.end + 0.5 * STEP, STEP)
    recording = Recording(run.recording.layout, len(times))
    for time in times:
        row = recording.next_row()
        row[:] = run.recording.rows()[0]
        row[recording.slices["time"]] = time
        moves = any(each.start <= time < each.end for each in moving)
        row[recording.slices["com_velocity"]] = (0.3 if moves else 0.0, 0.0, 0.0)
    return replace(run, recording=recording, time=recorded.end, **changes)
