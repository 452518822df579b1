"""A progress bar on stderr for whatever takes long, and a clean stop on Ctrl+C."""

from __future__ import annotations

import math
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Event
from time import monotonic

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

# What is done sooner than this needs no bar, s.
_PATIENCE = 0.5
_REDRAW = 0.2


@contextmanager
def progress(label: str) -> Iterator[Callable[[float], None]]:
    """A function that is told the fraction done as often as one likes.

    The bar is drawn by the caller's own thread, five times a second, so that it does not disturb what is being
    timed; only on a terminal, and it is gone at the end.
    """
    console = Console(stderr=True)
    columns = (TextColumn(label, markup=False), BarColumn(), TaskProgressColumn(), TimeRemainingColumn())
    bar = Progress(*columns, console=console, auto_refresh=False, transient=True)
    task = bar.add_task(label)
    drawn = False
    due = monotonic() + _PATIENCE if console.is_terminal else math.inf

    def report(fraction: float) -> None:
        nonlocal drawn, due
        if monotonic() < due:
            return
        due = monotonic() + _REDRAW
        drawn = True
        bar.start()
        bar.update(task, completed=100.0 * fraction, refresh=True)

    try:
        yield report
    finally:
        # A bar that stops leaves a line behind, even where it was never drawn.
        if drawn:
            bar.stop()


@contextmanager
def interruptible() -> Iterator[Event]:
    """An event that Ctrl+C sets, instead of an exception in the middle of something."""
    stopped = Event()
    previous = signal.signal(signal.SIGINT, lambda *_: stopped.set())
    try:
        yield stopped
    finally:
        signal.signal(signal.SIGINT, previous)
