"""A lesson that is open, step by step."""

from __future__ import annotations

import math
from collections.abc import Callable

import viser

from momentum_lab.app import learn_html
from momentum_lab.app.learn_frame import LearnFrame
from momentum_lab.app.learn_pages import PAGES, Answer, Desk, Page
from momentum_lab.app.lesson_wire import LessonEvent, LessonNews, OfferRun, ShowRun
from momentum_lab.app.progress import Progress, ProgressStore
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.walk import Walk
from momentum_lab.app.widgets import Post
from momentum_lab.app.wire import Truth
from momentum_lab.lesson.record import LessonRecord

_END = 1e6  # behind the end of every run, s


class LessonPlayer:
    """One lesson from its first step to its last; whoever calls it holds the panel's lock.

    Args:
        record: the lesson, played out of sight.
        key: under which the browser remembers it.
        store: what the browser remembers.
        frame: what stands around a step.
        gui: where widgets go.
        post: where a hand's events go.
        ask: where a lesson's events go.
        look: turns the camera to a named view.
        answer: what takes a prediction.
        now: who plays, and what is the case.
    """

    def __init__(
        self,
        record: LessonRecord,
        key: str,
        store: ProgressStore,
        frame: LearnFrame,
        gui: viser.GuiApi,
        post: Post,
        ask: Callable[[LessonEvent], None],
        look: Callable[[str], None],
        answer: Answer,
        now: Callable[[], tuple[LoadedRobot, Truth]],
    ) -> None:
        self._key, self._store, self._frame, self._ask, self._look = key, store, frame, ask, look
        self._desk = Desk(gui, post, ask, answer, now)
        saved = store.get(key)
        asked = {place: value for place, value in saved.answers.items() if place < len(record.steps)}
        self._walk = Walk(record, 0, {} if saved.done else asked)
        self._first = saved.step if saved.step < len(record.steps) and not saved.done else 0
        self._page: Page | None = None

    @property
    def turns(self) -> bool:
        """Whether the lesson turns the camera."""
        return any(step.view for step in self._walk.rehearsed.steps)

    def start(self) -> None:
        """Open the step at which it was left."""
        self._go(self._first)

    def follow(self, truth: Truth, simulated: float) -> None:
        """Show what is the case at a simulated time, s."""
        if self._page is not None:
            self._page.follow(truth, simulated)

    def push(self) -> bool:
        """Push as the open step says; False if it does not."""
        return self._page is not None and self._page.push()

    def answer(self, place: int, value: float) -> None:
        """Take a prediction of a step, unless it comes too late or is no number."""
        walk, page = self._walk, self._page
        if page is None or place != walk.place or walk.frozen or not math.isfinite(value):
            return
        walk.answers[walk.place] = value
        page.refresh()
        self._frame.show(walk)
        self._save()

    def hear(self, news: LessonNews) -> None:
        """Take note of how far the lesson has come in the session's process."""
        if news.file != self._walk.rehearsed.file:
            return
        self._walk.news = news
        if self._page is not None:
            with self._frame.page:
                self._page.refresh()
        self._frame.show(self._walk)

    def forward(self) -> bool:
        """Open the next step, if it may come; False behind the last one."""
        if self._page is not None:
            self._page.hand_in()
        if self._walk.waits:
            return True
        if self._walk.last:
            self._store.set(self._key, Progress(done=True))
            return False
        self._go(self._walk.place + 1)
        return True

    def back(self) -> None:
        """Open the step before."""
        if self._walk.place:
            self._go(self._walk.place - 1)

    def _go(self, place: int) -> None:
        """Open a step, and put on stage what it is about."""
        walk, self._page = self._walk, None
        walk.place = min(max(place, 0), len(walk.record.steps) - 1)
        self._stage(walk)
        with self._frame.fresh():
            if walk.record.failed and walk.step.kind == "compare":
                self._desk.gui.add_html(learn_html.claims(walk.record.failed))
            self._page = PAGES[walk.step.kind](self._desk, walk)
        self._frame.head(walk)
        self._frame.show(walk)
        self._save()

    def _stage(self, walk: Walk) -> None:
        step, seen = walk.step, walk.news.seen
        if step.view:
            self._look(step.view)
        if step.kind == "explain":
            self._ask(ShowRun(step.run, step.time))
        elif step.kind == "play" and step.run not in seen:
            self._ask(OfferRun(step.run))
        elif step.kind == "compare" and walk.played not in seen:
            self._ask(ShowRun(walk.played, _END))

    def _save(self) -> None:
        done = self._store.get(self._key).done
        self._store.set(self._key, Progress(self._walk.place, done, dict(self._walk.answers)))
