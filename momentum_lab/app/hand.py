"""A person's hand in the picture: Shift and drag pulls the robot where it was grabbed, and letting go pushes it.

Viser calls ordered callbacks on the loop that serves all browser tabs, so they only put a note down; what it asks
for is done on another thread, one note after the other.
"""

from __future__ import annotations

import asyncio
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import viser

from momentum_lab.app.hand_scene import HandScene
from momentum_lab.app.pull import Grip, Scale, chain_of, finite, from_now, grip, mean_of, pulled
from momentum_lab.app.push_panel import PushPanel
from momentum_lab.app.robot_scene import RobotScene
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.view_panel import ViewSettings
from momentum_lab.app.widgets import Post
from momentum_lab.errors import InputError
from momentum_lab.events import ApplyPushes, HoldPush, LetGo
from momentum_lab.physics.push import Push

# A held push that is let go has ended by then, s: at the next tick.
_SETTLED = 0.15


@dataclass(frozen=True, slots=True)
class Reach:
    """A robot that can be grabbed.

    Attributes:
        body: its meshes.
        robot: the robot.
        size: height of its CoM as it stands, m.
        offset: from its own world to where it is drawn (3,), m.
    """

    body: RobotScene
    robot: LoadedRobot
    size: float
    offset: np.ndarray


@dataclass(frozen=True, slots=True)
class Note:
    """What one drag event has said, unchecked."""

    reach: Reach
    joint: int
    phase: str
    start: object
    end: object
    eye: object


@dataclass(slots=True)
class Pull:
    """A pull that is going on."""

    grip: Grip
    holds: bool
    held: Push | None = None


class Hand:
    """The hand of one browser tab.

    Args:
        client: the browser tab.
        panel: describes pushes, and shows those of the hand.
        settings: how long arrows are.
        post: where events go.
        tell: shows a person what was wrong.
        pushes: the pushes of the run so far.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        panel: PushPanel,
        settings: ViewSettings,
        post: Post,
        tell: Callable[[str], None],
        pushes: Callable[[], tuple[Push, ...]],
    ) -> None:
        self._panel, self._settings = panel, settings
        self._post, self._tell, self._pushes = post, tell, pushes
        self._scene = HandScene(client)
        self._notes: deque[Note] = deque()
        self._acting = threading.Lock()
        self._pull: Pull | None = None
        # How long what was held has lasted, and how long pushes were before the panel showed that, s.
        self._durations = (0.0, 0.0)
        self.playing = True

    def reach(self, reach: Reach) -> None:
        """Let a robot be grabbed."""

        async def note(joint: int, event: Any) -> None:
            places = (event.start_position, event.end_position, event.client.camera.position)
            self.note(Note(reach, joint, event.phase, *places))
            asyncio.get_running_loop().run_in_executor(None, self.act)

        reach.body.on_drag(note)

    def note(self, note: Note) -> None:
        """Put down what a drag event has said; `act` does it."""
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

    def _work_off(self) -> None:
        """Do all notes; of several moves only the last one counts."""
        while self._notes:
            note = self._notes.popleft()
            if note.phase == "update" and self._notes and self._notes[0].phase == "update":
                continue
            try:
                self._take(note)
            except InputError as error:
                self._drop()
                self._tell(str(error))

    def _take(self, note: Note) -> None:
        start, end = finite(note.start, 3, "drag"), finite(note.end, 3, "drag")
        eye = finite(note.eye, 3, "camera")
        if note.phase == "start":
            self._drop()
            held = self._panel.by_hand == "hold" and self.playing
            self._pull = Pull(self._grip(note, start), held)
        pull = self._pull
        if pull is None:
            return  # nothing was grabbed, or it was refused
        reach = note.reach
        scale = Scale.of(reach.robot.model, reach.size, self._settings.arrow_scale, self._panel.strongest)
        force = scale.force(pulled(eye, start, end))
        if pull.holds:
            self._hold(pull, force, scale)
        if note.phase == "end":
            self._let_go(pull, force)
            return
        if pull.held is not None and "push" in self._settings.shown:
            self._scene.clear()  # the push itself is in the picture
            return
        words = _words(pull, force, scale, self.playing)
        self._scene.draw(start, np.append(scale.length(force), 0.0), words, reach.size)

    def _grip(self, note: Note, start: np.ndarray) -> Grip:
        reach = note.reach
        return grip(reach.robot.model, reach.body.drawn, note.joint, start - reach.offset)

    def _hold(self, pull: Pull, force: np.ndarray, scale: Scale) -> None:
        """Give the force of now, if it is another one."""
        piece = pull.grip.piece(force, scale.strongest)
        if (piece.force and pull.held is None) or (pull.held is not None and piece != pull.held):
            pull.held = piece
            self._post(HoldPush(piece))

    def _let_go(self, pull: Pull, force: np.ndarray) -> None:
        """What a hand does that opens: the push, or the end of the one that was held."""
        self._pull = None
        self._scene.clear()
        if pull.held is not None:
            self._post(LetGo())
            self._remember()
        elif not pull.holds and force.any():
            push = pull.grip.pulse(force, self._duration())
            self._panel.show(push)
            self._panel.give(push)

    def _remember(self) -> None:
        """Let the panel show what was held, and repeat it."""
        time.sleep(_SETTLED)
        pieces = chain_of(self._pushes())
        if pieces and pieces[-1].point is not None and self.playing:
            before = self._duration()
            self._panel.show(mean_of(pieces))
            self._durations = (self._panel.duration, before)
            self._panel.can_repeat(ApplyPushes(from_now(pieces)))

    def _duration(self) -> float:
        """How long a push is to last, s: what the panel says, unless that is how long something was held."""
        shown, before = self._durations
        return before if self._panel.duration == shown else self._panel.duration

    def _drop(self) -> None:
        """Open the hand without a push."""
        pull, self._pull = self._pull, None
        self._scene.clear()
        if pull is not None and pull.held is not None:
            self._post(LetGo())


def _words(pull: Pull, force: np.ndarray, scale: Scale, playing: bool) -> str:
    """What the label of the arrow says: how strong, on what, and what letting go will do."""
    strength = float(np.linalg.norm(force))
    if not strength:
        return "let go: no push"
    words = f"{strength:.0f} N on {pull.grip.body.replace('_', ' ')}"
    if strength > 0.999 * scale.strongest:
        words += ", the most"
    if pull.holds:
        return f"{words}, held"
    return words if playing else f"{words}, waits for play"
