"""When a robot came to rest: its CoM is slower than that of one that has settled, until the recording ends."""

from __future__ import annotations

import numpy as np

from momentum_lab.finished import FinishedRun
from momentum_lab.summary import SETTLED_SPEED


def rest_time(times: np.ndarray, speeds: np.ndarray, since: float) -> float | None:
    """From when on the CoM is slow until the end, s; None if it is not at the last sample, or is not a number.

    Args:
        times: of the samples (n,), s, rising; at least one.
        speeds: of the CoM (n,), m/s.
        since: what was before does not count, s.
    """
    moving = np.flatnonzero(~(speeds < SETTLED_SPEED) & (times >= since))
    if not moving.size:
        return max(since, float(times[0]))
    return None if moving[-1] + 1 == len(times) else float(times[moving[-1] + 1])


def com_speeds(run: FinishedRun) -> np.ndarray:
    """Speed of the CoM against the ground under the feet at all samples (n,), m/s; there must be a sample."""
    velocity, times = run.recording.column("com_velocity"), run.recording.column("time")
    if len(times) > 1:
        ground = run.recording.column("ground_pose")[:, list(run.stance), :3].mean(axis=1)
        velocity = velocity - np.gradient(ground, times, axis=0)
    return np.asarray(np.linalg.norm(velocity, axis=1))
