"""A tab may be drawn to from several threads at once."""

from __future__ import annotations

import asyncio
import threading

import pytest

from momentum_lab.app.wake import Wake
from tests.app.loops import run


class Sleeper:
    """Waits for an event, and notes in which thread it is woken."""

    def __init__(self) -> None:
        self.woken: list[int] = []

    def done(self) -> bool:
        return bool(self.woken)

    def set_result(self, _: bool) -> None:
        self.woken.append(threading.get_ident())


@pytest.mark.parametrize(("kind", "threads"), [(asyncio.Event, "theirs"), (Wake, "the loop's")])
def test_sleepers_are_woken_in_the_thread_of_the_loop(kind: type[asyncio.Event], threads: str) -> None:
    async def waking() -> tuple[int, list[int]]:
        event, sleeper = kind(), Sleeper()
        event._waiters.append(sleeper)  # type: ignore[arg-type]
        other = threading.Thread(target=event.set)
        other.start()
        other.join()
        assert event.is_set()
        event.set()  # as viser does afterwards, through the loop
        return threading.get_ident(), sleeper.woken

    loop, woken = run(waking)
    assert len(woken) == 1
    assert (woken[0] == loop) == (threads == "the loop's")


def test_an_event_that_has_been_set_lets_the_next_one_through() -> None:
    async def passing() -> None:
        event = Wake()
        threading.Thread(target=event.set).start()
        while not event.is_set():
            await asyncio.sleep(0.001)
        await asyncio.wait_for(event.wait(), 1.0)
        event.clear()
        waiting = asyncio.create_task(event.wait())
        await asyncio.sleep(0)
        event.set()
        assert await asyncio.wait_for(waiting, 1.0)

    run(passing)
