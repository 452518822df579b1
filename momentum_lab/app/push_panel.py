"""The push tab: what to push with, one big button, and how large the push is."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import viser

from momentum_lab.app import html
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.steady import blanks, steady
from momentum_lab.app.support_now import polygon_of
from momentum_lab.app.widgets import Post
from momentum_lab.errors import InputError
from momentum_lab.events import ApplyPush, ApplyPushes, Foresee
from momentum_lab.momentum.pendulum import pendulum_frequency, pendulum_impulse_bound
from momentum_lab.momentum.support import distance_to_edge
from momentum_lab.physics.push import Push
from momentum_lab.recording import Sample

# The chapter's push: what it does to the velocity of the CoM, m/s, and for how long, ms.
_VELOCITY_CHANGE, _DURATION = 0.24, 100.0
# The strongest push of the slider, as a velocity change in 0.1 s, m/s.
_STRONGEST = 0.7
_DIRECTIONS = {"forward": 0.0, "left": 90.0, "back": 180.0, "right": -90.0}
_TRUNK = "trunk"
_BY_HAND = ("pulse", "hold")
# Slower than this the robot stands still, and its support is what the next push will meet, m/s.
_STILL = 0.02


class PushPanel:
    """The widgets of the push tab.

    Args:
        gui: where they go.
        post: where events go.
        tell: shows a person what was wrong.
        redraw: asks for a new picture.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        post: Post,
        tell: Callable[[str], None],
        redraw: Callable[[], None],
    ) -> None:
        self._post, self._tell, self._redraw = post, tell, redraw
        self._last: ApplyPush | ApplyPushes | None = None
        self._grabbed: Push | None = None
        self._robot: LoadedRobot | None = None
        self._still: Sample | None = None
        self._size_text = ""
        gui.add_html(html.BIG_NEXT)
        self.button = gui.add_button("Push  (P)", color=(213, 94, 0), icon=viser.Icon.HAND_MOVE)
        self._ask = gui.add_button(
            "What would it do?  (F)",
            color="gray",
            icon=viser.Icon.EYE,
            hint="Tries the push on a copy of the robot and draws where its CoM and capture point would go.",
        )
        self._size = gui.add_html("")
        gui.add_html(html.sentence("Or hold Shift and drag the robot in the picture."))
        self._by_hand: Any = gui.add_dropdown(
            "by hand",
            _BY_HAND,
            hint="Shift and drag: pulse pushes for the duration below when you let go, "
            "hold pulls for as long as you do. Back where you began: no push.",
        )
        self._force: Any = gui.add_slider("force (N)", 0.0, 500.0, 1.0, 200.0, hint="Peak force of the push.")
        self._duration: Any = gui.add_slider(
            "duration (ms)", 10.0, 1000.0, 10.0, _DURATION, hint="How long the push lasts."
        )
        self._direction: Any = gui.add_slider(
            "direction (°)",
            -180.0,
            180.0,
            1.0,
            0.0,
            marks=((-90.0, "right"), (0.0, "forward"), (90.0, "left")),
            hint="Where the push points: 0 forward, 90 to the robot's left.",
        )
        self._presets = gui.add_button_group(" ", tuple(_DIRECTIONS))
        self._body: Any = gui.add_dropdown("body", (_TRUNK,), hint="Which body is pushed.")
        self._through_com: Any = gui.add_checkbox(
            "through the CoM", True, hint="Push at the height of the centre of mass."
        )
        self._height: Any = gui.add_slider(
            "height (m)",
            0.1,
            2.0,
            0.01,
            1.0,
            disabled=True,
            hint="Height of the push's line of action above the ground.",
        )
        self._at_point: Any = gui.add_checkbox(
            "where it was grabbed",
            False,
            visible=False,
            hint="Push at the point that your hand has pulled, which moves with the body.",
        )
        self._shape: Any = gui.add_dropdown(
            "shape", ("rectangle", "half-sine"), hint="How the force runs over time."
        )
        self.repeat = gui.add_button("Repeat the last push", color="gray", icon=viser.Icon.REPEAT)
        self._wire()

    @property
    def direction(self) -> np.ndarray:
        """Unit vector of the chosen direction (2,); forward while it is no number."""
        angle = float(self._direction.value)
        radians = math.radians(angle if math.isfinite(angle) else 0.0)
        return np.array([math.cos(radians), math.sin(radians)])

    @property
    def by_hand(self) -> str:
        """What a hand in the picture does: `pulse` or `hold`.

        Raises:
            InputError: a browser has chosen something else.
        """
        if self._by_hand.value not in _BY_HAND:
            raise InputError("by hand", self._by_hand.value, f"one of {', '.join(_BY_HAND)}")
        return str(self._by_hand.value)

    @property
    def strongest(self) -> float:
        """The most that the force slider gives, N."""
        return float(self._force.max)

    @property
    def duration(self) -> float:
        """How long a push lasts, s.

        Raises:
            InputError: it is no number.
        """
        if not math.isfinite(self._duration.value):
            raise InputError("duration", self._duration.value, "a finite number")
        return 1e-3 * float(self._duration.value)

    def set_robot(self, robot: LoadedRobot) -> None:
        """Fit ranges and bodies to a robot."""
        mass = robot.model.mass
        self._robot, self._still, self._last = robot, None, None
        self._forget_point()
        self._force.max = _round(mass * _STRONGEST / 0.1)
        self._force.value = round(mass * _VELOCITY_CHANGE / (1e-3 * _DURATION))
        self._body.options = (_TRUNK, *(name for name in robot.model.spec.push_bodies if name != _TRUNK))

    def see(self, sample: Sample) -> None:
        """Take note of a sample: the size of a push is told for the robot as it last stood still."""
        if self._still is None or float(np.linalg.norm(sample["com_velocity"])) < _STILL:
            self._still = sample

    def refresh(self) -> None:
        """Write the size of the push that the button would give."""
        try:
            text = self._describe(self.push())
        except InputError as error:
            text = html.sentence(str(error))
        if text != self._size_text:
            self._size_text = self._size.content = text

    def push(self) -> Push:
        """The push that the widgets describe.

        Raises:
            InputError: a value is not a number.
        """
        numbers = {
            "force": self._force.value,
            "duration": self._duration.value,
            "direction": self._direction.value,
            "height": self._height.value,
        }
        for name, value in numbers.items():
            if not math.isfinite(value):
                raise InputError(name, value, "a finite number")
        grabbed = self._grabbed if self._at_point.value else None
        through_com = self._through_com.value or grabbed is not None
        return Push(
            force=float(numbers["force"]),
            duration=1e-3 * numbers["duration"],
            direction_deg=float(numbers["direction"]),
            height=None if through_com else float(numbers["height"]),
            body=grabbed.body if grabbed else None if self._body.value == _TRUNK else self._body.value,
            shape=self._shape.value,
            point=grabbed.point if grabbed else None,
        )

    def show(self, push: Push) -> None:
        """Let the widgets describe a push."""
        if push.force is not None:
            self._force.value = min(push.force, self._force.max)
        self._duration.value = 1e3 * push.duration
        self._direction.value = (push.direction_deg + 180.0) % 360.0 - 180.0
        self._through_com.value = push.height is None
        self._height.value = self._height.value if push.height is None else push.height
        self._forget_point()
        name = push.body or _TRUNK
        if name not in self._body.options:
            self._body.options = (*self._body.options, name)
        self._body.value = name
        if push.point is not None:
            self._grabbed = push
            self._at_point.visible = self._at_point.value = True
        self._shape.value = push.shape
        self._free_height()

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

    def can_repeat(self, last: ApplyPush | ApplyPushes) -> None:
        """Take note of what was given last."""
        self._last = last

    def _wire(self) -> None:
        self.button.on_click(lambda _: self.apply())
        self._ask.on_click(lambda _: self.ask())
        self.repeat.on_click(lambda _: self.apply_again())
        self._presets.on_click(lambda event: self._point_to(event.target.value))
        for box in (self._through_com, self._at_point):
            box.on_update(lambda _: self._free_height())
        self._body.on_update(self._other_body)
        for widget in (self._force, self._duration, self._direction, self._height, self._shape):
            widget.on_update(lambda _: self._redraw())

    def _point_to(self, name: str) -> None:
        if name in _DIRECTIONS:
            self._direction.value = _DIRECTIONS[name]

    def _free_height(self) -> None:
        self._through_com.disabled = bool(self._at_point.value)
        self._height.disabled = bool(self._through_com.value or self._at_point.value)

    def _other_body(self, event: Any) -> None:
        """Another body has been chosen; a point of the one before means nothing on it."""
        if event.client is not None:
            self._forget_point()
            self._free_height()

    def _forget_point(self) -> None:
        self._grabbed = None
        self._at_point.visible = self._at_point.value = False

    def _describe(self, push: Push) -> str:
        """Impulse, and what part of it the CoP alone could catch."""
        words = f"{blanks(push.impulse, 1, 2)}<b>{push.impulse:.1f} N s</b>"
        bound = self._bound(push)
        if bound > 0.0:
            words += (
                f" = <b>{push.impulse / bound:.2f}</b> of the pendulum bound "
                f'<span class="dim">({steady(bound, 1, 2)} N s: all that moving the CoP alone can catch)</span>'
            )
        return f'<div class="lab n">{words}</div>'

    def _bound(self, push: Push) -> float:
        """The largest impulse a pendulum standing like the robot survives without a step, N s."""
        if self._robot is None or self._still is None:
            return 0.0
        robot, sample = self._robot.model, self._still
        polygon = polygon_of(sample, robot)
        height = float(sample["com"][2] - sample["sole_pose"][:, 2].min())
        reach = distance_to_edge(sample["com"][:2], push.direction[:2], polygon)
        return pendulum_impulse_bound(robot.mass, pendulum_frequency(height), reach, push.duration)


def _round(value: float) -> float:
    """A number with one or two leading digits."""
    power = 10.0 ** math.floor(math.log10(value) - 1.0)
    return math.ceil(value / power / 5.0) * 5.0 * power
