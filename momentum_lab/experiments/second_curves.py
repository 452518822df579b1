"""The robot beside the first in the pictures of a run: what says most, dashed, in its colours."""

from __future__ import annotations

from typing import Any

import numpy as np

from momentum_lab.experiments.both import both
from momentum_lab.experiments.canvas import COM, COP, INK, LINEAR, MEASURED, SPIN
from momentum_lab.experiments.thinned import Thinned, projected
from momentum_lab.finished import FinishedRun

_DASHED = (0, (4, 2.5))
_SILENT = "_second"  # such a name stands in no legend
_POINTS = (("com", COM), ("cop_measured", COP))


def beside_points(axes: Any, run: FinishedRun, forward: np.ndarray, origin: float) -> None:
    """CoM and CoP of the second robot over time, and which curves are whose.

    Args:
        axes: where.
        run: of both robots.
        forward: along which (2,), of unit length.
        origin: what is counted from along it, m.
    """
    if (column := _second(run)) is None:
        return
    for name, color in _POINTS:
        _draw(axes, column, 100.0 * (column.until_fall(name)[:, :2] @ forward - origin), color)
    _name(axes, run)


def beside_rate(axes: Any, run: FinishedRun, axis: np.ndarray) -> list[Any]:
    """The measured momentum rate of the second robot over time, along an axis (6,), N or N m; the lines drawn."""
    if (column := _second(run)) is None:
        return []
    return _draw(axes, column, projected(column.until_fall("momentum_rate_measured"), axis), MEASURED)


def beside_momenta(axes: Any, run: FinishedRun, linear: np.ndarray, angular: np.ndarray) -> None:
    """Both momenta of the second robot over time, along axes (6,), N s and kg m^2/s."""
    if (column := _second(run)) is not None:
        for axis, color in ((linear, LINEAR), (angular, SPIN)):
            _draw(axes, column, projected(column.until_fall("momentum"), axis), color)


def beside_paths(axes: Any, run: FinishedRun) -> None:
    """Paths of the second robot's CoM and CoP from above, and which paths are whose."""
    if (column := _second(run)) is None:
        return
    for name, color in reversed(_POINTS):
        path = column.until_fall(name)
        axes.plot(path[:, 0], path[:, 1], color=color, ls=_DASHED, lw=1.2, label=_SILENT)
    _name(axes, run)


def _name(axes: Any, run: FinishedRun) -> None:
    """Say in the legend which curves are whose."""
    for (name, _), style in zip(both(run), ("-", _DASHED), strict=True):
        axes.plot([], [], color=INK, ls=style, lw=1.2, label=name)


def _second(run: FinishedRun) -> Thinned | None:
    _, *others = both(run)
    return Thinned(others[0][1]) if others else None


def _draw(axes: Any, column: Thinned, values: np.ndarray, color: str) -> list[Any]:
    lines: list[Any] = axes.plot(column("time"), values, color=color, ls=_DASHED, lw=1.2, label=_SILENT)
    return lines
