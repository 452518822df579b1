"""Waking what sends viser's messages: viser does it from any thread, asyncio allows it in the loop's thread only."""

from __future__ import annotations

import asyncio

import viser


class Wake(asyncio.Event):
    """An event that may be set from any thread; who waits for it is woken by setting it in the loop's.

    Set elsewhere, it would walk through a list that the loop changes meanwhile: RuntimeError, in whoever draws.
    """

    def set(self) -> None:
        """Set the event, and wake who waits if this is the loop's thread; viser sets it there afterwards anyway."""
        if asyncio._get_running_loop() is None:
            self._value = True
            return
        self._value = False  # or nobody is woken
        super().set()


def wake_safely(client: viser.ClientHandle) -> None:
    """Let a browser tab's messages be queued from several threads."""
    client._websock_connection.get_message_buffer().message_event.__class__ = Wake
