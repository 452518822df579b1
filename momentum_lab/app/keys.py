"""Keys and commands. Space and arrows stay with the widgets; W, A, S, D, Q and E move the camera."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

import viser

from momentum_lab.app.push_panel import PushPanel
from momentum_lab.app.runs_panel import RunsPanel
from momentum_lab.app.status_bar import LARGE_STEP, SMALL_STEP, StatusBar
from momentum_lab.app.tabs import Tabs
from momentum_lab.app.widgets import Post
from momentum_lab.events import Branch, Reset, StepOnce

# Keys that follow each other faster than this come from one that is held down, s.
_REPEATED = 0.12

_HELP = """
**P** push &nbsp;·&nbsp; **K** play or pause &nbsp;·&nbsp; **J** step 1 ms &nbsp;·&nbsp; **L** step 20 ms
&nbsp;·&nbsp; **R** stand up again &nbsp;·&nbsp; **1 2 3 4 5** tabs &nbsp;·&nbsp; **H** this help

**F** what would this push do &nbsp;·&nbsp; **M** keep this run as A &nbsp;·&nbsp; **N** same pushes again
&nbsp;·&nbsp; **G** show or hide A

A lesson, in the *Learn* tab on the left: **I** next step &nbsp;·&nbsp; **U** the step before.

*Look back* shows what was; **B** goes on from the instant you look at, with other gains if you like.

The robot stands on its own; you push it. The controller moves the **CoP** (◆) under the feet to bring the
**CoM** (●) back. Where the safe border of the feet stops the CoP, the ground cannot give both goals: either the
body turns (linear momentum is kept) or the CoM gives way (angular momentum is kept). The *priority* slider of the
Control tab decides.

The line from the CoM to the **CMP** (▲) is parallel to the ground reaction force. The bar from CoP to CMP is the
lever with which that force turns the body: the longer it is, the faster angular momentum changes.

Drag to turn the picture, right-drag to move it, scroll to come closer. **Shift + drag** on the robot pulls it
there: the arrow shows the force, letting go pushes (*pulse*) or ends the push (*hold*, in the Push tab).
"""


def add_keys(
    client: viser.ClientHandle,
    post: Post,
    push_now: Callable[[], None],
    push: PushPanel,
    status: StatusBar,
    tabs: Tabs,
    runs: RunsPanel,
) -> None:
    """Give a browser tab its keys; all of them are in the command palette too."""
    keys: tuple[tuple[str, Any, Callable[[], None]], ...] = (
        ("Push", "P", push_now),
        ("Repeat the last push", None, push.apply_again),
        ("Play or pause", "K", status.toggle),
        ("What would this push do?", "F", push.ask),
        ("Keep this run as A", "M", runs.keep),
        ("Same pushes again", "N", runs.run_again),
        ("Show or hide A", "G", runs.toggle_ghost),
        ("Step 1 ms", "J", lambda: post(StepOnce(SMALL_STEP))),
        ("Step 20 ms", "L", lambda: post(StepOnce(LARGE_STEP))),
        ("Go on from the instant that is looked at", "B", lambda: post(Branch())),
        ("Stand up again", "R", lambda: post(Reset())),
        ("Push tab", "1", lambda: tabs.open(0)),
        ("Control tab", "2", lambda: tabs.open(1)),
        ("View tab", "3", lambda: tabs.open(2)),
        ("Runs tab", "4", lambda: tabs.open(3)),
        ("Share tab", "5", lambda: tabs.open(4)),
        ("Help", "H", lambda: _show_help(client)),
    )
    for label, hotkey, act in keys:
        client.gui.add_command(label, hotkey=hotkey).on_trigger(_triggered(act))


def _triggered(act: Callable[[], None]) -> Callable[[Any], None]:
    """What a key does; a key that is held down repeats itself, and that is not meant."""
    last = -math.inf

    def trigger(_: Any) -> None:
        nonlocal last
        before, last = last, time.monotonic()
        if last - before > _REPEATED:
            act()

    return trigger


def _show_help(client: viser.ClientHandle) -> None:
    modal = client.gui.add_modal("How this lab works")
    with modal:
        client.gui.add_markdown(_HELP)
        close = client.gui.add_button("Close")
    close.on_click(lambda _: modal.close())
