"""Notices over the picture of one browser tab."""

from __future__ import annotations

import viser

_LONG = 8.0


class Notices:
    """What a person is told.

    Args:
        client: the browser tab.
    """

    def __init__(self, client: viser.ClientHandle) -> None:
        self._client = client

    def tell(self, words: str) -> None:
        """What was wrong."""
        self._client.add_notification("Not possible", words, auto_close_seconds=_LONG, color="orange")

    def warn(self, words: str) -> None:
        """What was wrong, until it is closed."""
        self._client.add_notification("Not possible", words, color="orange")

    def say(self, words: str) -> None:
        """Which run has been opened."""
        self._client.add_notification("Run opened", words, auto_close_seconds=_LONG, color="blue")
