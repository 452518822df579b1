"""The lessons of a folder: what they ask, what they show, and what is wrong with them."""

from __future__ import annotations

import threading
from dataclasses import dataclass
from pathlib import Path

from momentum_lab.app.apart import faults, rehearsed_apart
from momentum_lab.errors import LabError, LessonError
from momentum_lab.lesson.loader import headline, lesson_files
from momentum_lab.lesson.record import LessonRecord
from momentum_lab.paths import LESSONS

# A script as it was at a time: its path, and when it was changed, ns.
_Version = tuple[Path, int]


@dataclass(frozen=True, slots=True)
class Entry:
    """A lesson in the list.

    Attributes:
        file: its script.
        number: its place.
        title: a few words.
        question: the question that drives it; empty if the script cannot be read.
        error: what is wrong with it; empty if nothing is known to be.
    """

    file: Path
    number: int
    title: str
    question: str
    error: str = ""

    @property
    def key(self) -> str:
        """The name under which a learner's progress is kept."""
        return self.file.stem


class Library:
    """Lists lessons and plays them out of sight, once for all browser tabs.

    Args:
        folder: where the scripts are.
    """

    def __init__(self, folder: Path = LESSONS) -> None:
        self._folder = folder
        self._lock = threading.Lock()
        self._reading = threading.Lock()
        self._known: dict[tuple[_Version, str], LessonRecord] = {}
        # One for each rehearsal: who asks for the same waits for it, who asks for another does not.
        self._rehearsing: dict[tuple[_Version, str], threading.Lock] = {}
        self._faults: dict[_Version, str] = {}

    def entries(self) -> list[Entry]:
        """All lessons in their order; one that is known to have an error is there with it."""
        return [self._entry(path) for path in lesson_files(self._folder)]

    def look_through(self) -> list[Entry]:
        """The same list once every script has been loaded, which takes a few seconds the first time."""
        with self._reading:
            new = [path for path in lesson_files(self._folder) if _version(path) not in self._faults]
            versions = {path: _version(path) for path in new}
            for path, words in faults(new):
                self._faults[versions[path]] = words
        return self.entries()

    def rehearse(self, file: Path, robot: str) -> LessonRecord:
        """A lesson played on a robot, or on the first it names if it is not for that robot.

        A script may do anything, loop for ever too: it runs in a process that ends with it.

        Raises:
            LabError: something is wrong with the lesson; the message names file and line.
        """
        try:
            key = ((file, file.stat().st_mtime_ns), robot)
        except OSError as error:
            raise LessonError(
                str(file), "nothing", f"a script that can be read ({error.strerror})"
            ) from error
        with self._lock:
            rehearsing = self._rehearsing.setdefault(key, threading.Lock())
        with rehearsing:
            if key not in self._known:
                self._known[key] = rehearsed_apart(file, robot)
            return self._known[key]

    def _entry(self, path: Path) -> Entry:
        number = int(path.stem.partition("_")[0])
        try:
            title, question = headline(path)
        except LabError as error:
            return Entry(path, number, path.name, "", str(error))
        return Entry(path, number, title, question, self._faults.get(_version(path), ""))


def _version(path: Path) -> _Version:
    """A script as it is now; one that has gone has no time."""
    try:
        return path, path.stat().st_mtime_ns
    except OSError:
        return path, 0
