"""The part of a run that pictures and films show: what happens around its pushes, without the idle time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from momentum_lab.experiments.rest import com_speeds, rest_time
from momentum_lab.finished import FinishedRun
from momentum_lab.physics.push import Push
from momentum_lab.recording import Recording

# What is shown before the first push, and after all has come to its end, s.
_BEFORE, _AFTER = 1.0, 5.0
# Times that are closer than this are the same tick, s.
_SAME = 1e-6


@dataclass(frozen=True, slots=True)
class Window:
    """A stretch of a run, both ends included, s."""

    start: float
    end: float

    def holds(self, push: Push) -> bool:
        """Whether some of a push is in it."""
        return push.start <= self.end and self.start < push.start + push.duration

    def joined(self, other: Window) -> Window:
        """Both, and what is between them."""
        return Window(min(self.start, other.start), max(self.end, other.end))


def window(pushes: Sequence[Push], recorded: Window, fall: float | None, rest: float | None) -> Window:
    """From 1 s before the first push to 5 s after the robot's rest or fall; all that is recorded without a push.

    Args:
        pushes: of the run; what is not recorded of them does not count.
        recorded: from when to when there are samples.
        fall: when the robot fell, s; None if it has not.
        rest: when it came to rest after the last push, s; None if it has not.
    """
    begins = [push.start for push in pushes if recorded.holds(push)]
    if not begins:
        return recorded
    ends = [push.start + push.duration for push in pushes if recorded.holds(push)]
    if fall is not None and fall >= recorded.start:
        begins.append(fall)  # what made it fall may have been something else
    over = fall if fall is not None else rest
    end = recorded.end if over is None else max(over, *ends) + _AFTER
    return Window(max(recorded.start, min(begins) - _BEFORE), min(recorded.end, end))


def time_span(run: FinishedRun) -> Window:
    """From when to when a run has samples; it must have one."""
    times = run.recording.column("time")
    return Window(float(times[0]), float(times[-1]))


def around_pushes(run: FinishedRun) -> FinishedRun:
    """The run with the samples of its window only, and with the pushes that are in it; of two robots, of both.

    A run without samples stays as it is.
    """
    if not len(run.recording):
        return run
    whole, part = time_span(run), _window_of(run)
    if run.beside is not None and len(run.beside.recording):
        part = part.joined(_window_of(run.beside))
    pushes = tuple(push for push in run.pushes if whole.holds(push))
    beside = None if run.beside is None else replace(_cut(run.beside, part), pushes=pushes)
    return replace(_cut(run, part), pushes=pushes, beside=beside)


def _window_of(run: FinishedRun) -> Window:
    """The window of one robot."""
    whole = time_span(run)
    latest = max((push.start for push in run.pushes if whole.holds(push)), default=whole.start)
    rest = rest_time(run.recording.column("time"), com_speeds(run), latest)
    return window(run.pushes, whole, None if run.fall is None else run.fall.time, rest)


def _cut(run: FinishedRun, part: Window) -> FinishedRun:
    """The run with the samples of a stretch only."""
    times = run.recording.column("time")
    start, end = np.searchsorted(times, (part.start - _SAME, part.end + _SAME))
    if end - start == len(times):
        return run
    recording = Recording(run.recording.layout, max(1, end - start))
    for row in run.recording.rows()[start:end]:
        recording.next_row()[:] = row
    return replace(run, recording=recording)
