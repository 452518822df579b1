"""Lessons' scripts, loaded and played in processes of their own: a script may do anything, loop for ever too."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import msgspec

from momentum_lab.app.birth import born
from momentum_lab.errors import LabError, LessonError
from momentum_lab.lesson.loader import load_lesson
from momentum_lab.lesson.reading import READING_PATIENCE
from momentum_lab.lesson.record import LessonRecord, rehearsed

# How long a lesson's runs may take, s.
_PATIENCE = 120.0
# A page that is being opened goes before scripts that are looked through.
_NICE = 5


class Answer(msgspec.Struct, frozen=True):
    """What a rehearsal has come to: a record or an error."""

    record: LessonRecord | None = None
    error: str = ""


def rehearsed_apart(file: Path, robot: str) -> LessonRecord:
    """What a lesson shows when it is played out of sight.

    Raises:
        LabError: something is wrong with the lesson; the message names file and line.
    """
    with _process(_rehearse, str(file), robot) as listen:
        found = msgspec.msgpack.decode(listen(file, _PATIENCE), type=Answer)
    if found.record is None:
        raise LabError(found.error)
    return found.record


def faults(files: Sequence[Path]) -> Iterator[tuple[Path, str]]:
    """What is wrong with each of some scripts, one after the other; empty where nothing is."""
    rest = list(files)
    while rest:
        with _process(_read, [str(file) for file in rest]) as listen:
            try:
                while rest:
                    words = listen(rest[0], READING_PATIENCE).decode()
                    yield rest.pop(0), words
            except LessonError as error:
                # This one has brought its process to an end; the others are read in a new one.
                yield rest.pop(0), str(error)


Listen = Callable[[Path, float], bytes]
"""What the process says next about a script, within some seconds; a LessonError if it says nothing."""


@contextmanager
def _process(target: Callable[..., None], *given: Any) -> Iterator[Listen]:
    ours, theirs = multiprocessing.Pipe(duplex=False)
    process = born(target, (theirs, *given), "lesson")
    theirs.close()

    def listen(file: Path, patience: float) -> bytes:
        try:
            if not ours.poll(patience):
                raise LessonError(f"{file}:1", f"no end within {patience:g} s", "runs that come to an end")
            return ours.recv_bytes()
        except EOFError as error:
            process.join()
            raise LessonError(f"{file}:1", f"exit code {process.exitcode}", "a script that runs") from error

    try:
        with ours:
            yield listen
    finally:
        process.kill()
        process.join()


def _rehearse(connection: Connection, file: str, robot: str) -> None:
    try:
        found = Answer(rehearsed(file, robot))
    except LabError as error:
        found = Answer(error=str(error))
    with connection:
        connection.send_bytes(msgspec.msgpack.encode(found))


def _read(connection: Connection, files: Sequence[str]) -> None:
    os.nice(_NICE)
    with connection:
        for file in files:
            connection.send_bytes(_fault(Path(file)).encode())


def _fault(file: Path) -> str:
    try:
        load_lesson(file)
    except LabError as error:
        return str(error)
    return ""
