"""The legend above the plots: the marks that are switched on, and those of a push that is only tried."""

from __future__ import annotations

from collections.abc import Collection

import viser

from momentum_lab.app import html
from momentum_lab.app.marks import PRESETS, START_PRESET, STYLES


class Legend:
    """All legends of one browser tab; they say the same."""

    def __init__(self) -> None:
        self._shown = frozenset(PRESETS[START_PRESET])
        self._handles: list[viser.GuiHtmlHandle] = []

    def add(self, gui: viser.GuiApi) -> None:
        """One more of them."""
        self._handles.append(gui.add_html(self._text()))

    def show(self, marks: Collection[str], paths: Collection[str]) -> None:
        """Have in it what is drawn.

        Args:
            marks: keys of the marks that are switched on.
            paths: keys of those whose paths a push that is only tried has.
        """
        shown = frozenset(marks) | frozenset(paths)
        if shown != self._shown:
            self._shown = shown
            for handle in self._handles:
                handle.content = self._text()

    def _text(self) -> str:
        return html.legend([key for key in STYLES if key in self._shown], explained=False)
