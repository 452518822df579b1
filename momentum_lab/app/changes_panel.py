"""What has been changed since the scenario began, and steps back and forth through it."""

from __future__ import annotations

import time
from collections.abc import Callable

import viser

from momentum_lab.app import html
from momentum_lab.app.chosen import chosen_in
from momentum_lab.app.tuning_history import TuningHistory
from momentum_lab.app.tuning_panel import changed_gains
from momentum_lab.app.widgets import Post
from momentum_lab.app.wire import Truth
from momentum_lab.choice_words import NOTHING, choices_in_words
from momentum_lab.choices import Choices
from momentum_lab.control.gains import declared_gains, values_of
from momentum_lab.control.registry import controller_entry

_UNDO, _REDO = "Undo", "Redo"


class ChangesPanel:
    """Undo, redo and the list of what is not as the scenario has it.

    Args:
        gui: where they go.
        post: where events go.
        tell: shows a person what was wrong.
        truth: what is the case at the start.
        clock: seconds, for tests.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        post: Post,
        tell: Callable[[str], None],
        truth: Truth,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._post, self._tell, self._clock = post, tell, clock
        self._buttons = gui.add_button_group("change", (_UNDO, _REDO))
        self._buttons.on_click(lambda event: self._step(event.target.value))
        self._handle = gui.add_html("")
        self._text = ""
        self._first = self._now = chosen_in(truth)
        self._begun, self._history = _begun_with(truth), TuningHistory(self._now, clock)
        self._show()

    def follow(self, truth: Truth) -> None:
        """Take note of what is the case; another scenario begins another list."""
        if _begun_with(truth) != self._begun:
            self._begun, self._first = _begun_with(truth), chosen_in(truth)
            self._history = TuningHistory(self._first, self._clock)
        self._now = chosen_in(truth)
        self._history.note(self._now)
        self._show()

    def _show(self) -> None:
        text = html.changes(changes_in_words(self._first, self._now))
        if text != self._text:
            self._text = self._handle.content = text

    def _step(self, name: str) -> None:
        events = self._history.back() if name == _UNDO else self._history.forth()
        if not events:
            self._tell(f"There is nothing to {name.lower()}.")
        for event in events:
            self._post(event)


def changes_in_words(before: Choices, now: Choices) -> list[str]:
    """Every choice that is not what it was, in words; gains of another controller against their defaults."""
    were, are = choices_in_words(before), choices_in_words(now)
    lines = [
        f"{name}: {were.get(name, NOTHING)} → {value}"
        for name, value in are.items()
        if value != were.get(name)
    ]
    gains = controller_entry(now.controller).gains
    before_gains = before.gains if before.controller == now.controller else gains
    return lines + changed_gains(
        declared_gains(gains).values(), values_of(now.gains), values_of(before_gains)
    )


def _begun_with(truth: Truth) -> tuple[str, str, bool]:
    """What a list of changes belongs to."""
    return truth.scenario, truth.robot, truth.opened is not None
