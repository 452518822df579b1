"""What holds the robot back now: the bounds of feet and joints, what was asked for and what was granted."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable
from html import escape

import viser

from momentum_lab.active_bounds import ACTIVE, Active, Bounds, Goal, Situation, bounds_of, in_words
from momentum_lab.app.steady import steady
from momentum_lab.app.wire import Truth
from momentum_lab.recording import Sample
from momentum_lab.robot.model import RobotModel

# How often it changes on the screen, s.
_PERIOD = 0.15
_NONE = "–"
# So many figures, a minus sign among them, have room in a number.
_WHOLE = 5
_EXPLAINED = f"(from {100 * ACTIVE:.0f} % of a limit on)"
# Lines that are too long end in dots: what is below keeps its place.
_CUT = 'style="white-space:nowrap;overflow:hidden;text-overflow:ellipsis"'
# A tab that is longer than the page has its scroll bar over the last letter of a full row.
_TABLE = '<table class="n" style="width:calc(100% - .8em);border-collapse:collapse;table-layout:fixed">'
_RIGHT = 'style="text-align:right;width:4em"'


class BoundsPanel:
    """A few lines of text that follow the robot.

    Args:
        gui: where they go.
        clock: seconds, for tests.
    """

    def __init__(self, gui: viser.GuiApi, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._handle = gui.add_html("")
        self._text, self._next = "", -math.inf

    def see(self, sample: Sample, robot: RobotModel, truth: Truth) -> None:
        """Show what holds the robot in a sample: at once in a pause, else a few times a second."""
        if truth.playing and self._clock() < self._next:
            return
        self._next = self._clock() + _PERIOD
        failure = truth.failure if sample.number("solver_failed") else None
        text = in_html(bounds_of(sample, situation_of(robot, truth)), robot.foot_names, failure)
        if text != self._text:
            self._text = self._handle.content = text


def situation_of(robot: RobotModel, truth: Truth) -> Situation:
    """What is the case, as far as bounds depend on it."""
    return Situation(robot, truth.controller, truth.gains, truth.friction, truth.mismatch.torque_scale)


def in_html(bounds: Bounds, feet: Iterable[str], failure: str | None = None) -> str:
    """One line for each foot, one for all joints, and a table of the goals; always as many lines.

    Args:
        bounds: what there is to say.
        feet: names of the feet.
        failure: why the controller has no answer; None when it has one.
    """
    lines = [(f"{name} foot", _of_foot(held)) for name, held in zip(feet, bounds.feet, strict=True)]
    rows = "".join(
        f'<tr><td style="width:5.6em">{escape(name)}</td><td {_CUT} title="{escape(words)}">{escape(words)}</td></tr>'
        for name, words in [*lines, ("joints", in_words(bounds.joints) or _NONE)]
    )
    goals = "".join(_goal(goal) for goal in bounds.goals)
    head = f"<tr><td></td><td {_RIGHT}>asked</td><td {_RIGHT}>granted</td><td {_RIGHT}>missing</td></tr>"
    note = escape(_EXPLAINED if failure is None else f"no answer: {failure}")
    title = (
        f'<div {_CUT} title="{note}"><b>What holds the robot back</b> <span class="dim">{note}</span></div>'
    )
    return f'<div class="lab small">{title}{_TABLE}{rows}</table>{_TABLE}{head}{goals}</table></div>'


def _of_foot(held: tuple[Active, ...]) -> str:
    return ", ".join(bound.what for bound in held) or _NONE


def _goal(goal: Goal) -> str:
    cells = "".join(f"<td {_RIGHT}>{_number(each)}</td>" for each in _whole(goal))
    return f"<tr><td {_CUT}>{escape(goal.name)} ({escape(goal.unit)})</td>{cells}</tr>"


def _whole(goal: Goal) -> tuple[float, float, float]:
    """Asked, granted, missing as whole numbers: what is missing is the difference of those that can be read."""
    asked, granted = (float(round(x)) if math.isfinite(x) else x for x in (goal.asked, goal.granted))
    return asked, granted, asked - granted


def _number(value: float) -> str:
    """A whole number with room for a sign and four figures; a dash where there is none, as for a CoP in the air."""
    if not (math.isfinite(value) and abs(value) < 1e5):
        return _NONE
    return steady(value, 0, _WHOLE).replace("-", "−")
