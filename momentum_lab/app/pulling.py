"""One pull of a hand after the other: what a drag so far amounts to, what is drawn of it, and what it posts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import msgspec
import numpy as np
import viser

from momentum_lab.app.hand_scene import HandScene
from momentum_lab.app.hand_words import HOLD, PULSE
from momentum_lab.app.held import Held
from momentum_lab.app.inbox import MOST_PUSHES
from momentum_lab.app.pull import Drag, Grip, Scale, WayBack, grip
from momentum_lab.app.push_panel import PushPanel
from momentum_lab.app.robot_scene import RobotScene
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.view_panel import ViewSettings
from momentum_lab.app.widgets import Post
from momentum_lab.app.wire import Truth
from momentum_lab.events import ApplyPushes, HoldPush, LetGo
from momentum_lab.physics.push import MAX_DURATION, Push


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


@dataclass(slots=True)
class Pull:
    """A pull that is going on.

    Attributes:
        reach: the robot.
        grip: what of it.
        holds: whether it pushes while it goes on.
        run: in which run it began.
        held: the piece that was posted last.
        way: of the hand.
    """

    reach: Reach
    grip: Grip
    holds: bool
    run: int
    held: Push | None = None
    way: WayBack = field(default_factory=WayBack)

    def has_lasted(self, latest: Push | None) -> bool:
        """Whether what is held is the latest push of a run, and has lasted as long as a push can."""
        if latest is None or self.held is None or latest.duration < MAX_DURATION:
            return False
        return (
            msgspec.structs.replace(latest, start=self.held.start, duration=self.held.duration) == self.held
        )


class Pulling:
    """The pulls of one browser tab.

    Args:
        client: the browser tab.
        panel: describes pushes, and shows those of the hand.
        settings: how long arrows are.
        post: where events go.
        pushes: the pushes of the run so far.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        panel: PushPanel,
        settings: ViewSettings,
        post: Post,
        pushes: Callable[[], tuple[Push, ...]],
    ) -> None:
        self._panel, self._settings = panel, settings
        self._post, self._pushes = post, pushes
        self._scene = HandScene(client)
        self._pull: Pull | None = None
        # How long what was held has lasted, and how long pushes were before the panel showed that, s.
        self._durations = (0.0, 0.0)
        self.playing, self.run = True, -1

    def follow(self, truth: Truth) -> str | None:
        """Take note of what is the case: why a pull is over without the hand, for people; None while it is not."""
        self.playing, self.run = truth.playing, truth.run
        pull = self._pull
        if pull is None:
            return None
        if pull.run != truth.run or not pull.reach.body.there:
            return ""  # it was another robot, or one that stands again: everybody sees that
        if pull.has_lasted(truth.push):
            return f"A push is held for {MAX_DURATION:g} s at most: let go, and grab the robot again."
        return None

    def begin(self, reach: Reach, joint: int, drag: Drag) -> None:
        """Take hold of what moves with a joint.

        Raises:
            InputError: a browser has chosen what no widget offers.
        """
        self.drop()
        if not reach.body.there:
            return
        held = self._panel.hand.by_hand == "hold" and self.playing
        taken = grip(reach.robot.model, reach.body.drawn, joint, drag.start - reach.offset)
        self._pull = Pull(reach, taken, held, self.run)
        self.move(drag)

    def move(self, drag: Drag) -> None:
        """Draw the pull as it is now; a hold gives its force."""
        pull = self._present()
        if pull is None:
            return  # nothing was grabbed, or it was refused
        size = pull.reach.size
        force, scale = self._force(pull, drag)
        if pull.held is not None and "push" in self._settings.shown:
            self._scene.clear()  # the push itself is in the picture
            return
        home = "back here: no push" if pull.way.left and force.any() else ""
        words = _words(pull, force, scale, self.playing)
        self._scene.draw(drag.start, scale.length(force), words, home, size)

    def pass_by(self, drag: Drag) -> None:
        """Take note of where a hand has been that is somewhere else by now: nothing is drawn or held of it."""
        if self._pull is not None:
            self._pull.way.go(drag.off)

    def let_go(self, drag: Drag) -> None:
        """What a hand does that opens: the push, or the end of the one that was held."""
        pull = self._present()
        if pull is None:
            return
        force, _ = self._force(pull, drag)
        self._pull = None
        self._scene.clear()
        if pull.held is not None:
            self._post(LetGo())
            self._remember(pull.grip)
        elif not pull.holds and force.any():
            push = pull.grip.pulse(force, self._duration())
            self._panel.show_hand(push, PULSE)
            self._panel.give(push)

    def drop(self) -> None:
        """Open the hand without a push."""
        pull, self._pull = self._pull, None
        self._scene.clear()
        if pull is not None and pull.held is not None:
            self._post(LetGo())

    def _present(self) -> Pull | None:
        """The pull that is going on; one on a robot that has left is given up."""
        if self._pull is not None and not self._pull.reach.body.there:
            self.drop()
        return self._pull

    def _force(self, pull: Pull, drag: Drag) -> tuple[np.ndarray, Scale]:
        """The force of now (3,), N, which a hold gives if it is another one; and how strong pulls are."""
        robot, strongest = pull.reach.robot.model, self._panel.form.strongest
        scale = Scale.of(robot, pull.reach.size, self._settings.arrow_scale, strongest)
        distance = self._panel.hand.pulled(drag.eye, drag.start, drag.end)
        # What is held acts at once: it has to grow weaker without a step, and cannot be taken back.
        given_up = not pull.holds and pull.way.is_back(drag.off)
        force = scale.force(np.zeros(3) if given_up else distance)
        if pull.holds:
            self._hold(pull, pull.grip.piece(force, scale.strongest))
        return force, scale

    def _hold(self, pull: Pull, piece: Push) -> None:
        if (piece.force and pull.held is None) or (pull.held is not None and piece != pull.held):
            pull.held = piece
            self._post(HoldPush(piece))

    def _remember(self, taken: Grip) -> None:
        """Let the panel show what was held, and repeat it."""
        held = Held.last_of(self._pushes(), taken)
        if held is not None:
            before = self._duration()
            self._panel.show_hand(held.mean, HOLD)
            self._durations = (self._panel.form.duration, before)
            pieces = held.from_now(MOST_PUSHES)
            self._panel.can_repeat(ApplyPushes(pieces), _coarser(len(held.pieces), len(pieces)))

    def _duration(self) -> float:
        """How long a push is to last, s: what the panel says, unless that is how long something was held."""
        shown, before = self._durations
        return before if self._panel.form.duration == shown else self._panel.form.duration


def _coarser(held: int, repeated: int) -> str:
    """What to tell whoever repeats a hold of so many pieces in so many; nothing if they are the same."""
    if held == repeated:
        return ""
    return f"Your hand pulled in {held} pieces; they are repeated in {repeated}, with the same impulse."


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
