"""From samples to curves: what the plots show over time, as plain arrays."""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from dataclasses import dataclass

import numpy as np

from momentum_lab.app.support_now import extent, polygon_of
from momentum_lab.recording import Layout, Sample
from momentum_lab.robot.model import RobotModel

WINDOW = 8.0
"""How much simulated time the plots show, s."""

KEPT = 60.0
"""How much of it can be looked back at, s."""

_CENTIMETRES = 100.0
# Times are sums of time steps, s.
_ROUNDING = 1e-9


@dataclass(frozen=True, slots=True)
class Curves:
    """Curves over simulated time, all of one length, NaN where there is nothing.

    Attributes:
        time: s.
        points: name -> coordinate along the push from the middle of the support at the start, cm.
        limits: lower and upper end of the support along the push, cm.
        linear: name -> rate of linear momentum along the push, N.
        angular: name -> rate of angular momentum about the axis across the push, N m.
        momentum: linear momentum along the push, N s.
        angular_momentum: about the axis across the push, kg m^2/s.
        pushed: 1 while a push acts, else 0.
        fallen: whether the robot has fallen.
    """

    time: np.ndarray
    points: dict[str, np.ndarray]
    limits: tuple[np.ndarray, np.ndarray]
    linear: dict[str, np.ndarray]
    angular: dict[str, np.ndarray]
    momentum: np.ndarray
    angular_momentum: np.ndarray
    pushed: np.ndarray
    fallen: np.ndarray


class History:
    """The samples of the plots: the last minute of one run.

    Args:
        robot: the robot.
        layout: how its samples are laid out.
    """

    def __init__(self, robot: RobotModel, layout: Layout) -> None:
        self._robot, self._layout = robot, layout
        self._slices = layout.slices
        self._times: list[float] = []
        self._rows: list[np.ndarray] = []
        # Polygons and where they end are worked out once per sample: ten drawings a second show it in turn.
        self._polygons: list[np.ndarray] = []
        self._extents: list[tuple[float, float] | None] = []
        self._direction = np.array([1.0, 0.0])

    def __len__(self) -> int:
        return len(self._rows)

    def add(self, rows: np.ndarray) -> None:
        """More samples (n, width), oldest first.

        Those too old to be looked back at are forgotten, and those that a sample of an earlier time replaces.
        """
        at = self._slices["time"].start
        for row in rows:
            self._keep(0, bisect_left(self._times, row[at]))
            polygon = polygon_of(Sample(self._layout, self._slices, row), self._robot)
            self._times.append(float(row[at]))
            self._rows.append(row)
            self._polygons.append(polygon)
            self._extents.append(None)
        if self._times:
            self._keep(bisect_right(self._times, self._times[-1] - KEPT), len(self._times))

    def copy(self) -> History:
        """The same samples, to which nothing is added any more."""
        other = self.another()
        other._times, other._rows = list(self._times), list(self._rows)
        other._polygons, other._extents = list(self._polygons), [None] * len(self._extents)
        return other

    def another(self) -> History:
        """An empty one for a robot like this one's."""
        return History(self._robot, self._layout)

    def clear(self) -> None:
        """Forget everything."""
        self._keep(0, 0)

    def curves(self, direction: np.ndarray, until: float = math.inf) -> Curves:
        """What has happened in one window.

        Args:
            direction: along which (2,), on the ground, of unit length.
            until: end of the window, s; the first sample is shown even if it is later.
        """
        end = max(1, bisect_right(self._times, until + _ROUNDING))
        window = slice(bisect_right(self._times, self._times[end - 1] - WINDOW), end)
        rows = np.array(self._rows[window])
        column = {
            name: rows[:, at].reshape(len(rows), *self._layout.shapes[name])
            for name, at in self._slices.items()
        }
        along, across = np.append(direction, 0.0), np.array([-direction[1], direction[0], 0.0])
        limits = self._limits(direction, window)
        origin = float(np.nanmean(limits[0])) if np.isfinite(limits[0]).any() else 0.0
        places = {
            "com": column["com"][:, :2],
            "cop": column["cop_measured"],
            "cmp": column["cmp"],
            "capture": column["capture_point"],
        }
        kinds = ("desired", "admissible", "measured")
        return Curves(
            time=column["time"],
            points={name: _CENTIMETRES * (place @ direction - origin) for name, place in places.items()},
            limits=(_CENTIMETRES * (limits[:, 0] - origin), _CENTIMETRES * (limits[:, 1] - origin)),
            linear={kind: column[f"momentum_rate_{kind}"][:, :3] @ along for kind in kinds},
            angular={kind: column[f"momentum_rate_{kind}"][:, 3:] @ across for kind in kinds},
            momentum=column["momentum"][:, :3] @ along,
            angular_momentum=column["momentum"][:, 3:] @ across,
            pushed=(np.abs(column["push_wrench"]).max(axis=1) > 0.0).astype(float),
            fallen=column["fallen"] > 0.0,
        )

    def _limits(self, direction: np.ndarray, window: slice) -> np.ndarray:
        """Where the support ends along a direction, for the samples of a window (n, 2), m."""
        if not np.array_equal(direction, self._direction):
            self._direction = np.array(direction)
            self._extents = [None] * len(self._extents)
        self._extents[window] = [
            extent(polygon, direction) if known is None else known
            for known, polygon in zip(self._extents[window], self._polygons[window], strict=True)
        ]
        return np.array(self._extents[window])

    def _keep(self, start: int, end: int) -> None:
        """Forget all samples but those from one number to another."""
        for kept in (self._times, self._rows, self._polygons, self._extents):
            del kept[end:], kept[:start]
