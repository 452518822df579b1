"""Plots over simulated time: points against the support, rates of both momenta, both momenta, pushes marked."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import viser

from momentum_lab.app import cursor, html
from momentum_lab.app.marks import STYLES
from momentum_lab.app.second_curves import POINTS, curves_at
from momentum_lab.app.series import WINDOW, Curves, History
from momentum_lab.experiments.least_span import LEAST
from momentum_lab.palette import ADMISSIBLE, ANGULAR, DESIRED, GREY, LINEAR, MEASURED, Color
from momentum_lab.recording import Layout
from momentum_lab.robot.model import RobotModel

# How often the plots are drawn, s; and how often while nothing in them changes but the time.
_PERIOD, _RESTING = 0.1, 1.0
# Values that differ by less than this part of a plot's least height look the same: a pixel.
_SAME = 0.01
_HEIGHT = 100
_UNSEEN = 1e-5
_AXIS = {"font": "10px sans-serif", "gap": 2, "ticks": {"size": 3}}
_POINTS = ("com", "cop", "cmp", "capture")
# What is asked for is dashed.
_KINDS: dict[str, tuple[Color, list[int]]] = {
    "desired": (DESIRED, [6, 4]),
    "admissible": (ADMISSIBLE, []),
    "measured": (MEASURED, []),
}


class Plots:
    """The plots of one browser tab.

    Args:
        gui: where they go.
        clock: seconds, for tests.
    """

    def __init__(self, gui: viser.GuiApi, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._next = self._next_rest = -math.inf
        self._history: History | None = None
        self._direction = np.array([1.0, 0.0])
        self._looked_at = math.inf
        self._kept: History | None = None
        self._beside: History | None = None
        self.ahead = 0.0
        self._places = _plot(
            gui,
            "Points along the push (cm)",
            [_line(STYLES[name].label, STYLES[name].color) for name in _POINTS]
            + [_line("support", GREY, [3, 3]), _line("", GREY, [3, 3])]
            + [_kept_line(STYLES[name].color) for name in POINTS],
            soft=LEAST["places"],
            bands=({"series": (6, 5), "fill": "rgba(110,110,110,0.10)"},),
        )
        self._linear = _plot(
            gui,
            "Rate of linear momentum along the push (N)",
            [*_rates(), _kept_line(MEASURED)],
            soft=LEAST["linear"],
        )
        self._angular = _plot(
            gui,
            "Rate of angular momentum about the axis across (N m)",
            [*_rates(), _kept_line(MEASURED)],
            soft=LEAST["angular"],
        )
        self._momenta = _plot(
            gui,
            "Momentum: linear (N s), angular (kg m²/s)",
            [
                _line("linear, along the push", LINEAR),
                _line("angular, about the axis across", ANGULAR),
                _kept_line(LINEAR),
                _kept_line(ANGULAR),
            ],
            soft=LEAST["momenta"],
        )

        # Plots, and what a robot beside the first adds to them: behind all others, so that those stay as they are.
        self._plots = (self._places, self._linear, self._angular, self._momenta)
        thin = (
            [_thin_line(STYLES[name].color) for name in POINTS],
            [_thin_line(MEASURED)],
            [_thin_line(MEASURED)],
        )
        self._thin = (*thin, [_thin_line(LINEAR), _thin_line(ANGULAR)])

    def begin(self, robot: RobotModel, layout: Layout) -> None:
        """Start with empty plots for a robot."""
        self._history = History(robot, layout)
        self.alone()

    def clear(self) -> None:
        """Empty the plots."""
        for history in (self._history, self._beside):
            if history is not None:
                history.clear()
        self._next = self._next_rest = -math.inf

    def keep(self) -> None:
        """Draw what is here now as dashed curves from now on, below those of later runs."""
        self._kept = None if self._history is None else self._history.copy()

    def add_beside(self, rows: np.ndarray) -> None:
        """Take new samples (n, width) of a robot beside the first; its curves are thin."""
        if self._history is None:
            return
        if self._beside is None:
            self._beside = self._history.another()
            self._series_of_two()
        self._beside.add(rows)

    def alone(self) -> None:
        """There is no robot beside the first any more."""
        if self._beside is None:
            return
        self._beside = None
        for plot, thin in zip(self._plots, self._thin, strict=True):
            # A plot may have more columns than lines, but never less.
            plot.series = plot.series[: -len(thin)]
            plot.data = plot.data[: -len(thin)]

    def _series_of_two(self) -> None:
        for plot, thin in zip(self._plots, self._thin, strict=True):
            nothing = np.full(len(plot.data[0]), np.nan)
            nothing[0] = 0.0
            plot.data = (*plot.data, *(nothing for _ in thin))
            plot.series = (*plot.series, *thin)

    def forget(self) -> None:
        """Draw no dashed curves any more."""
        self._kept = None
        self.draw()

    def along(self, direction: np.ndarray) -> None:
        """Show what happens along a direction (2,) from now on, the past included."""
        self._direction = direction

    def look_at(self, time: float) -> None:
        """Mark a time from now on and show what was around it, s; infinity: let the window end with the run."""
        if time != self._looked_at:
            self._looked_at = time
            self.draw()

    def add(self, rows: np.ndarray) -> None:
        """Take new samples (n, width) and draw them when it is time."""
        if self._history is not None:
            self._history.add(rows)
            if self._clock() >= self._next and len(self._history):
                curves = self._history.curves(self._direction, cursor.end_around(self._looked_at))
                self._next = self._clock() + _PERIOD
                if self._clock() >= self._next_rest or not (at_rest(curves) and self._other_rests()):
                    self._draw(curves)

    def _other_rests(self) -> bool:
        """Whether nothing changes in the curves of a robot beside the first."""
        beside = self._beside
        return (
            beside is None
            or not len(beside)
            or at_rest(beside.curves(self._direction, cursor.end_around(self._looked_at)))
        )

    def draw(self) -> None:
        """Draw what there is."""
        if self._history is not None and len(self._history):
            self._next = self._clock() + _PERIOD
            self._draw(self._history.curves(self._direction, cursor.end_around(self._looked_at)))

    def _draw(self, curves: Curves) -> None:
        self._next_rest = self._clock() + _RESTING
        x = _window(curves.time)
        # A push that goes on would be filled from the last sample to the end of the window.
        pushed = _framed(np.append(curves.pushed[:-1], 0.0))
        limits = [_held(_framed(limit)) for limit in curves.limits]
        own = (
            [*(_framed(curves.points[name]) for name in _POINTS), *limits],
            [_framed(curves.linear[kind]) for kind in _KINDS],
            [_framed(curves.angular[kind]) for kind in _KINDS],
            [_framed(curves.momentum), _framed(curves.angular_momentum)],
        )
        kept = curves_at(self._kept, self._direction, curves.time + self.ahead)
        beside: list[list[np.ndarray]] = [[], [], [], []]
        if self._beside is not None:
            beside = curves_at(self._beside, self._direction, curves.time)
        line = _framed(cursor.cursor_line(curves.time, self._looked_at))
        for plot, first, dashed, thin in zip(self._plots, own, kept, beside, strict=True):
            plot.data = (x, *first, *map(_framed, dashed), line, pushed, *map(_framed, thin))


def at_rest(curves: Curves) -> bool:
    """Whether all curves are level lines through the whole window, so that only the time in them changes."""
    if curves.time[-1] - curves.time[0] < WINDOW - _PERIOD:
        return False  # the lines still grow
    lines = {
        "places": [*curves.points.values(), *curves.limits],
        "linear": list(curves.linear.values()),
        "angular": list(curves.angular.values()),
        "momenta": [curves.momentum, curves.angular_momentum],
    }
    return not curves.pushed.any() and all(
        np.ptp(values) < _SAME * LEAST[plot] for plot, ys in lines.items() for values in ys
    )


def _window(times: np.ndarray) -> np.ndarray:
    """The time axis: the samples' times between the two ends of the window.

    uPlot lays out an axis only when its ends change; so they do, by less than can be seen, while the first
    window fills.
    """
    end = max(float(times[-1]), WINDOW + _UNSEEN * len(times))
    return np.concatenate([[min(end - WINDOW, float(times[0]))], times, [end]])


def _framed(values: np.ndarray) -> np.ndarray:
    """Values over the time axis; nothing is drawn between the last one and the end of the window.

    uPlot looks for the smallest and largest value from the first one on, which has to be a number.
    """
    first = values[0] if np.isfinite(values[0]) else 0.0
    return np.concatenate([[first], values, [np.nan]])


def _held(values: np.ndarray) -> np.ndarray:
    """Values of a band, with the last one that exists where there is none: a band has no gaps."""
    there = np.flatnonzero(np.isfinite(values))
    if not there.size:
        return np.zeros_like(values)
    last = np.maximum.accumulate(np.where(np.isfinite(values), np.arange(len(values)), there[0]))
    return np.asarray(values[last])


def _rates() -> list[dict[str, Any]]:
    return [_line(kind, color, dash) for kind, (color, dash) in _KINDS.items()]


def _kept_line(color: Color) -> dict[str, Any]:
    """A curve of a kept run: dashed and pale, without a name of its own."""
    return {**_line("", color, [4, 4]), "stroke": _css(color, 0.75)}


def _thin_line(color: Color) -> dict[str, Any]:
    """A curve of the robot beside the first: thin, without a name of its own."""
    return {**_line("", color), "width": 0.8}


def _line(label: str, color: Color, dash: list[int] | None = None) -> dict[str, Any]:
    series: dict[str, Any] = {"label": label, "stroke": _css(color), "width": 1.6, "points": {"show": False}}
    if dash:
        series["dash"] = dash
    return series


def _plot(
    gui: viser.GuiApi,
    title: str,
    lines: list[dict[str, Any]],
    soft: float,
    bands: tuple[Any, ...] | None = None,
) -> Any:
    """A plot whose y axis shows at least from -soft to soft, and a column wherever a push acts."""
    gui.add_html(html.plot_title(title, [(line["label"], line["stroke"], "dash" in line) for line in lines]))
    push = {
        "scale": "push",
        "stroke": "rgba(0,0,0,0)",
        "fill": _css(GREY, 0.28),  # on white as on black
        "width": 0,
        "points": {"show": False},
    }
    nothing = np.zeros(2)
    limit = {"pad": 0.08, "mode": 1}
    return gui.add_uplot(
        (np.array([0.0, WINDOW]), *(nothing for _ in lines), nothing, nothing),
        ({}, *lines, cursor.SERIES, push),  # type: ignore[arg-type]
        bands=bands,
        scales={
            "x": {"time": False},
            "y": {"range": {"min": {**limit, "soft": -soft}, "max": {**limit, "soft": soft}}},
            "push": {"range": (0.0, 1.0)},
        },
        axes=({**_AXIS, "size": 20}, {**_AXIS, "size": 36, "space": 20}),  # type: ignore[typeddict-item]
        legend={"show": False},
        height=_HEIGHT,
        padding=(4, 10, 0, 0),
    )


def _css(color: Color, opacity: float = 1.0) -> str:
    red, green, blue = color
    return f"rgba({red},{green},{blue},{opacity:g})"
