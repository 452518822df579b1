"""What came of a run, in one line: seconds count from the latest push, as in the table of differences."""

from __future__ import annotations

from momentum_lab.experiments.rest import com_speeds, rest_time
from momentum_lab.finished import FinishedRun
from momentum_lab.summary import Summary


def outcome(run: FinishedRun, summary: Summary) -> str:
    """Whether the robot fell, came to rest or still moves, and when; at least one sample is recorded."""
    if run.lay_there:
        return "Had fallen already when it came"
    if summary.fell and summary.fall_time is not None:
        return f"Fell {_after(run, summary.fall_time, summary.fall_time)}: {summary.fall_reason}"
    times, speeds = run.recording.column("time"), com_speeds(run)
    pushed = _pushed(run, summary.seconds)
    rest = rest_time(times, speeds, 0.0 if pushed is None else pushed)
    if rest is None:
        return f"Stands and still moves {_after(run, summary.seconds, summary.seconds)}"
    if rest == times[0]:
        return "Stands, at rest in all that is recorded"
    return f"Stands, at rest {_after(run, rest, summary.seconds)}"


def _after(run: FinishedRun, time: float, until: float) -> str:
    """A time as it is told: since the latest push that had begun until another."""
    pushed = _pushed(run, until)
    if pushed is None:
        return f"{time:.2f} s after the start"
    several = len([push for push in run.pushes if push.start < until]) > 1
    return f"{time - pushed:.2f} s after the {'latest ' if several else ''}push"


def _pushed(run: FinishedRun, until: float) -> float | None:
    """When the latest push before a time began, s; None without one."""
    return max((push.start for push in run.pushes if push.start < until), default=None)
