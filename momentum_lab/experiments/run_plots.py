"""Any run as pictures: points, momentum rates and momenta over time, and the paths on the ground."""

from __future__ import annotations

import io
from typing import Any

import numpy as np

from momentum_lab.experiments.canvas import (
    ADMISSIBLE,
    CAPTURE,
    CMP,
    COM,
    COP,
    DESIRED,
    LINEAR,
    MEASURED,
    MUTED,
    SPIN,
    band,
    canvas,
    cut_spikes,
    finish,
    heading,
    show_at_least,
)
from momentum_lab.experiments.least_span import LEAST
from momentum_lab.experiments.second_curves import beside_momenta, beside_paths, beside_points, beside_rate
from momentum_lab.experiments.thinned import Thinned, projected
from momentum_lab.experiments.window import around_pushes, time_span
from momentum_lab.finished import FinishedRun
from momentum_lab.summary import corners_in_world

_DOTS_PER_INCH = 110
_RATES = (("desired", DESIRED, "--"), ("admissible", ADMISSIBLE, "-"), ("measured", MEASURED, "-"))
# A sole that presses less than this on the ground does not support, N.
_LEAST_SUPPORT = 1.0


def over_time(run: FinishedRun) -> Any:
    """Four plots over time, along the largest push: points and support, both rates, both momenta.

    Of a long run they show the part around its pushes. A robot beside the first is dashed.
    """
    run = around_pushes(run)
    picture, axes = canvas(heading(_title(run), run, _no_push(run)), 4, 1, (8.0, 9.6), sharex=True)
    forward = along(run)
    linear = np.array([*forward, 0.0, 0.0, 0.0, 0.0])
    angular = np.array([0.0, 0.0, 0.0, -forward[1], forward[0], 0.0])
    _points(axes[0, 0], run, forward)
    _rates(axes[1, 0], run, linear, LEAST["linear"])
    _rates(axes[2, 0], run, angular, LEAST["angular"])
    _momenta(axes[3, 0], run, linear, angular)
    for row, name in zip(axes[1:, 0], ("linear", "angular", "momenta"), strict=True):
        show_at_least(row, LEAST[name])
        band(row, run)
    finish(axes[1, 0], "Rate of linear momentum along the push", "", "N")
    finish(axes[2, 0], "Rate of angular momentum about the axis across", "", "N m")
    finish(axes[3, 0], "Momentum", "time (s)", "N s, kg m²/s")
    return picture


def on_the_ground(run: FinishedRun) -> Any:
    """Paths of CoM, CoP and capture point from above, with the soles where they stood at first and at last.

    Of a long run they show the part around its pushes. A robot beside the first is dashed; only its points are shown.
    """
    run = around_pushes(run)
    picture, axes = canvas("On the ground, from above", 1, 1, (8.0, 5.2))
    column, chart = Thinned(run), axes[0, 0]
    corners = corners_in_world(run, column("sole_pose"))[..., :2]
    for moment, style in ((0, "-"), (-1, ":")):
        for foot in corners[moment]:
            outline = np.vstack([hull_order(foot), hull_order(foot)[:1]])
            name = "soles" if moment == 0 else "soles at the end"
            chart.plot(outline[:, 0], outline[:, 1], style, color=MUTED, lw=1.0, label=name)
    for name, color, label in (
        ("capture_point", CAPTURE, "capture point"),
        ("cop_measured", COP, "CoP"),
        ("com", COM, "CoM"),
    ):
        path = column(name)[:, :2]
        chart.plot(path[:, 0], path[:, 1], color=color, lw=1.3, label=label)
    beside_paths(chart, run)
    low, high = corners.reshape(-1, 2).min(axis=0) - 0.1, corners.reshape(-1, 2).max(axis=0) + 0.1
    chart.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
    finish(chart, "", "x (m)", "y (m)", loc="center left", bbox_to_anchor=(1.02, 0.5))
    return picture


def png(picture: Any) -> bytes:
    """A picture as a PNG file; the same run gives the same bytes."""
    file = io.BytesIO()
    picture.savefig(file, format="png", dpi=_DOTS_PER_INCH, metadata={"Software": None})
    return file.getvalue()


def along(run: FinishedRun) -> np.ndarray:
    """Unit vector of the largest push (2,); forward without one."""
    largest = max(run.pushes, key=lambda push: push.impulse, default=None)
    return np.array([1.0, 0.0]) if largest is None else largest.along


def hull_order(corners: np.ndarray) -> np.ndarray:
    """Corners (4, 2) in the order in which they are walked around."""
    arms = corners - corners.mean(axis=0)
    return corners[np.argsort(np.arctan2(arms[:, 1], arms[:, 0]))]


def _rates(axes: Any, run: FinishedRun, axis: np.ndarray, least: float) -> None:
    """Momentum rates over time along an axis (6,); what is no larger than the least is no spike."""
    column = Thinned(run)
    for kind, color, style in _RATES:
        rate = projected(column(f"momentum_rate_{kind}"), axis)
        axes.plot(column("time"), rate, style, color=color, label=kind, lw=1.2)
    cut_spikes(axes, least, beside_rate(axes, run, axis))


def _momenta(axes: Any, run: FinishedRun, linear: np.ndarray, angular: np.ndarray) -> None:
    """Both momenta over time, along axes (6,)."""
    column = Thinned(run)
    for axis, color, name in (
        (linear, LINEAR, "linear, along the push (N s)"),
        (angular, SPIN, "angular, about the axis across (kg m²/s)"),
    ):
        axes.plot(column("time"), projected(column("momentum"), axis), color=color, label=name)
    beside_momenta(axes, run, linear, angular)


def _points(axes: Any, run: FinishedRun, forward: np.ndarray) -> None:
    column = Thinned(run)
    corners = corners_in_world(run, column("sole_pose"))[..., :2] @ forward
    pressed = column("foot_wrench_measured")[:, :, 2] > _LEAST_SUPPORT
    ahead = np.where(pressed, corners.max(axis=2), -np.inf).max(axis=1)
    behind = np.where(pressed, corners.min(axis=2), np.inf).min(axis=1)
    ahead[~pressed.any(axis=1)] = behind[~pressed.any(axis=1)] = np.nan
    origin = 0.5 * (ahead[0] + behind[0]) if pressed[0].any() else float(column("com")[0, :2] @ forward)
    time = column("time")
    axes.fill_between(
        time, 100.0 * (behind - origin), 100.0 * (ahead - origin), color="#eeeeee", label="support"
    )
    lines = (
        ("com", COM, "CoM"),
        ("cop_measured", COP, "CoP"),
        ("cmp", CMP, "CMP"),
        ("capture_point", CAPTURE, "capture point"),
    )
    for name, color, label in lines:
        axes.plot(time, 100.0 * (column(name)[:, :2] @ forward - origin), color=color, label=label, lw=1.2)
    beside_points(axes, run, forward, origin)
    band(axes, run)
    axes.set_ylim(*_limits(100.0 * (behind - origin), 100.0 * (ahead - origin)))
    finish(axes, "Points along the push, from the middle of the support", "", "cm", ncols=3)


def _limits(behind: np.ndarray, ahead: np.ndarray) -> tuple[float, float]:
    """The support and half of it on both sides: a CMP that flies away would flatten everything else."""
    if not np.isfinite(ahead).any():
        return -30.0, 30.0
    low, high = float(np.nanmin(behind[:1])), float(np.nanmax(ahead[:1]))
    if not np.isfinite([low, high]).all():
        low, high = float(np.nanmin(behind)), float(np.nanmax(ahead))
    return low - 0.6 * (high - low), high + 0.6 * (high - low)


def _title(run: FinishedRun) -> str:
    return run.scenario.title or run.scenario.name


def _no_push(run: FinishedRun) -> str:
    """What to say of a run without a push: if its beginning is not recorded there may have been one then."""
    there = time_span(run)
    if there.start < 0.5 * run.scenario.timestep:
        return "no push"
    return f"the last {there.end - there.start:.0f} s hold no push"
