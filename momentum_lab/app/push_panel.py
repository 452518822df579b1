"""The push tab: one big button, how large the push is, what a hand does, and what to push with."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import viser

from momentum_lab.app import html
from momentum_lab.app.hand_panel import HandPanel
from momentum_lab.app.hand_words import HandsPush
from momentum_lab.app.push_form import PushForm
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.steady import blanks, steady
from momentum_lab.app.support_now import polygon_of
from momentum_lab.app.widgets import Post
from momentum_lab.errors import InputError
from momentum_lab.events import ApplyPush, ApplyPushes, Foresee
from momentum_lab.momentum.pendulum import pendulum_frequency, pendulum_impulse_bound
from momentum_lab.momentum.support import distance_to_edge
from momentum_lab.palette import VERMILLION
from momentum_lab.physics.push import Push
from momentum_lab.recording import Sample

# Slower than this, which the hint says, the robot stands still, and its support is what the next push meets, m/s.
_STILL = 0.02
_BOUND = (
    "Counted from where the robot was when its CoM was last slower than 2 cm/s, in the direction of the push: "
    "the nearer it was to the edge of the support, the less can be caught."
)


class PushPanel:
    """The widgets of the push tab.

    Args:
        gui: where they go.
        post: where events go.
        tell: shows a person what was wrong.
        redraw: asks for a new picture.

    Attributes:
        button: pushes.
        hand: what a hand in the picture does.
        form: describes the push.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        post: Post,
        tell: Callable[[str], None],
        redraw: Callable[[], None],
    ) -> None:
        self._post, self._tell = post, tell
        self._last: ApplyPush | ApplyPushes | None = None
        self._coarser = ""
        self._robot: LoadedRobot | None = None
        self._still: Sample | None = None
        self._size_text = ""
        self._by_hand: HandsPush | None = None
        gui.add_html(html.BIG_NEXT)
        self.button = gui.add_button("Push  (P)", color=VERMILLION, icon=viser.Icon.HAND_MOVE)
        ask = gui.add_button(
            "What would it do?  (F)",
            color="gray",
            icon=viser.Icon.EYE,
            hint="Tries the push on a copy of the robot and draws where its CoM and capture point would go.",
        )
        self._size = gui.add_html("")
        self.hand = HandPanel(gui, redraw)
        self.form = PushForm(gui, redraw)
        repeat = gui.add_button("Repeat the last push", color="gray", icon=viser.Icon.REPEAT)
        self.button.on_click(lambda _: self.apply())
        ask.on_click(lambda _: self.ask())
        repeat.on_click(lambda _: self.apply_again())

    def set_robot(self, robot: LoadedRobot) -> None:
        """Fit ranges and bodies to a robot."""
        self._robot, self._still, self._last, self._by_hand = robot, None, None, None
        self.form.set_robot(robot)

    def see(self, sample: Sample) -> None:
        """Take note of a sample: the size of a push is told for the robot as it last stood still."""
        if self._still is None or float(np.linalg.norm(sample["com_velocity"])) < _STILL:
            self._still = sample

    def refresh(self) -> None:
        """Write the size of the push that the button would give."""
        try:
            push = self.push()
            text = self._describe(push) + self._said_of_hand(push)
        except InputError as error:
            text = html.sentence(str(error))
        if text != self._size_text:
            self._size_text = self._size.content = text

    def push(self) -> Push:
        """The push that the widgets describe.

        Raises:
            InputError: a value is not a number.
        """
        return self.form.push()

    def show(self, push: Push) -> None:
        """Let the widgets describe a push."""
        self._by_hand = None
        self.form.show(push)

    def show_hand(self, push: Push, lead: str) -> None:
        """Let the widgets describe what a hand has done, and say so with some words for as long as they do."""
        self.form.show(push)
        self._by_hand = HandsPush(self.push(), lead)

    def apply(self) -> None:
        """Push."""
        try:
            self.give(self.push())
        except InputError as error:
            self._tell(str(error))

    def apply_again(self) -> None:
        """Give the last push once more; without one, the push that the widgets describe."""
        if self._last is None:
            self.apply()
        else:
            self._post(self._last)
            if self._coarser:
                self._tell(self._coarser)

    def ask(self) -> None:
        """Ask where the push would take the robot; nobody is pushed."""
        try:
            self._post(Foresee(self.push()))
        except InputError as error:
            self._tell(str(error))

    def give(self, push: Push) -> None:
        """Give a push, which can be repeated then."""
        self._post(ApplyPush(push))
        self.can_repeat(ApplyPush(push))

    def can_repeat(self, last: ApplyPush | ApplyPushes, coarser: str = "") -> None:
        """Take note of what was given last, and of what to tell whoever repeats it if it was finer."""
        self._last, self._coarser = last, coarser

    def _said_of_hand(self, push: Push) -> str:
        words = "" if self._by_hand is None else self._by_hand.words(push)
        return html.sentence(words) if words else ""

    def _describe(self, push: Push) -> str:
        """Impulse, and what part of it the CoP alone could catch."""
        words = f"{blanks(push.impulse, 1, 2)}<b>{push.impulse:.1f} N s</b>"
        bound = self._bound(push)
        if bound > 0.0:
            words += (
                f" = <b>{push.horizontal_part * push.impulse / bound:.2f}</b> of the pendulum bound "
                f'<span class="dim" title="{_BOUND}">({steady(bound, 1, 2)} N s: all that moving the CoP alone '
                "can catch)</span>"
            )
        return f'<div class="lab n">{words}</div>'

    def _bound(self, push: Push) -> float:
        """The largest horizontal impulse a pendulum standing like the robot survives without a step, N s."""
        if self._robot is None or self._still is None:
            return 0.0
        robot, sample = self._robot.model, self._still
        polygon = polygon_of(sample, robot)
        height = float(sample["com"][2] - sample["sole_pose"][:, 2].min())
        reach = distance_to_edge(sample["com"][:2], push.along, polygon)
        return pendulum_impulse_bound(robot.mass, pendulum_frequency(height), reach, push.duration)
