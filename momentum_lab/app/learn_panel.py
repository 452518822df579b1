"""The lessons' panel: a list with progress, then a lesson step by step; leaving it gives back what was before."""

from __future__ import annotations

import contextlib
import functools
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import viser

from momentum_lab.app.camera import START_VIEW
from momentum_lab.app.learn_frame import LearnFrame
from momentum_lab.app.learn_list import error_page, list_page, waiting_page
from momentum_lab.app.learn_player import LessonPlayer
from momentum_lab.app.lesson_wire import LeaveLesson, LessonEvent, LessonNews, OpenLesson
from momentum_lab.app.library import Entry, Library
from momentum_lab.app.progress import ProgressStore
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.widgets import Post
from momentum_lab.app.wire import Truth
from momentum_lab.errors import LabError
from momentum_lab.lesson.record import LessonRecord


class LearnPanel:
    """The widgets of the tab of lessons.

    Args:
        client: the browser tab.
        tab: where they go.
        library: the lessons.
        post: where a hand's events go.
        ask: where a lesson's events go.
        tell: shows a person what was wrong.
        look: turns the camera to a named view.
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
        look: Callable[[str], None],
        opened: Callable[[bool], None],
        truth: Truth,
    ) -> None:
        self._gui, self._library = client.gui, library
        self._post, self._ask, self._tell, self._opened = post, ask, tell, opened
        self._look = look
        self._store = ProgressStore(client)
        self._lock = threading.RLock()
        self._robot: LoadedRobot | None = None
        self._truth = truth
        self._entry: Entry | None = None
        self._player: LessonPlayer | None = None
        self._ready, self._remembered = threading.Event(), threading.Event()
        self._closed = False
        self._frame = LearnFrame(client, tab, self._next, self._back, self._leave)

    def start(self, first: Path | None = None) -> None:
        """Listen to keys, show the list or open a lesson; what the browser remembers is asked for meanwhile."""
        self._frame.listen()
        threading.Thread(target=self._start, args=(first,), name="lessons", daemon=True).start()

    def close(self) -> None:
        """The tab has gone: nothing is shown any more."""
        self._closed = True
        self._ready.set()
        self._remembered.set()

    def set_robot(self, robot: LoadedRobot) -> None:
        """Take note of who plays."""
        self._robot = robot
        self._ready.set()

    def follow(self, truth: Truth, simulated: float, news: LessonNews | None) -> None:
        """Show what is the case, and how far the lesson has come."""
        with self._lock:
            self._truth = truth
            if self._player is not None and news is not None and news.error:
                self._put_away()
                self._show_error(news.error)
            if self._player is not None:
                if news is not None:
                    self._player.hear(news)
                self._player.follow(truth, simulated)

    def push(self) -> bool:
        """Push as the open lesson says; False if none is open."""
        with self._lock:
            if self._player is None:
                return False
            if not self._player.push():
                self._tell("Push: this step of the lesson has no push of your own")
            return True

    # The list.

    def _start(self, first: Path | None) -> None:
        self._ready.wait()
        if self._closed:
            return
        entries = self._library.entries()
        entry = next((one for one in entries if one.file == first), None)
        if entry is None:
            self._show_list()
        else:
            threading.Thread(target=self._open, args=(entry,), name="first lesson", daemon=True).start()
        threading.Thread(target=self._look_through, args=(entries,), name="faults", daemon=True).start()
        known = self._store.load([one.key for one in entries])
        self._remembered.set()
        with self._lock:
            if known and self._entry is None and not self._closed:
                self._show_list()

    def _look_through(self, shown: list[Entry]) -> None:
        """Mark the lessons that turn out to have an error."""
        found = self._library.look_through()
        with self._lock:
            if found != shown and self._entry is None and not self._closed:
                self._show_list()

    def _show_list(self) -> None:
        entries = self._library.entries()
        self._entry = None
        with self._fresh():
            list_page(self._gui, entries, self._store, self._open)

    # Opening and leaving.

    def _open(self, entry: Entry) -> None:
        """Open a lesson where the browser left it; it may take a while to say where that was."""
        with self._fresh():
            self._entry = entry
            waiting_page(self._gui, entry)
        try:
            record = self._library.rehearse(entry.file, self._truth.robot)
        except LabError as error:
            with self._lock:
                if self._entry is entry and not self._closed:  # or the person has gone elsewhere meanwhile
                    self._show_error(str(error))
            return
        self._remembered.wait()
        if not self._closed:
            self._begin(entry, record)

    def _begin(self, entry: Entry, record: LessonRecord) -> None:
        with self._lock:
            if self._entry is not entry:
                return  # the person has gone elsewhere meanwhile
            self._player = LessonPlayer(
                record,
                entry.key,
                self._store,
                self._frame,
                self._gui,
                self._post,
                self._ask,
                self._look,
                self._answer,
                self._now,
            )
            self._ask(OpenLesson(record.file, record.robot))
            self._opened(True)
            self._player.start()

    def _show_error(self, words: str) -> None:
        entry = self._entry
        with self._fresh():
            self._entry = entry
            again = None if entry is None else functools.partial(self._open, entry)
            error_page(self._gui, words, again, self._show_list)

    def _leave(self) -> None:
        with self._lock:
            self._put_away()
        self._show_list()

    def _put_away(self) -> None:
        """Give back what was before the lesson."""
        if self._player is not None:
            if self._player.turns:
                self._look(START_VIEW)
            self._player = None
            self._ask(LeaveLesson())
            self._opened(False)
            self._frame.show(None)

    # Step by step.

    def _now(self) -> tuple[LoadedRobot, Truth]:
        """Who plays, and what is the case."""
        assert self._robot is not None
        return self._robot, self._truth

    def _answer(self, place: int, read: Callable[[], float]) -> None:
        with self._lock:
            if self._player is not None:
                self._player.answer(place, read())

    def _next(self) -> None:
        with self._lock:
            if self._player is not None and not self._player.forward():
                self._leave()

    def _back(self) -> None:
        with self._lock:
            if self._player is not None:
                self._player.back()

    @contextlib.contextmanager
    def _fresh(self) -> Iterator[None]:
        """An empty page outside a lesson."""
        with self._lock, self._frame.fresh():
            yield
