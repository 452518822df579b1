"""What each gain does, written below its slider for those who ask: a hint shows only under a mouse."""

from __future__ import annotations

from html import escape
from typing import Any

import viser

_QUESTION = "explain each gain"


class GainNotes:
    """One switch, and a sentence below every slider.

    Args:
        gui: where the switch goes.
    """

    def __init__(self, gui: viser.GuiApi) -> None:
        self._gui = gui
        self._notes: list[viser.GuiHtmlHandle] = []
        switch = gui.add_checkbox(_QUESTION, False)
        switch.on_update(self._show)

    def add(self, words: str) -> None:
        """Add a sentence below the slider that was added last."""
        note = (
            f'<div class="lab small dim" style="margin-top:-.5em;padding-bottom:.8em">{escape(words)}</div>'
        )
        self._notes.append(self._gui.add_html(note, visible=False))

    def _show(self, event: Any) -> None:
        for note in self._notes:
            note.visible = bool(event.target.value)
