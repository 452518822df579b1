"""From samples to curves: what the plots show over time, as plain arrays."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np

from momentum_lab.app.support_now import extent, polygon_of
from momentum_lab.recording import Layout, Sample
from momentum_lab.robot.model import RobotModel

WINDOW = 8.0
"""How much simulated time the plots show, s."""

_CENTIMETRES = 100.0


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
    """

    time: np.ndarray
    points: dict[str, np.ndarray]
    limits: tuple[np.ndarray, np.ndarray]
    linear: dict[str, np.ndarray]
    angular: dict[str, np.ndarray]
    momentum: np.ndarray
    angular_momentum: np.ndarray
    pushed: np.ndarray


class History:
    """The samples of the plots: the last seconds of one run.

    Args:
        robot: the robot.
        layout: how its samples are laid out.
    """

    def __init__(self, robot: RobotModel, layout: Layout) -> None:
        self._robot, self._layout = robot, layout
        self._slices = layout.slices
        self._rows: deque[np.ndarray] = deque()
        # Polygons and where they end are worked out once per sample: ten drawings a second show it in turn.
        self._polygons: deque[np.ndarray] = deque()
        self._extents: deque[tuple[float, float]] = deque()
        self._direction = np.array([1.0, 0.0])

    def __len__(self) -> int:
        return len(self._rows)

    def add(self, rows: np.ndarray) -> None:
        """More samples (n, width), oldest first; those out of the window are forgotten."""
        at = self._slices["time"].start
        for row in rows:
            polygon = polygon_of(Sample(self._layout, self._slices, row), self._robot)
            self._rows.append(row)
            self._polygons.append(polygon)
            self._extents.append(extent(polygon, self._direction))
        while self._rows and self._rows[-1][at] - self._rows[0][at] >= WINDOW:
            for kept in (self._rows, self._polygons, self._extents):
                kept.popleft()

    def clear(self) -> None:
        """Forget everything."""
        for kept in (self._rows, self._polygons, self._extents):
            kept.clear()

    def curves(self, direction: np.ndarray) -> Curves:
        """What has happened along a direction (2,) on the ground, of unit length."""
        rows = np.array(self._rows)
        column = {
            name: rows[:, at].reshape(len(rows), *self._layout.shapes[name])
            for name, at in self._slices.items()
        }
        along, across = np.append(direction, 0.0), np.array([-direction[1], direction[0], 0.0])
        limits = self._limits(direction)
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
        )

    def _limits(self, direction: np.ndarray) -> np.ndarray:
        """Where the support ends along a direction, sample by sample (n, 2), m."""
        if not np.array_equal(direction, self._direction):
            self._direction = np.array(direction)
            self._extents = deque(extent(polygon, direction) for polygon in self._polygons)
        return np.array(self._extents)
