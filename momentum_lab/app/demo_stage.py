"""What a browser tab shows while the lab plays by itself: a sentence, and a camera that goes round the robot."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from html import escape
from typing import Literal

import numpy as np
import viser

from momentum_lab.app.camera import Camera, Seat
from momentum_lab.app.demo import AHEAD, TURN, Demo, Scene
from momentum_lab.app.demo_wire import DemoEvent, LeaveScenes, ShowScene

HOTKEY: Literal["X"] = "X"
"""What the page presses for a person whenever anything on it is touched; a person may press it, too."""
COMMAND = "End the demonstration"
# How often is looked whether it is time, s.
_PERIOD = 0.25
# Between two notes that somebody is there, ms: one is enough to end the demonstration.
_QUIET = 700

# Widgets of a panel that is folded away do not exist, so the page speaks through a key, which always works. It says
# which modifiers are down: a drag that is held with one of them would end at a key without it.
_LISTEN = (
    "(()=>{if(window.labListens)return;window.labListens=true;let last=-1e9,x=-1,y=-1;"
    "const note=e=>{if(!e.isTrusted||e.key==='x')return;"
    "if(e.type==='pointermove'){const still=x===e.screenX&&y===e.screenY,first=x<0;"
    "x=e.screenX;y=e.screenY;if(still||first)return}"
    f"const now=performance.now();if(now-last<{_QUIET})return;last=now;"
    "const {shiftKey,ctrlKey,altKey,metaKey}=e;document.body.dispatchEvent(new KeyboardEvent('keydown',"
    "{key:'x',code:'KeyX',bubbles:true,shiftKey,ctrlKey,altKey,metaKey}))};"
    "for(const kind of ['pointerdown','pointermove','wheel','keydown','touchstart'])"
    "window.addEventListener(kind,note,{capture:true,passive:true})})()"
)
LISTENER = f'<img alt="" src="data:," style="display:none" onerror="{escape(_LISTEN)}">'
"""Once in a page: says that somebody is there."""


class DemoStage:
    """The demonstration of one browser tab.

    Args:
        client: the browser tab.
        ask: where events for the session's process go.
        robot: says which robot plays.
        patience: how long nobody has to touch the lab, s; None: it never plays by itself.
        clock: seconds, for tests.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        ask: Callable[[DemoEvent], None],
        robot: Callable[[], str],
        patience: float | None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._client, self._ask, self._clock = client, ask, clock
        self.demo = Demo(self._play, self._leave, robot, patience, clock)
        self._seat: Seat | None = None
        self._since = 0.0
        self._captions: list[viser.GuiHtmlHandle] = []
        self._gone = threading.Event()

    def furnish(self) -> None:
        """Add what it needs to the page, and watch the time from now on."""
        self._client.gui.add_html(LISTENER)
        self.add_caption()
        self.demo.touch()
        threading.Thread(target=self._watch, name="demo", daemon=True).start()

    def add_caption(self) -> None:
        """Let the panel that is being made carry the sentence, too: what is in a folded panel does not exist.

        It is at the same place of the page whichever panel carries it, and covers what another one shows.
        """
        self._captions.append(self._client.gui.add_html(""))

    def listen(self) -> None:
        """Hear the key that the page presses; last in the list of commands, where only a demonstration is ended."""
        command = self._client.gui.add_command(COMMAND, hotkey=HOTKEY)
        command.on_trigger(lambda _: self.demo.touch())

    def close(self) -> None:
        """The tab has been closed."""
        self._gone.set()

    def before(self, camera: Camera, in_demo: bool) -> None:
        """A frame is about to be drawn, of a scene or not: keep from where a person looks."""
        if in_demo and self._seat is None:
            self._seat = camera.seat()

    def after(self, camera: Camera, spread: np.ndarray | None, in_demo: bool) -> None:
        """A frame has been drawn: look at it from where it has to be looked at.

        Args:
            camera: what looks at it.
            spread: from one robot to the other, if there are two (2,), m.
            in_demo: whether the frame belongs to a scene.
        """
        if in_demo:
            camera.turn(TURN * (self._clock() - self._since) - AHEAD, spread)
        elif self._seat is not None:
            camera.take(self._seat)
            self._seat = None

    def _watch(self) -> None:
        while not self._gone.wait(_PERIOD):
            self.demo.tick()

    def _play(self, scene: Scene) -> None:
        self._since = self._clock()
        self._ask(ShowScene(scene.scenario))
        self._say(caption(scene.caption))

    def _leave(self) -> None:
        self._ask(LeaveScenes())
        self._say("")

    def _say(self, content: str) -> None:
        for handle in self._captions:
            handle.content = content
        self._client.flush()


def caption(words: str) -> str:
    """A sentence over the picture, above where the feet are, to be read from the last row."""
    return (
        '<div data-demo style="position:fixed;left:50vw;top:2.5vh;transform:translateX(-50%);z-index:50;'
        "width:max-content;box-sizing:border-box;"
        "max-width:min(92vw,max(22em,100vw - 50rem));padding:.6em 1em;border-radius:.4em;"
        'pointer-events:none;background:#0b4f79;color:#fff;font-size:1.35rem;line-height:1.35;text-align:center">'
        f"{escape(words)}"
        '<div style="font-size:.6em;opacity:.8">The lab plays by itself. Touch it, and it is yours.</div></div>'
    )
