"""What the robot stands on: friction, and plates that sway, tilt and lift under its feet."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, TypeVar

import viser

from momentum_lab.app.widgets import Bound, Post
from momentum_lab.app.wire import Truth
from momentum_lab.errors import InputError
from momentum_lab.events import MoveGround, SetFriction, SetGroundSense, StopGround
from momentum_lab.physics.plate import Axis, Course, PlateMotion

Choice = TypeVar("Choice", bound=str)
_ALL = "all feet"
_WAYS: dict[str, Axis] = {
    "forward and back": "x",
    "left and right": "y",
    "up and down": "z",
    "roll (left side up)": "roll",
    "pitch (front down)": "pitch",
}
_COURSES: dict[str, Course] = {"to and fro": "sine", "once": "step"}
_SENSES = {"told": "is told how it moves", "felt": "feels it through its soles"}
_TOLD = {words: sense for sense, words in _SENSES.items()}


class GroundPanel:
    """The widgets of the ground.

    Args:
        gui: where they go.
        post: where events go.
        tell: shows a person what was wrong.
        feet: names of the robot's feet.
    """

    def __init__(
        self, gui: viser.GuiApi, post: Post, tell: Callable[[str], None], feet: tuple[str, ...]
    ) -> None:
        self._post, self._tell, self._feet = post, tell, feet
        with gui.add_folder("Ground", expand_by_default=False):
            self._foot: Any = gui.add_dropdown("under", (_ALL, *feet), hint="Whose ground is changed.")
            self._friction: Bound[float] = Bound(
                gui.add_slider(
                    "friction", 0.05, 1.5, 0.05, 0.7, hint="Coulomb coefficient: 0.1 ice, 1 rubber (no unit)."
                ),
                lambda value: SetFriction(value, self._name),
                post,
            )
            self._way: Any = gui.add_dropdown("motion", tuple(_WAYS), hint="Where the plate goes or turns.")
            self._course: Any = gui.add_dropdown(
                "how often", tuple(_COURSES), hint="A sway, or a single step."
            )
            self._far: Any = gui.add_slider(
                "how far (cm, °)", -15.0, 15.0, 0.5, 5.0, hint="Centimetres along an axis, degrees about one."
            )
            self._period: Any = gui.add_slider(
                "period (s)", 0.5, 10.0, 0.1, 2.0, hint="Of the sway, or how long the step takes."
            )
            self._sense: Bound[str] = Bound(
                gui.add_dropdown("the robot", tuple(_TOLD), hint="What it knows of the ground it stands on."),
                lambda words: SetGroundSense(_TOLD.get(words, words)),  # type: ignore[arg-type]
                post,
            )
            move = gui.add_button("Move the ground", icon=viser.Icon.ARROWS_MOVE)
            rest = gui.add_button("Let it come to rest", color="gray", icon=viser.Icon.PLAYER_STOP)
        move.on_click(lambda _: self.move())
        rest.on_click(lambda _: post(StopGround()))

    def follow(self, truth: Truth) -> None:
        """Show the friction and the sense that are the case."""
        if truth.friction:
            self._friction.follow(
                truth.friction[self._feet.index(self._name) if self._name in self._feet else 0]
            )
        self._sense.follow(_SENSES[truth.ground_sense])

    def set_feet(self, feet: tuple[str, ...]) -> None:
        """Fit the choice to a robot."""
        if feet != self._feet:
            self._feet = feet
            self._foot.options = (_ALL, *feet)

    def move(self) -> None:
        """Let the plate begin the motion that the widgets describe."""
        try:
            self._post(MoveGround(self._motion(), self._name))
        except InputError as error:
            self._tell(str(error))

    @property
    def _name(self) -> str:
        """The chosen foot; empty for all. A name that no foot has is for the session to refuse."""
        return "" if self._foot.value == _ALL else str(self._foot.value)

    def _motion(self) -> PlateMotion:
        axis = _chosen("motion", self._way.value, _WAYS)
        course = _chosen("how often", self._course.value, _COURSES)
        far, period = _number("how far", self._far.value), _number("period", self._period.value)
        return PlateMotion(axis, far if axis in ("roll", "pitch") else 0.01 * far, course, period)


def _chosen(name: str, value: object, choices: dict[str, Choice]) -> Choice:
    """What a word of a dropdown means.

    Raises:
        InputError: a client has sent another word.
    """
    if not isinstance(value, str) or value not in choices:
        raise InputError(name, value, f"one of {', '.join(choices)}")
    return choices[value]


def _number(name: str, value: object) -> float:
    """The number of a slider.

    Raises:
        InputError: a client has sent something else.
    """
    if not isinstance(value, int | float) or not math.isfinite(value):
        raise InputError(name, value, "a finite number")
    return float(value)
