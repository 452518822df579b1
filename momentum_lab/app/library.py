"""The lessons of a folder: what they ask, and what they show, found out in a process of their own."""

from __future__ import annotations

import multiprocessing
import threading
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path

import msgspec

from momentum_lab.errors import LabError, LessonError
from momentum_lab.lesson.loader import headline, lesson_files
from momentum_lab.lesson.record import LessonRecord, rehearsed
from momentum_lab.paths import LESSONS

# How long a lesson's runs may take, s.
_PATIENCE = 120.0


@dataclass(frozen=True, slots=True)
class Entry:
    """A lesson in the list.

    Attributes:
        file: its script.
        number: its place.
        title: a few words.
        question: the question that drives it; empty if the script cannot be read.
        error: why it cannot be read; empty if it can.
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


class Answer(msgspec.Struct, frozen=True):
    """What a rehearsal has come to: a record or an error."""

    record: LessonRecord | None = None
    error: str = ""


class Library:
    """Lists lessons and plays them out of sight, once for all browser tabs.

    Args:
        folder: where the scripts are.
    """

    def __init__(self, folder: Path = LESSONS) -> None:
        self._folder = folder
        self._lock = threading.Lock()
        self._known: dict[tuple[Path, int, str], LessonRecord] = {}

    def entries(self) -> list[Entry]:
        """All lessons in their order; one that cannot be read is there with its error."""
        return [_entry(path) for path in lesson_files(self._folder)]

    def rehearse(self, file: Path, robot: str) -> LessonRecord:
        """A lesson played on a robot, or on the first it names if it is not for that robot.

        A script may do anything, loop for ever too: it runs in a process that ends with it.

        Raises:
            LabError: something is wrong with the lesson; the message names file and line.
        """
        try:
            key = (file, file.stat().st_mtime_ns, robot)
        except OSError as error:
            raise LessonError(
                str(file), "nothing", f"a script that can be read ({error.strerror})"
            ) from error
        with self._lock:
            if key not in self._known:
                self._known[key] = _in_a_process(file, robot)
            return self._known[key]


def _entry(path: Path) -> Entry:
    number = int(path.stem.partition("_")[0])
    try:
        title, question = headline(path)
    except LabError as error:
        return Entry(path, number, path.name, "", str(error))
    return Entry(path, number, title, question)


def _in_a_process(file: Path, robot: str) -> LessonRecord:
    context = multiprocessing.get_context("forkserver")
    ours, theirs = context.Pipe(duplex=False)
    process = context.Process(target=answer, args=(theirs, str(file), robot), daemon=True, name="rehearsal")
    process.start()
    theirs.close()
    try:
        with ours:
            if not ours.poll(_PATIENCE):
                raise LessonError(f"{file}:1", f"no end within {_PATIENCE:g} s", "runs that come to an end")
            found = msgspec.msgpack.decode(ours.recv_bytes(), type=Answer)
    except EOFError as error:
        process.join()
        raise LessonError(f"{file}:1", f"exit code {process.exitcode}", "a script that runs") from error
    finally:
        process.kill()
        process.join()
    if found.record is None:
        raise LabError(found.error)
    return found.record


def answer(connection: Connection, file: str, robot: str) -> None:
    """Play a lesson and send what it has shown."""
    try:
        found = Answer(rehearsed(file, robot))
    except LabError as error:
        found = Answer(error=str(error))
    with connection:
        connection.send_bytes(msgspec.msgpack.encode(found))
