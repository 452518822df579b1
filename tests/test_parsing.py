"""Trees of Python text, built in many threads at once."""

from __future__ import annotations

import ast
import contextlib
import gc
import sys
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import pytest

from momentum_lab.lesson.parsing import parsed

DEEP = "x = " + "(" * 40 + "1" + " + 1)" * 40


def test_threads_do_not_disturb_each_other():
    with ThreadPoolExecutor(8) as pool:
        trees = list(pool.map(parsed, [DEEP + f"\ny = {i}" for i in range(200)]))
    assert [ast.literal_eval(tree.body[1].value) for tree in trees] == list(range(200))


@pytest.fixture
def threads_meet_in_mid_tree() -> Iterator[None]:
    """Collections run Python code, and with it other threads, while a tree is built: make them frequent."""
    interval, threshold = sys.getswitchinterval(), gc.get_threshold()

    def work(*_: object) -> None:
        sum(range(50))

    sys.setswitchinterval(1e-6)
    gc.set_threshold(50)
    gc.callbacks.append(work)
    yield
    gc.callbacks.remove(work)
    gc.set_threshold(*threshold)
    sys.setswitchinterval(interval)


@pytest.mark.usefixtures("threads_meet_in_mid_tree")
def test_a_thread_that_knows_nothing_of_the_lock_does_no_harm():
    stop = threading.Event()

    def print_tracebacks() -> None:
        while not stop.is_set():
            with contextlib.suppress(SystemError):
                ast.parse(DEEP)
            time.sleep(1e-4)

    other = threading.Thread(target=print_tracebacks)
    other.start()
    try:
        trees = [parsed(DEEP + f"\ny = {i}") for i in range(300)]
    finally:
        stop.set()
        other.join()
    assert [ast.literal_eval(tree.body[1].value) for tree in trees] == list(range(300))


def test_what_is_not_python_is_refused():
    with pytest.raises(SyntaxError):
        parsed("1 +", mode="eval")
