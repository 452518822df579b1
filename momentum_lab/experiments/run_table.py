"""A run as a table: every number of every sample, one column each, named after it."""

from __future__ import annotations

import csv
import io
import itertools

import numpy as np

from momentum_lab.finished import FinishedRun

MOST_ROWS = 10_000
"""More than a spreadsheet likes."""

_XYZ = ("x", "y", "z")
_SIX = ("fx", "fy", "fz", "mx", "my", "mz")
_PARTS: dict[str, tuple[str, ...]] = {
    "com": _XYZ,
    "com_velocity": _XYZ,
    "momentum": ("lx", "ly", "lz", "kx", "ky", "kz"),
    "momentum_rate_desired": _SIX,
    "momentum_rate_admissible": _SIX,
    "momentum_rate_measured": _SIX,
    "foot_wrench_measured": _SIX,
    "foot_wrench_admissible": _SIX,
    "push_wrench": _SIX,
    "other_contact_wrench": _SIX,
    "sole_pose": ("x", "y", "z", "qx", "qy", "qz", "qw"),
}


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
    """The names of the columns: quantity, then foot or joint, then component."""
    layout = run.recording.layout
    names = []
    for quantity, shape in layout.shapes.items():
        labels = [_labels(run, quantity, shape, axis) for axis in range(len(shape))]
        names += [".".join((quantity, *parts)) for parts in itertools.product(*labels)]
    return names


def _labels(run: FinishedRun, quantity: str, shape: tuple[int, ...], axis: int) -> tuple[str, ...]:
    layout, size = run.recording.layout, shape[axis]
    if len(shape) == 2 and axis == 0:
        return layout.foot_names
    if quantity in ("torque", "joint_stop_torque"):
        return layout.joint_names
    known = _PARTS.get(quantity, _XYZ[:2] if size == 2 else ())
    return known if len(known) == size else tuple(str(i) for i in range(size))
