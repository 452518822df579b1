"""The last minute of one run: what it amounts to in a few numbers, and where the robot was at any time."""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from dataclasses import dataclass

import numpy as np

from momentum_lab.app.beginnings import latest_before
from momentum_lab.app.series import KEPT
from momentum_lab.app.support_now import polygon_of
from momentum_lab.app.wire import Truth
from momentum_lab.momentum.support import support_margin
from momentum_lab.recording import Layout, Sample
from momentum_lab.robot.model import RobotModel
from momentum_lab.summary import SETTLED_SPEED


@dataclass(frozen=True, slots=True)
class Facts:
    """What a run amounts to.

    Attributes:
        seconds: simulated time of its last sample, s.
        fall_time: when the robot fell, s after the latest push before; None without a fall of its own.
        excursion: largest horizontal distance of the CoM from its start, m.
        angular_momentum: largest |k| about the CoM, kg m^2/s.
        settled_after: how long after the beginning of its latest push the CoM came to rest, s; None if it has not.
        margin: smallest distance of the CoP from the edge of the support until a fall, m; None without support.
        lay_there: whether it had fallen already when it came beside another; its fall is not its own then.
    """

    seconds: float
    fall_time: float | None
    excursion: float
    angular_momentum: float
    settled_after: float | None
    margin: float | None
    lay_there: bool = False


class Story:
    """The samples of one run at the pace of the plots.

    Args:
        robot: the robot.
        layout: how its samples are laid out.
    """

    def __init__(self, robot: RobotModel, layout: Layout) -> None:
        self.robot, self.layout = robot, layout
        self._slices = layout.slices
        self._times: list[float] = []
        self._rows: list[np.ndarray] = []
        self._margins: list[float] = []

    def __len__(self) -> int:
        return len(self._rows)

    def add(self, rows: np.ndarray) -> None:
        """More samples (n, width), oldest first; those of an earlier time replace what came after it."""
        for row in rows:
            sample = Sample(self.layout, self._slices, row)
            time = sample.number("time")
            self._keep(0, bisect_left(self._times, time))
            self._times.append(time)
            self._rows.append(row)
            self._margins.append(self._margin(sample))
        if self._times:
            self._keep(bisect_right(self._times, self._times[-1] - KEPT), len(self._times))

    def copy(self) -> Story:
        """The same samples, to which nothing is added any more."""
        other = Story(self.robot, self.layout)
        other._times, other._rows, other._margins = list(self._times), list(self._rows), list(self._margins)
        return other

    def facts(self, truth: Truth) -> Facts:
        """What the run amounts to so far; there must be a sample."""
        rows = np.array(self._rows)
        com = rows[:, self._slices["com"]][:, :2]
        angular = rows[:, self._slices["momentum"]][:, 3:]
        standing = np.array(self._times) < (math.inf if truth.fall is None else truth.fall.time)
        margins = np.array(self._margins)[standing]
        margins = margins[np.isfinite(margins)]
        return Facts(
            seconds=self._times[-1],
            fall_time=_fell_after(truth),
            excursion=float(np.linalg.norm(com - com[0], axis=1).max()),
            angular_momentum=float(np.linalg.norm(angular, axis=1).max()),
            settled_after=None if truth.fall is not None else self._settled(rows, _pushed(truth, math.inf)),
            margin=float(margins.min()) if margins.size else None,
            lay_there=truth.lay_there,
        )

    def posture(self, time: float) -> np.ndarray:
        """Where the robot was at a time, s, between two samples in between (nq,); there must be a sample."""
        after = min(bisect_right(self._times, time), len(self._times) - 1)
        before = max(0, after - 1)
        q = [self._rows[i][self._slices["q"]] for i in (before, after)]
        span = self._times[after] - self._times[before]
        part = 0.0 if span <= 0.0 else min(1.0, max(0.0, (time - self._times[before]) / span))
        same_side = -1.0 if q[0][3:7] @ q[1][3:7] < 0.0 else 1.0
        between = (1.0 - part) * q[0] + part * q[1]
        quaternion = (1.0 - part) * q[0][3:7] + same_side * part * q[1][3:7]
        between[3:7] = quaternion / np.linalg.norm(quaternion)
        return np.asarray(between)

    def _settled(self, rows: np.ndarray, pushed: float) -> float | None:
        """How long after a push the CoM was last as fast as a robot that is not at rest, s."""
        speed = np.linalg.norm(rows[:, self._slices["com_velocity"]], axis=1)
        moving = np.flatnonzero((speed >= SETTLED_SPEED) & (np.array(self._times) >= pushed))
        if not moving.size:
            return 0.0
        if moving[-1] + 1 == len(rows):
            return None
        return self._times[moving[-1] + 1] - pushed

    def _margin(self, sample: Sample) -> float:
        """Distance of the CoP from the edge of the support, m; NaN without support."""
        polygon = polygon_of(sample, self.robot)
        return float(support_margin(sample["cop_measured"], polygon)) if len(polygon) > 2 else math.nan

    def _keep(self, start: int, end: int) -> None:
        for kept in (self._times, self._rows, self._margins):
            del kept[end:], kept[:start]


def _fell_after(truth: Truth) -> float | None:
    """How long after the latest push the robot fell, s; None without a fall of its own."""
    if truth.fall is None or truth.lay_there:
        return None
    return truth.fall.time - _pushed(truth, truth.fall.time)


def _pushed(truth: Truth, time: float) -> float:
    """When the latest push before a time began, s; the start of the run without one."""
    return latest_before(truth.pushed, time) or 0.0
