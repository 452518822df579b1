"""How all figures look: colours of the lab's marks, axes with units, the push as a grey band."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure as Picture

from momentum_lab import palette
from momentum_lab.finished import FinishedRun
from momentum_lab.palette import css
from momentum_lab.plain import plain
from momentum_lab.session import Session

# Each colour for the quantity that has it on the app's screen.
COM, COP, CMP, CAPTURE = (css(color) for color in (palette.COM, palette.COP, palette.CMP, palette.CAPTURE))
GRANTED, FORCE, SPIN = (css(color) for color in (palette.COP_WANTED, palette.GRF, palette.ANGULAR))
LINEAR, DESIRED, ADMISSIBLE, MEASURED = (
    css(color) for color in (palette.LINEAR, palette.DESIRED, palette.ADMISSIBLE, palette.MEASURED)
)
# Spikes are the outermost values of a line, and so is what a robot does while it falls, percent.
_SPIKES, _TUMBLES = (0.1, 99.9), (5.0, 95.0)
CHANGED, MUTED, INK = css(palette.VERMILLION), css(palette.GREY), css(palette.BLACK)


def canvas(title: str, rows: int, columns: int, size: tuple[float, float], **options: Any) -> tuple[Any, Any]:
    """An empty picture (inches) without a window, and its axes (rows, columns)."""
    picture = Picture(figsize=size, layout="constrained")
    FigureCanvasAgg(picture)
    picture.suptitle(title, fontsize=13)
    return picture, picture.subplots(rows, columns, squeeze=False, **options)


def band(axes: Any, session: Session | FinishedRun) -> None:
    """Every push of a run as a grey band over time."""
    for push in session.pushes:
        axes.axvspan(push.start, push.start + push.duration, color="#dddddd", zorder=0, label="push")


def finish(axes: Any, title: str, x: str, y: str, **legend: Any) -> None:
    """Title, units, a light grid and a legend that names everything once."""
    label(axes, title, x, y)
    handles, labels = axes.get_legend_handles_labels()
    named = dict(zip(labels, handles, strict=True))
    if named:
        settings = {"fontsize": 8, "framealpha": 0.9, **legend}
        axes.legend(named.values(), named.keys(), **settings)


def label(axes: Any, title: str, x: str, y: str) -> None:
    """Title, units and a light grid."""
    axes.set_title(title, fontsize=10, loc="left")
    axes.set_xlabel(x, fontsize=9)
    axes.set_ylabel(y, fontsize=9)
    axes.tick_params(labelsize=8)
    axes.grid(color="#eeeeee", zorder=0)


def legend_below(picture: Any, axes: Any) -> None:
    """What one axes shows, named once below the whole picture."""
    handles, labels = axes.get_legend_handles_labels()
    named = dict(zip(labels, handles, strict=True))
    picture.legend(named.values(), named.keys(), loc="outside lower center", ncols=len(named), fontsize=9)


def heading(title: str, session: Session | FinishedRun, without: str = "no push") -> str:
    """The title of a picture with the robot and the push it got, or some words if it got none."""
    pushes = "; ".join(f"{push.force:.0f} N for {push.duration:g} s" for push in session.pushes)
    return f"{title}\n{session.robot.spec.title}, {pushes or without}"


def _drawn(lines: Sequence[Any]) -> np.ndarray:
    return np.concatenate([np.asarray(line.get_ydata(), dtype=float) for line in lines])


def _span(lines: Sequence[Any], parts: tuple[float, float]) -> tuple[float, float]:
    """Between which values all but parts of some lines lie; NaN if they are drawn nowhere."""
    values = _drawn(lines)
    if not np.isfinite(values).any():
        return math.nan, math.nan
    low, high = np.nanpercentile(values, parts)
    return float(low), float(high)


def show_at_least(axes: Any, least: float) -> None:
    """Let a picture show everything from minus this to this: the noise of a robot at rest is then a level line."""
    low, high = axes.get_ylim()
    axes.set_ylim(min(low, -least), max(high, least))


def cut_spikes(axes: Any, least: float = -math.inf, tumbling: Sequence[Any] = ()) -> None:
    """Let spikes of a few ticks run out of the picture where they would flatten everything else, and say so.

    Args:
        axes: a picture.
        least: it will show at least from minus this to this; what stays within is no spike.
        tumbling: those of its lines of which more than spikes may run out: of a robot that falls.
    """
    low, high = _span([line for line in axes.get_lines() if line not in tumbling], _SPIKES)
    if tumbling:
        lower, higher = _span(tumbling, _TUMBLES)
        low, high = np.fmin(low, lower), np.fmax(high, higher)
    values = _drawn(axes.get_lines())
    room = 0.15 * (high - low)
    highest, lowest = np.nanmax(values), np.nanmin(values)
    if highest <= max(high + room, least) and lowest >= min(low - room, -least):
        return
    axes.set_ylim(low - room, high + room)
    axes.text(
        0.99,
        0.03,
        f"a sole lands: spikes from {plain(lowest, '.0f')} to {plain(highest, '.0f')} are cut",
        transform=axes.transAxes,
        fontsize=7,
        color=MUTED,
        ha="right",
    )
