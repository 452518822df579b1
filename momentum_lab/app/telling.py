"""How the robots of a browser tab are doing: one in a line, two in a line with their names."""

from __future__ import annotations

from momentum_lab.active_bounds import bounds_of
from momentum_lab.app.bounds_panel import situation_of
from momentum_lab.app.differences import LAY_THERE, names_of
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.wire import Frame, Truth, rows_of
from momentum_lab.fall import Fall
from momentum_lab.recording import Sample
from momentum_lab.status import Kind, Status, status_of

# The worst of two is the colour of both, the worst last.
_GRAVITY: tuple[Kind, ...] = ("standing", "border", "lifted", "solver", "stopped", "fallen")


def told(frame: Frame, sample: Sample, loaded: LoadedRobot) -> Status:
    """The most important thing to say about the robots of a frame.

    Args:
        frame: what is new.
        sample: the first robot's.
        loaded: which robot they are.
    """
    first = _one(frame.truth, sample, loaded)
    if frame.other is None:
        return first
    beside = Sample.of(loaded.layout, rows_of(frame.other.row, loaded.layout.width)[0])
    second = _one(frame.other.truth, beside, loaded)
    truths = (frame.truth, frame.other.truth)
    return both((first, second), truths, frame.other.names or names_of(*truths))


def both(statuses: tuple[Status, Status], truths: tuple[Truth, Truth], names: tuple[str, str]) -> Status:
    """Two robots in one line, by the names over their heads; one with the words of both if they do the same."""
    short = [_short(status, truth) for status, truth in zip(statuses, truths, strict=True)]
    worst = max(statuses, key=lambda status: _GRAVITY.index(status.kind))
    if short[0] == short[1]:
        return Status(worst.kind, f"both: {short[0]}", worst.color)
    parts = [f"{name}: {words}" for name, words in zip(names, short, strict=True)]
    return Status(worst.kind, "; ".join(parts), worst.color)


def _one(truth: Truth, sample: Sample, loaded: LoadedRobot) -> Status:
    fall = None if truth.fall is None else Fall(truth.fall.time, truth.fall.reason)
    status = status_of(sample, loaded.model, fall, truth.failure, truth.stopped)
    if status.kind != "border":
        return status  # bounds are worked out only where they are told
    held = bounds_of(sample, situation_of(loaded.model, truth)).active
    return status_of(sample, loaded.model, held=held)


def _short(status: Status, truth: Truth) -> str:
    """What matters of a status where there is room for half a line."""
    if status.kind == "fallen" and truth.lay_there:
        return LAY_THERE
    if status.kind == "fallen" and truth.fall is not None:
        return f"fell at {truth.fall.time:.2f} s"
    if status.kind == "border":
        return status.words.partition(": ")[2].replace("gives way", "short")
    return status.words.partition(": ")[0]
