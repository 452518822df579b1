"""The widgets that describe a push, and the push they describe."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, cast, get_args

import viser

from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.widgets import one_of
from momentum_lab.errors import InputError
from momentum_lab.physics.push import Push, Shape

# The chapter's push: what it does to the velocity of the CoM, m/s, and for how long, ms.
_VELOCITY_CHANGE, _DURATION = 0.24, 100.0
# The strongest push of the slider, as a velocity change in 0.1 s, m/s.
_STRONGEST = 0.7
_DIRECTIONS = {"forward": 0.0, "left": 90.0, "back": 180.0, "right": -90.0}
_TRUNK = "trunk"
_SHAPES: tuple[str, ...] = get_args(Shape)


class PushForm:
    """Force, duration, direction, body, height, shape.

    Args:
        gui: where they go.
        redraw: asks for a new picture.
    """

    def __init__(self, gui: viser.GuiApi, redraw: Callable[[], None]) -> None:
        self._grabbed: Push | None = None
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
        self._elevation: Any = gui.add_slider(
            "upwards (°)", -90.0, 90.0, 1.0, 0.0, hint="0 is horizontal, 90 straight up, -90 straight down."
        )
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
        self._shape: Any = gui.add_dropdown("shape", _SHAPES, hint="How the force runs over time.")
        self._wire(redraw)

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
        return 1e-3 * _number(self._duration, "duration")

    def set_robot(self, robot: LoadedRobot) -> None:
        """Fit ranges and bodies to a robot."""
        mass = robot.model.mass
        self._forget_point()
        self._force.max = _round(mass * _STRONGEST / 0.1)
        self._force.value = round(mass * _VELOCITY_CHANGE / (1e-3 * _DURATION))
        self._body.options = (_TRUNK, *(name for name in robot.model.spec.push_bodies if name != _TRUNK))

    def push(self) -> Push:
        """The push that the widgets describe.

        Raises:
            InputError: a value is not a number, or a shape is none.
        """
        grabbed = self._grabbed if self._at_point.value else None
        height = _number(self._height, "height")
        through_com = self._through_com.value or grabbed is not None
        return Push(
            force=_number(self._force, "force"),
            duration=self.duration,
            direction_deg=_number(self._direction, "direction"),
            elevation_deg=_number(self._elevation, "upwards"),
            height=None if through_com else height,
            body=grabbed.body if grabbed else None if self._body.value == _TRUNK else self._body.value,
            shape=cast(Shape, one_of(self._shape, "shape", _SHAPES)),
            point=grabbed.point if grabbed else None,
        )

    def show(self, push: Push) -> None:
        """Let the widgets describe a push."""
        if push.force is not None:
            self._force.value = min(push.force, self._force.max)
        self._duration.value = 1e3 * push.duration
        self._direction.value = (push.direction_deg + 180.0) % 360.0 - 180.0
        self._elevation.value = push.elevation_deg
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

    def _wire(self, redraw: Callable[[], None]) -> None:
        self._presets.on_click(lambda event: self._point_to(event.target.value))
        for box in (self._through_com, self._at_point):
            box.on_update(lambda _: self._free_height())
        self._body.on_update(self._other_body)
        numbers = (self._force, self._duration, self._direction, self._elevation, self._height)
        for widget in (*numbers, self._shape):
            widget.on_update(lambda _: redraw())

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


def _number(widget: Any, name: str) -> float:
    if not math.isfinite(widget.value):
        raise InputError(name, widget.value, "a finite number")
    return float(widget.value)


def _round(value: float) -> float:
    """A number with one or two leading digits."""
    power = 10.0 ** math.floor(math.log10(value) - 1.0)
    return math.ceil(value / power / 5.0) * 5.0 * power
