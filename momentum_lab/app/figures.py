"""What is measured of the app, and what each figure has to reach."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

REAL_TIME = (0.99, 1.01)
FEWEST_DRAWINGS = 30.0
MOST_LATE_TICKS = 1.0
MOST_CPU = 0.25
LONGEST_DELAY = 0.06
MOST_GROWTH = 0.5
LONGEST_STALL = 0.2


@dataclass(frozen=True, slots=True)
class AppMeasurement:
    """How the app does with one client that reads as fast as it can.

    Attributes:
        seconds: how long was measured with a push every second and a half.
        real_time_factor: simulated seconds per second, as the page tells it.
        drawings_per_second: pictures of a moving robot received per second.
        messages_per_second: everything received per second.
        late_ticks_per_minute: ticks that began more than 5 ms after they were due.
        stolen: processor time that the host of a virtual machine gave to others, ms per minute; NaN: not told.
        server_cpu: time of the server's process, which draws and does not simulate, per second.
        push_delay: from sending a push to the first drawing that shows it, median, s.
        push_delay_longest: the longest of them, s.
        memory_growth: what server and session grow by after the first minute, MB per minute; None: too short.
        sent_while_paused: messages per second while time stands still.
        drawn_while_standing: changes in the scene per second while the robot stands still and time runs.
        first_picture: from opening a connection to its furnished page, s.
        aged: how many seconds' worth of messages were sent before the second connection, s.
        first_picture_aged: as first_picture, for the second connection, s.
        stall: the longest time without a drawing that the first client sees when the second connects, s.
    """

    seconds: float
    real_time_factor: float
    drawings_per_second: float
    messages_per_second: float
    late_ticks_per_minute: float
    stolen: float
    server_cpu: float
    push_delay: float
    push_delay_longest: float
    memory_growth: float | None
    sent_while_paused: float
    drawn_while_standing: float
    first_picture: float
    aged: float
    first_picture_aged: float
    stall: float


@dataclass(frozen=True, slots=True)
class Figure:
    """One line of the report.

    Attributes:
        name: what was measured, and its unit.
        value: the figure.
        bound: what it has to be; empty: told without a bound.
        reached: whether it is; None: there is no bound, or the run was too short to tell.
    """

    name: str
    value: str
    bound: str
    reached: bool | None


def figures(measured: AppMeasurement) -> list[Figure]:
    """Every line of the report, in the order in which they are told."""
    return [*_pace(measured), *_cost(measured), *_silence(measured), *_newcomer(measured)]


def growth(times: list[float], sizes: list[float]) -> float:
    """Slope of the straight line that fits some sizes best, per unit of time.

    Args:
        times: when the sizes were taken, at least two different ones.
        sizes: the sizes.
    """
    t = np.array(times) - np.mean(times)
    return float(t @ np.array(sizes) / (t @ t))


def longest_gap(times: list[float], start: float, end: float) -> float:
    """The longest time in which nothing came between a start and an end, s."""
    inside = [start, *(time for time in times if start < time < end), end]
    return max(after - before for before, after in pairwise(inside))


def _pace(m: AppMeasurement) -> list[Figure]:
    low, high = REAL_TIME
    return [
        Figure(
            "real-time factor", f"{m.real_time_factor:.3f}", "1.00 ± 0.01", low <= m.real_time_factor <= high
        ),
        _at_least("drawings per second", m.drawings_per_second, FEWEST_DRAWINGS),
        _at_most("ticks over 5 ms late, per minute", m.late_ticks_per_minute, MOST_LATE_TICKS),
        _told("taken by the machine's host, ms per minute", m.stolen),
        _at_most("push to drawing, longest, ms", 1e3 * m.push_delay_longest, 1e3 * LONGEST_DELAY),
        _told("push to drawing, median, ms", 1e3 * m.push_delay),
    ]


def _cost(m: AppMeasurement) -> list[Figure]:
    memory = _at_most("memory growth after a minute, MB/min", m.memory_growth or 0.0, MOST_GROWTH)
    if m.memory_growth is None:
        memory = Figure(memory.name, "too short", memory.bound, None)
    return [_at_most("server CPU for drawing, % of a core", 100.0 * m.server_cpu, 100.0 * MOST_CPU), memory]


def _silence(m: AppMeasurement) -> list[Figure]:
    return [
        _at_most("messages per second, paused", m.sent_while_paused, 0.0),
        _at_most("changes per second, standing still", m.drawn_while_standing, 0.0),
        _told("messages per second, pushed", m.messages_per_second),
    ]


def _newcomer(m: AppMeasurement) -> list[Figure]:
    name = f"stall when a tab opens after {m.aged / 60.0:.0f} min, ms"
    return [
        _at_most(name, 1e3 * m.stall, 1e3 * LONGEST_STALL),
        _told("first picture of the first tab, ms", 1e3 * m.first_picture),
        _told("first picture of that tab, ms", 1e3 * m.first_picture_aged),
    ]


def _at_most(name: str, value: float, bound: float) -> Figure:
    return Figure(name, f"{value:.1f}", f"at most {bound:g}", value <= bound)


def _at_least(name: str, value: float, bound: float) -> Figure:
    return Figure(name, f"{value:.1f}", f"at least {bound:g}", value >= bound)


def _told(name: str, value: float) -> Figure:
    return Figure(name, f"{value:.1f}", "", None)
