"""The lessons' panel: a list with progress, then a lesson step by step; leaving it gives back what was before."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import viser

from momentum_lab.app import learn_html
from momentum_lab.app.learn_pages import PAGES, Desk, Page
from momentum_lab.app.lesson_wire import LeaveLesson, LessonEvent, LessonNews, OpenLesson, ShowRun
from momentum_lab.app.library import Entry, Library
from momentum_lab.app.progress import Progress, ProgressStore
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.walk import Walk
from momentum_lab.app.widgets import Post
from momentum_lab.app.wire import Truth
from momentum_lab.errors import LabError
from momentum_lab.lesson.record import LessonRecord

_BACK, _LEAVE = "Back  (U)", "Leave the lesson"
_NEXT, _SKIP, _FINISH = "Next  (I)", "Skip  (I)", "Finish  (I)"
_END = 1e6  # behind the end of every run, s
_BLUE = (0, 114, 178)


class LearnPanel:
    """The widgets of the tab of lessons.

    Args:
        client: the browser tab.
        tab: where they go.
        library: the lessons.
        post: where a hand's events go.
        ask: where a lesson's events go.
        tell: shows a person what was wrong.
        opened: told whether a lesson is open.
        truth: what is the case at the start.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        tab: Any,
        library: Library,
        post: Post,
        ask: Callable[[LessonEvent], None],
        tell: Callable[[str], None],
        opened: Callable[[bool], None],
        truth: Truth,
    ) -> None:
        self._client, self._gui, self._tab, self._library = client, client.gui, tab, library
        self._post, self._ask, self._tell, self._opened = post, ask, tell, opened
        self._store = ProgressStore(client)
        self._lock = threading.RLock()
        self._robot: LoadedRobot | None = None
        self._truth = truth
        self._entry: Entry | None = None
        self._walk: Walk | None = None
        self._page: Page | None = None
        self._body: viser.GuiFormHandle | None = None
        self._ready = threading.Event()
        self._add_frame()
        self._add_commands()

    def start(self, first: Path | None = None) -> None:
        """Show the list, or open a lesson; what the browser remembers is asked for meanwhile."""
        threading.Thread(target=self._start, args=(first,), name="lessons", daemon=True).start()

    def set_robot(self, robot: LoadedRobot) -> None:
        """Take note of who plays."""
        self._robot = robot
        self._ready.set()

    def follow(self, truth: Truth, simulated: float, news: LessonNews | None) -> None:
        """Show what is the case, and how far the lesson has come."""
        with self._lock:
            self._truth = truth
            if self._walk is None or self._page is None:
                return
            if news is not None:
                self._hear(self._walk, news)
            if self._page is not None:
                self._page.follow(truth, simulated)

    def push(self) -> bool:
        """Push as the open lesson says; False if none is open."""
        with self._lock:
            if self._walk is None:
                return False
            if self._page is None or not self._page.push():
                self._tell("Push: this step of the lesson has no push of your own")
            return True

    # The list.

    def _start(self, first: Path | None) -> None:
        self._ready.wait()
        self._store.load([entry.key for entry in self._library.entries()])
        entry = next((one for one in self._library.entries() if one.file == first), None)
        if entry is None:
            self._show_list()
        else:
            self._open(entry)

    def _show_list(self) -> None:
        entries = self._library.entries()
        self._entry = None
        self._frame()
        with self._fresh():
            done = sum(self._store.get(entry.key).done for entry in entries)
            self._gui.add_html(learn_html.welcome(done, len(entries)))
            for entry in entries:
                self._add_entry(entry)

    def _add_entry(self, entry: Entry) -> None:
        progress = self._store.get(entry.key)
        icon = viser.Icon.CIRCLE
        if entry.error:
            icon = viser.Icon.ALERT_TRIANGLE
        elif progress.done:
            icon = viser.Icon.CIRCLE_CHECK
        elif progress.step or progress.answers:
            icon = viser.Icon.PROGRESS
        title = f"{entry.number}. {entry.title}"
        button = self._gui.add_button(title, color="gray", icon=icon, hint=entry.error or entry.question)
        button.on_click(lambda _: self._open(entry))

    # Opening and leaving.

    def _open(self, entry: Entry) -> None:
        with self._fresh():
            self._entry = entry
            self._gui.add_html(learn_html.waiting(entry.title))
            self._gui.add_progress_bar(100.0, animated=True)
        try:
            record = self._library.rehearse(entry.file, self._truth.robot)
        except LabError as error:
            self._show_error(str(error))
            return
        self._begin(entry, record)

    def _begin(self, entry: Entry, record: LessonRecord) -> None:
        with self._lock:
            if self._entry is not entry:
                return  # the person has gone elsewhere meanwhile
            saved = self._store.get(entry.key)
            asked = {place: value for place, value in saved.answers.items() if place < len(record.steps)}
            place = saved.step if saved.step < len(record.steps) else 0
            self._walk = Walk(record, 0, {} if saved.done else asked)
            self._ask(OpenLesson(record.file, record.robot))
            self._opened(True)
            self._go(0 if saved.done else place)

    def _show_error(self, words: str) -> None:
        entry = self._entry
        with self._fresh():
            self._entry = entry
            self._gui.add_html(learn_html.error(words))
            again = self._gui.add_button("Try again", color="gray", icon=viser.Icon.RELOAD)
            back = self._gui.add_button("All lessons", color="gray", icon=viser.Icon.LIST)
        if entry is not None:
            again.on_click(lambda _: self._open(entry))
        back.on_click(lambda _: self._show_list())

    def _leave(self) -> None:
        with self._lock:
            if self._walk is not None:
                self._walk = self._page = None
                self._ask(LeaveLesson())
                self._opened(False)
        self._show_list()

    # Step by step.

    def _go(self, place: int) -> None:
        """Open a step, and put on stage what it is about."""
        walk = self._walk
        if walk is None:
            return
        walk.place = min(max(place, 0), len(walk.record.steps) - 1)
        self._stage(walk)
        with self._fresh():
            desk = Desk(self._gui, self._post, self._ask, self._answer, self._now)
            if walk.record.failed and walk.step.kind == "compare":
                self._gui.add_html(learn_html.claims(walk.record.failed))
            self._page = PAGES[walk.step.kind](desk, walk)
        record = walk.record
        self._heading.content = learn_html.heading(
            record.number, record.title, record.question, walk.place, len(record.steps)
        )
        self._frame()
        self._save()

    def _now(self) -> tuple[LoadedRobot, Truth]:
        """Who plays, and what is the case."""
        assert self._robot is not None
        return self._robot, self._truth

    def _stage(self, walk: Walk) -> None:
        step = walk.step
        if step.kind == "explain":
            self._ask(ShowRun(step.run, step.time))
        elif step.kind == "play" and not walk.news.seen:
            self._ask(ShowRun(step.run, 0.0))
        elif step.kind == "compare" and not walk.news.seen:
            self._ask(ShowRun(walk.played, _END))

    def _answer(self, value: float) -> None:
        with self._lock:
            walk, page = self._walk, self._page
            if walk is None or page is None or walk.frozen:
                return
            walk.answers[walk.place] = value
            page.refresh()
            self._frame()
            self._save()

    def _hear(self, walk: Walk, news: LessonNews) -> None:
        """Take note of how far the lesson has come in the session's process."""
        if news.error:
            self._walk = self._page = None
            self._opened(False)
            self._ask(LeaveLesson())
            self._show_error(news.error)
            return
        if news.file != walk.rehearsed.file:
            return
        walk.news = news
        if self._page is not None:
            with self._body or self._tab:
                self._page.refresh()
        self._frame()

    def _next(self) -> None:
        with self._lock:
            walk = self._walk
            if walk is None or walk.waits:
                return
            if walk.last:
                self._finish()
            else:
                self._go(walk.place + 1)

    def _back(self) -> None:
        with self._lock:
            if self._walk is not None and self._walk.place:
                self._go(self._walk.place - 1)

    def _finish(self) -> None:
        if self._entry is not None:
            self._store.set(self._entry.key, Progress(done=True))
        self._leave()

    def _save(self) -> None:
        if self._walk is not None and self._entry is not None:
            done = self._store.get(self._entry.key).done
            progress = Progress(self._walk.place, done, dict(self._walk.answers))
            self._store.set(self._entry.key, progress)

    # The frame around a step: it stays where it is, so that a key that is pressed again finds the same button.

    def _add_frame(self) -> None:
        with self._tab:
            self._heading = self._gui.add_html("", order=1.0, visible=False)
            self._forward = self._gui.add_button(_NEXT, color=_BLUE, order=4.0, visible=False)
            self._others = self._gui.add_button_group(" ", (_BACK, _LEAVE), order=5.0, visible=False)
        self._forward.on_click(lambda _: self._next())
        self._others.on_click(lambda event: self._back() if event.target.value == _BACK else self._leave())

    def _add_commands(self) -> None:
        self._gui.add_command("Next step of the lesson", hotkey="I").on_trigger(lambda _: self._next())
        self._gui.add_command("Previous step of the lesson", hotkey="U").on_trigger(lambda _: self._back())

    def _frame(self) -> None:
        """Show what is around a step, with the buttons that make sense."""
        walk = self._walk
        for handle in (self._heading, self._forward, self._others):
            handle.visible = walk is not None
        if walk is not None:
            self._forward.label, self._forward.disabled = _way_on(walk), walk.waits
            others = (_BACK, _LEAVE) if walk.place else (_LEAVE,)
            if others != self._others.options:
                self._others.options = others

    @contextlib.contextmanager
    def _fresh(self) -> Iterator[None]:
        """An empty page instead of the one before."""
        with self._lock, self._client.atomic():
            self._page = None
            if self._body is not None:
                self._body.remove()
            with self._tab:
                self._body = self._gui.add_form(None, order=3.0)
            with self._body:
                yield


def _way_on(walk: Walk) -> str:
    """What the button says that leads to the next step."""
    if walk.waits:
        return "Predict first"
    if walk.step.kind == "play" and not walk.all_seen:
        return _SKIP
    return _FINISH if walk.last else _NEXT
