"""Tabs that a key can open. Viser leaves the choice of the open tab to the browser."""

from __future__ import annotations

import threading
import time

import viser

# The browser opens the only tab there is. So long is it alone, s: a busy browser must have time to see it.
_ALONE = 0.35


class Tabs:
    """A group of tabs that is complete.

    Args:
        client: the browser tab it is in.
        group: the group; no tabs are added any more.
    """

    def __init__(self, client: viser.ClientHandle, group: viser.GuiTabGroupHandle) -> None:
        self._client, self._group = client, group
        self._labels = group._tab_labels
        self._icons = group._tab_icons_html
        self._containers = group._tab_container_ids
        self._opening = threading.Lock()

    def open(self, index: int) -> None:
        """Open one tab, from 0: for a moment it is the only one, then the others are back beside it."""
        with self._opening:
            self._show(slice(index, index + 1))
            time.sleep(_ALONE)
            self._show(slice(None))

    def _show(self, which: slice) -> None:
        with self._client.atomic():
            self._group._tab_labels = self._labels[which]
            self._group._tab_icons_html = self._icons[which]
            self._group._tab_container_ids = self._containers[which]
        self._client.flush()
