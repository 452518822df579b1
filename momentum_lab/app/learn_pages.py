"""The pages of the lessons' panel: one for each kind of step. A page is built anew, and thrown away as a whole."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import viser

from momentum_lab.app import learn_html
from momentum_lab.app.learn_controls import TryOut
from momentum_lab.app.learn_style import LIST
from momentum_lab.app.lesson_wire import LessonEvent, PlayRun
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.walk import Walk
from momentum_lab.app.widgets import Bound, Post, nice_step
from momentum_lab.app.wire import Truth
from momentum_lab.events import LookBack
from momentum_lab.lesson.record import EquationRecord
from momentum_lab.palette import BLUE

# How often an equation's numbers change, s.
_PERIOD = 0.1
Answer = Callable[[int, Callable[[], float]], None]
"""Takes a prediction: of which step, and how it is read, so that of two quick changes the last one counts."""
_OPEN, _CHOSEN = viser.Icon.CIRCLE, viser.Icon.CIRCLE_DOT


@dataclass(frozen=True, slots=True)
class Desk:
    """What pages are made with.

    Attributes:
        gui: where widgets go.
        post: where a hand's events go.
        ask: where a lesson's events go.
        answer: what takes a prediction.
        now: who plays, and what is the case.
    """

    gui: viser.GuiApi
    post: Post
    ask: Callable[[LessonEvent], None]
    answer: Answer
    now: Callable[[], tuple[LoadedRobot, Truth]]


class Page:
    """A step on the screen.

    Args:
        desk: what it is made with.
        walk: the way through the lesson.
    """

    def __init__(self, desk: Desk, walk: Walk) -> None:
        self._desk, self._walk = desk, walk
        self._step = walk.step
        self._build()

    def _build(self) -> None:
        self._desk.gui.add_html(learn_html.text(self._step.text))

    def refresh(self) -> None:
        """Show what has changed in the way through the lesson."""

    def follow(self, truth: Truth, simulated: float) -> None:
        """Show what is the case at a simulated time, s."""

    def push(self) -> bool:
        """Push as the page says; False if it does not."""
        return False

    def hand_in(self) -> None:
        """Say what has been changed last: viser tells each change in a thread of its own, and one may be late."""


class ChoicePage(Page):
    """A prediction by choosing."""

    def _build(self) -> None:
        super()._build()
        gui, self._place = self._desk.gui, self._walk.place
        gui.add_html(LIST)
        self._buttons = [self._option(gui, place, words) for place, words in enumerate(self._step.options)]
        self.refresh()

    def refresh(self) -> None:
        """Show what has changed in the way through the lesson."""
        answer = self._walk.answers.get(self._place)
        for place, button in enumerate(self._buttons):
            button.icon = _CHOSEN if place == answer else _OPEN
            button.disabled = self._walk.frozen

    def _option(self, gui: viser.GuiApi, place: int, words: str) -> viser.GuiButtonHandle:
        button = gui.add_button(f"{learn_html.LETTERS[place]}  {words}", color="gray", icon=_OPEN)
        button.on_click(lambda _: self._desk.answer(self._place, lambda: float(place)))
        return button


class NumberPage(Page):
    """A prediction by number."""

    def _build(self) -> None:
        gui, step, self._place = self._desk.gui, self._step, self._walk.place
        self._shown = gui.add_html("")
        middle = 0.5 * (step.low + step.high)
        unit = f" ({step.unit})" if step.unit else ""
        width = nice_step(step.low, step.high, middle)
        self._said = self._walk.answers.get(self._place, middle)
        self._slider: Any = gui.add_slider(f"I predict{unit}", step.low, step.high, width, self._said)
        self._button = gui.add_button("That is my prediction", color=BLUE, icon=viser.Icon.CHECK)
        # What is typed or slid is the prediction at once; the button is for a learner whom the middle suits.
        self._button.on_click(lambda _: self._desk.answer(self._place, self._value))
        self._slider.on_update(lambda _: self._desk.answer(self._place, self._value))
        self.refresh()

    def hand_in(self) -> None:
        """Say what has been typed or slid last."""
        if self._value() != self._said:
            self._desk.answer(self._place, self._value)

    def _value(self) -> float:
        """What the slider says; not a number if it says nothing that can be predicted."""
        return min(max(float(self._slider.value), self._step.low), self._step.high)

    def refresh(self) -> None:
        """Show what has changed in the way through the lesson."""
        self._shown.content = learn_html.said(self._step, self._walk.answers.get(self._place))
        self._slider.visible = self._button.visible = not self._walk.frozen


class PlayPage(Page):
    """The runs, one after the other, and then the controls that matter."""

    def _build(self) -> None:
        super()._build()
        gui = self._desk.gui
        self._try_out: TryOut | None = None
        self._labels = self._walk.runs_to_play()
        self._runs = gui.add_html("")
        self._button = gui.add_button("Play", color=BLUE, icon=viser.Icon.PLAYER_PLAY)
        self._button.on_click(lambda _: self._desk.ask(PlayRun(self._next())))
        self.refresh()

    def refresh(self) -> None:
        """Show what has changed in the way through the lesson."""
        seen, on_stage = self._walk.news.seen, self._walk.news.on_stage
        text = learn_html.runs(self._labels, seen, on_stage)
        if text != self._runs.content:
            self._runs.content = text
        label = self._next()
        words = "Play the run" if label not in seen else "Play it again"
        words += f": {learn_html.spoken(label)}" if len(self._labels) > 1 else ""
        if words != self._button.label:
            self._button.label = words
        if self._try_out is None and self._walk.all_seen and self._step.controls:
            self._desk.gui.add_html(learn_html.text("Now try it yourself."))
            scenario = self._walk.record.runs[self._step.run]
            desk = self._desk
            self._try_out = TryOut(desk.gui, desk.post, self._step.controls, scenario, *desk.now())

    def follow(self, truth: Truth, simulated: float) -> None:
        """Show what is the case at a simulated time, s."""
        if self._try_out is not None:
            self._try_out.follow(truth)

    def push(self) -> bool:
        """Push as the page says; False if it does not."""
        if self._try_out is None or not self._try_out.pushes:
            return False
        self._try_out.push()
        return True

    def _next(self) -> str:
        """The first run that has not been seen; then they go round."""
        news = self._walk.news
        unseen = [label for label in self._labels if label not in news.seen]
        if unseen:
            return unseen[0]
        last = self._labels.index(news.on_stage) if news.on_stage in self._labels else -1
        return self._labels[(last + 1) % len(self._labels)]


class ComparePage(Page):
    """Predictions beside what was measured."""

    def _build(self) -> None:
        gui = self._desk.gui
        self._cards = gui.add_html("")
        super()._build()
        self._source = gui.add_html("")
        self.refresh()

    def refresh(self) -> None:
        """Show what has changed in the way through the lesson."""
        cards = "".join(learn_html.compared(*pair) for pair in self._walk.to_compare())
        if cards != self._cards.content:
            self._cards.content = cards
        source = learn_html.source(self._walk.measured_in_sight)
        if source != self._source.content:
            self._source.content = source


class ExplainPage(Page):
    """An equation that carries the numbers of the instant that is looked at."""

    def _build(self) -> None:
        super()._build()
        gui, step = self._desk.gui, self._step
        self._next, self._time = -math.inf, -1.0
        self._equation = gui.add_html("")
        record = self._record
        end = max(record.ticks - 1, 1) * record.timestep
        self._slider: Bound[float] = Bound(
            gui.add_slider("instant (s)", 0.0, end, record.timestep * 5, min(step.time, end)),
            lambda instant: LookBack(max(0.0, end - instant)),
            self._desk.post,
        )
        button = gui.add_button("Watch the run", color="gray", icon=viser.Icon.PLAYER_PLAY)
        button.on_click(lambda _: self._desk.ask(PlayRun(step.run)))
        self._show(step.time)

    @property
    def _record(self) -> EquationRecord:
        record = self._walk.step.equation
        assert record is not None
        return record

    def follow(self, truth: Truth, simulated: float) -> None:
        """Show what is the case at a simulated time, s."""
        if self._walk.news.on_stage != self._step.run:
            return
        self._slider.follow(simulated)
        now = time.monotonic()
        if (now >= self._next or not truth.playing) and simulated != self._time:
            self._next = now + _PERIOD
            self._show(simulated)

    def _show(self, instant: float) -> None:
        self._time = instant
        self._equation.content = learn_html.equation(self._record, instant)


PAGES: dict[str, type[Page]] = {
    "prose": Page,
    "choice": ChoicePage,
    "number": NumberPage,
    "play": PlayPage,
    "compare": ComparePage,
    "explain": ExplainPage,
}
