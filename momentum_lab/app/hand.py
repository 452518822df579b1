"""A person's hand in the picture: a drag pulls the robot where it was grabbed, and letting go pushes it.

Viser calls ordered callbacks on the loop that serves all browser tabs, so they only put a note down; what it asks
for is done on another thread, one note after the other.
"""

from __future__ import annotations

import asyncio
import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from momentum_lab.app.hand_panel import HandPanel
from momentum_lab.app.pull import Drag
from momentum_lab.app.pulling import Pulling, Reach
from momentum_lab.app.wire import Truth
from momentum_lab.errors import InputError


@dataclass(frozen=True, slots=True)
class Note:
    """What one drag event has said, unchecked.

    Attributes:
        reach: the robot.
        joint: what was dragged moves with it.
        phase: `start`, `update` or `end`.
        places: where the hand began and is, where its owner looks from, each in the world.
        on_screen: where the hand began and is in the picture, and the picture's size.
    """

    reach: Reach
    joint: int
    phase: str
    places: tuple[object, object, object]
    on_screen: tuple[object, object, object]


class Hand:
    """The hand of one browser tab.

    Args:
        panel: says what a drag does.
        pulling: does it.
        tell: shows a person what was wrong.
    """

    def __init__(self, panel: HandPanel, pulling: Pulling, tell: Callable[[str], None]) -> None:
        self._panel, self._pulling, self._tell = panel, pulling, tell
        self._notes: deque[Note | None] = deque()
        self._acting = threading.Lock()
        self._reaches: list[tuple[Reach, str | None]] = []

    def reach(self, reach: Reach) -> None:
        """Let a robot be grabbed."""
        modifier = self._panel.modifier  # a browser may change it at any moment: it is read once
        self._listen(reach, modifier)
        self._reaches.append((reach, modifier))

    def follow(self, truth: Truth) -> None:
        """Take note of what is the case, which may end a pull, and of whether a drag needs Shift."""
        over = self._pulling.follow(truth)
        if over is not None:
            self.give_up()
            if over:
                self._tell(over)
        modifier = self._panel.modifier
        self._reaches = [(reach, bound) for reach, bound in self._reaches if reach.body.there]
        for reach, bound in self._reaches:
            if bound != modifier:
                self._listen(reach, modifier)
        self._reaches = [(reach, modifier) for reach, _ in self._reaches]

    def toggle(self) -> None:
        """Let a drag push the robot without Shift, or no longer."""
        self.give_up()  # a drag that goes on ends with the way it was begun in
        self._panel.toggle()

    def give_up(self) -> None:
        """Let go without a push."""
        self.note(None)
        self.act()

    def note(self, note: Note | None) -> None:
        """Put down what a drag event has said, or None for a hand that gives up; `act` does it."""
        self._notes.append(note)

    def act(self) -> None:
        """Do what the notes ask for, unless another thread is at it: that one does these, too.

        All tabs share a few threads, so none of them may wait here. Whoever has let go of the lock looks for notes
        once more: what was put down meanwhile is not left behind.
        """
        while self._notes and self._acting.acquire(blocking=False):
            try:
                self._work_off()
            finally:
                self._acting.release()

    def _listen(self, reach: Reach, modifier: str | None) -> None:
        async def note(joint: int, event: Any) -> None:
            camera = event.client.camera
            places = (event.start_position, event.end_position, camera.position)
            size = (camera.image_width, camera.image_height)
            on_screen = (event.start_screen_pos, event.end_screen_pos, size)
            self.note(Note(reach, joint, event.phase, places, on_screen))
            asyncio.get_running_loop().run_in_executor(None, self.act)

        reach.body.on_drag(note, modifier)

    def _work_off(self) -> None:
        """Do all notes; of several moves only the last one pulls, the others tell which way it took."""
        while self._notes:
            note = self._notes.popleft()
            after = self._notes[0] if self._notes else None
            try:
                if note and after and note.phase == after.phase == "update":
                    self._pulling.pass_by(Drag.checked(note.places, note.on_screen))
                else:
                    self._take(note)
            except InputError as error:
                self._pulling.drop()
                self._tell(str(error))

    def _take(self, note: Note | None) -> None:
        if note is None:
            self._pulling.drop()
            return
        drag = Drag.checked(note.places, note.on_screen)
        if note.phase == "start":
            self._pulling.begin(note.reach, note.joint, drag)
        elif note.phase == "end":
            self._pulling.let_go(drag)
        else:
            self._pulling.move(drag)
