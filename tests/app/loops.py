"""Coroutines of tests: in a thread of their own, for a browser's loop may run in the thread of the test."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar

ResultT = TypeVar("ResultT")


def run(function: Callable[[], Coroutine[Any, Any, ResultT]]) -> ResultT:
    """What a coroutine comes to."""
    with ThreadPoolExecutor(1) as pool:
        return pool.submit(lambda: asyncio.run(function())).result()
