"""Processes of the lab are born whole and deaf to Ctrl+C: or they would complain at the terminal as it ends."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator
from multiprocessing import forkserver, resource_tracker, util
from multiprocessing.process import BaseProcess
from typing import Any

LOADED_ONCE = "momentum_lab.app.worker"
"""What every process needs; its name only, as the process that forks them is the one that has to load it."""

# A birth takes some milliseconds; one that hangs must not keep the program from ending, s.
_PATIENCE = 5.0

# A process that forks must have no threads, and numerical libraries start theirs when they are loaded.
_ONE_THREAD = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}

_one_at_a_time = threading.Lock()
# The end of the program waits for the birth under way, and takes the lock for good: no other begins.
# It is the first thing multiprocessing does at the end; what it needs for a birth goes after that.
util.Finalize(None, _one_at_a_time.acquire, kwargs={"timeout": _PATIENCE}, exitpriority=100)


def warm_up() -> None:
    """Start the process that all others are forked from: it has loaded everything once."""
    multiprocessing.set_forkserver_preload([LOADED_ONCE])
    with _environment(_ONE_THREAD), _deaf():
        forkserver.ensure_running()


def born(target: Callable[..., None], arguments: tuple[Any, ...], name: str) -> BaseProcess:
    """A process forked from the one that has loaded everything; it is stopped when the program ends.

    Args:
        target: what it does, a function of a module.
        arguments: what the function is given.
        name: what the process is called.
    """
    context = multiprocessing.get_context("forkserver")
    process = context.Process(target=target, args=arguments, daemon=True, name=name)
    with _one_at_a_time, _deaf():
        process.start()
    return process


@contextlib.contextmanager
def _deaf() -> Iterator[None]:
    """Processes started meanwhile, and those below them, do not hear Ctrl+C: a terminal tells it to all of them."""
    resource_tracker.ensure_running()  # multiprocessing starts it first, and lets signals through again after that
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextlib.contextmanager
def _environment(values: dict[str, str]) -> Iterator[None]:
    """Other values of some environment variables, for a while."""
    before = {name: os.environ.get(name) for name in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
