"""A lesson's script read with patience: a command at a terminal does not hang on a loop without an end.

The script runs in this process. One of its own, as the app's list has it, would load everything a second time:
1.5 s more on a command that takes 2 s.
"""

from __future__ import annotations

import signal
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType, TracebackType

from momentum_lab.errors import LessonError
from momentum_lab.lesson.loader import load_lesson
from momentum_lab.lesson.parts import Lesson

READING_PATIENCE = 30.0
"""How long it may take to read a script on a busy machine, s."""


class _GivenUp(BaseException):
    """No error of the script's, which might catch it."""


def read_lesson(file: Path, patience: float = READING_PATIENCE) -> Lesson:
    """A lesson from its script; only a program's main thread can ask for it.

    Args:
        file: the script.
        patience: how long it may take, s.

    Raises:
        LessonError: something is wrong with it, or it has not come to its end; the message names file and line.
    """
    try:
        with _given_up_after(patience):
            return load_lesson(file)
    except _GivenUp as error:
        place = f"{file}:{_line(file, error.__traceback__)}"
        raise LessonError(place, f"no end within {patience:g} s", "a script that comes to its end") from error


@contextmanager
def _given_up_after(seconds: float) -> Iterator[None]:
    def give_up(_signal: int, _frame: FrameType | None) -> None:
        raise _GivenUp

    before = signal.signal(signal.SIGALRM, give_up)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def _line(file: Path, trace: TracebackType | None) -> int:
    """The line of the script that was being done, its first one if that is elsewhere."""
    lines = [frame.lineno or 1 for frame in traceback.extract_tb(trace) if frame.filename == str(file)]
    return lines[-1] if lines else 1
