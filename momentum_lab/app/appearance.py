"""Light or dark: the page, the floor and the marks of one browser tab, as its person or browser likes it."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable
from html import escape
from typing import Literal

import viser

from momentum_lab.app.marks import Theme
from momentum_lab.app.view_panel import ViewSettings
from momentum_lab.palette import BLUE

Choice = Literal["light", "dark", "as the browser"]
CHOICES: tuple[Choice, ...] = ("light", "dark", "as the browser")
_KEY = "colours"
# A browser that does not answer remembers nothing, s.
_PATIENCE = 5.0

HIDDEN_NEXT = '<span class="lab-theme"></span><style>div:has(>.lab-theme)+*{display:none}</style>'
"""Hides the text that follows: a page puts there which colours its browser prefers."""

# The text is React's: it takes notice of a value only through the element's own setter and an input event.
_TELL = (
    "(()=>{const dark=matchMedia('(prefers-color-scheme: dark)');"
    "const forced=new URLSearchParams(location.search).has('darkMode');let left=100;"
    "const tell=()=>{const i=document.querySelector('div:has(>.lab-theme)+* input');"
    "if(!i){if(left--)setTimeout(tell,100);return}"
    "Object.getOwnPropertyDescriptor(HTMLInputElement.prototype,'value').set.call("
    "i,forced||dark.matches?'dark':'light');"
    "i.dispatchEvent(new Event('input',{bubbles:true}))};"
    "dark.addEventListener('change',tell);tell()})()"
)
TELL_THEME = f'<img alt="" src="data:," style="display:none" onerror="{escape(_TELL)}">'
"""Once in a page, after the text: says which colours the browser prefers, now and whenever that changes."""


def dress(gui: viser.GuiApi, theme: Theme) -> None:
    """Give a page its colours, and take away what the lab does not need."""
    gui.configure_theme(show_share_button=False, show_logo=False, brand_color=BLUE, dark_mode=theme == "dark")


class Appearance:
    """The colours of one browser tab: what its person has chosen, or else what its browser prefers.

    Args:
        client: the browser tab.
        settings: what has to be drawn again.
        redraw: asks for a new picture.
    """

    def __init__(
        self, client: viser.ClientHandle, settings: ViewSettings, redraw: Callable[[], None]
    ) -> None:
        self._client, self._settings, self._redraw = client, settings, redraw
        self._preferred: Theme = "light"
        self._choice: Choice = "as the browser"

    def add_choice(self, gui: viser.GuiApi) -> None:
        """Add the widget of the view tab."""
        colors = gui.add_button_group("colours", CHOICES, hint="Remembered by this browser.")
        colors.on_click(lambda event: self._choose(event.target.value))

    def toggle(self) -> None:
        """Dark if the page is light, light if it is dark; remembered like a choice of the view tab."""
        self._choose("light" if self._settings.theme == "dark" else "dark")

    def add_ear(self, gui: viser.GuiApi) -> None:
        """Add what the page answers with, and ask it."""
        gui.add_html(HIDDEN_NEXT)
        answer = gui.add_text("colours of the browser", "")
        answer.on_update(lambda event: self._prefer(event.target.value))
        gui.add_html(TELL_THEME)
        threading.Thread(target=self._remember, name="colours", daemon=True).start()

    def _remember(self) -> None:
        with contextlib.suppress(RuntimeError, TimeoutError):  # the tab has gone, or keeps nothing
            kept = self._client.local_storage.get_item(_KEY, timeout=_PATIENCE)
            self._take(next((choice for choice in CHOICES if choice == kept), self._choice))

    def _prefer(self, value: str) -> None:
        self._preferred = "dark" if value == "dark" else "light"
        self._take(self._choice)

    def _choose(self, value: str) -> None:
        choice = next((choice for choice in CHOICES if choice == value), None)
        if choice is not None:
            self._client.local_storage.set_item(_KEY, choice)
            self._take(choice)

    def _take(self, choice: Choice) -> None:
        self._choice = choice
        theme = self._preferred if choice == "as the browser" else choice
        if theme != self._settings.theme:
            self._settings.theme = theme
            dress(self._client.gui, theme)
            self._settings.changed = True
            self._redraw()
