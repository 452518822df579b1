"""Keys and commands. Space and arrows stay with the widgets; W, A, S, D, Q and E move the camera."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

import viser

from momentum_lab.app.appearance import Appearance
from momentum_lab.app.hand import Hand
from momentum_lab.app.hand_panel import MODIFIER
from momentum_lab.app.help_page import HELP
from momentum_lab.app.push_panel import PushPanel
from momentum_lab.app.runs_panel import RunsPanel
from momentum_lab.app.status_bar import LARGE_STEP, SMALL_STEP, StatusBar
from momentum_lab.app.tabs import Tabs
from momentum_lab.app.widgets import Post
from momentum_lab.events import Branch, Reset, StepOnce

# Keys that follow each other faster than this come from one that is held down, s.
_REPEATED = 0.12


def add_keys(
    client: viser.ClientHandle,
    post: Post,
    push_now: Callable[[], None],
    push: PushPanel,
    status: StatusBar,
    tabs: Tabs,
    runs: RunsPanel,
    hand: Hand,
    colours: Appearance,
) -> None:
    """Give a browser tab its keys; all of them are in the command palette too."""
    keys: tuple[tuple[str, Any, Callable[[], None]], ...] = (
        ("Push", "P", push_now),
        ("Stand up again", "R", lambda: post(Reset())),
        ("Play or pause", "K", status.toggle),
        ("What would this push do?", "F", push.ask),
        ("Repeat the last push", None, push.apply_again),
        ("Help", "H", _Help(client).toggle),
        ("Step 1 ms", "J", lambda: post(StepOnce(SMALL_STEP))),
        ("Step 20 ms", "L", lambda: post(StepOnce(LARGE_STEP))),
        ("Go on from the instant that is looked at", "B", lambda: post(Branch())),
        ("Drag pushes the robot, without Shift", "T", hand.toggle),
        ("Let go without a push", "Z", hand.give_up),
        ("Keep this run as A", "M", runs.keep),
        ("Same pushes again", "N", runs.run_again),
        ("Show or hide A", "G", runs.toggle_ghost),
        ("Dark or light page", "C", colours.toggle),
        ("Push tab", "1", lambda: tabs.open(0)),
        ("Control tab", "2", lambda: tabs.open(1)),
        ("View tab", "3", lambda: tabs.open(2)),
        ("Runs tab", "4", lambda: tabs.open(3)),
        ("Share tab", "5", lambda: tabs.open(4)),
    )
    for label, hotkey, act in keys:
        client.gui.add_command(label, hotkey=hotkey).on_trigger(_triggered(act))
    # Whoever pulls may be holding Shift.
    give_up = client.gui.add_command("Let go without a push, with Shift", hotkey="Z", modifier=MODIFIER)
    give_up.on_trigger(_triggered(hand.give_up))


def _triggered(act: Callable[[], None]) -> Callable[[Any], None]:
    """What a key does; a key that is held down repeats itself, and that is not meant."""
    last = -math.inf

    def trigger(_: Any) -> None:
        nonlocal last
        before, last = last, time.monotonic()
        if last - before > _REPEATED:
            act()

    return trigger


class _Help:
    """The help page of a browser tab; there is one at most."""

    def __init__(self, client: viser.ClientHandle) -> None:
        self._gui = client.gui
        self._modal: Any = None

    def toggle(self) -> None:
        """Open it, or close it: viser's own dialogs close by a button only, which a long page would hide below."""
        if self._modal is not None:
            self._modal.close()
            self._modal = None
            return
        self._modal = self._gui.add_modal("How this lab works")
        with self._modal:
            close = self._gui.add_button("Close  (H)", color="gray")
            self._gui.add_markdown(HELP)
        close.on_click(lambda _: self.toggle())
