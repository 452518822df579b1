"""What a lesson lets a learner try: the few controls that it names, and no others."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import msgspec
import viser

from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.tuning_panel import gain_slider
from momentum_lab.app.widgets import Bound, Post
from momentum_lab.app.wire import Truth
from momentum_lab.control.gains import declared_gains
from momentum_lab.control.motion import ANGULAR_GOALS
from momentum_lab.control.registry import CONTROLLERS
from momentum_lab.events import (
    ApplyPush,
    Reset,
    SelectController,
    SelectRobot,
    SetAngularGoal,
    SetDirections,
    SetGain,
    SetPriority,
)
from momentum_lab.lesson.parts import PUSH_CONTROLS
from momentum_lab.momentum.directions import directions, text_of
from momentum_lab.palette import VERMILLION
from momentum_lab.physics.push import Push
from momentum_lab.robot.catalog import robot_names
from momentum_lab.scenario import Scenario

# The strongest push that can be tried, as a part of the one of the lesson.
_STRONGEST = 2.5
_MOMENTA = {"all six": "all", "linear and turning about up": "linear+kz", "linear only": "linear"}
_DEFAULT = Push(velocity_change=0.24)


class TryOut:
    """The controls of a step.

    Args:
        gui: where they go.
        post: where events go.
        names: the controls.
        scenario: the run whose push the sliders start with.
        robot: who plays.
        truth: what is the case at the start.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        post: Post,
        names: tuple[str, ...],
        scenario: Scenario,
        robot: LoadedRobot,
        truth: Truth,
    ) -> None:
        self._post = post
        first = scenario.pushes[0] if scenario.pushes else _DEFAULT
        self._base = first.sized_for(robot.model.mass)
        self._sliders: dict[str, Any] = {}
        self._followed: list[tuple[Bound[Any], Callable[[Truth], Any]]] = []
        for name in names:
            if name in PUSH_CONTROLS:
                self._add_push_slider(gui, name)
            else:
                self._add(gui, name, truth)
        self.pushes = any(name in PUSH_CONTROLS for name in names)
        if self.pushes:
            button = gui.add_button("Push it  (P)", color=VERMILLION, icon=viser.Icon.HAND_MOVE)
            button.on_click(lambda _: self.push())
        again = gui.add_button("Start again  (R)", color="gray", icon=viser.Icon.PLAYER_TRACK_PREV)
        again.on_click(lambda _: post(Reset()))

    def push(self) -> None:
        """Push as the sliders say."""
        values = {name: float(slider.value) for name, slider in self._sliders.items()}
        changes: dict[str, float] = {}
        if "push" in values:
            changes["force"] = values["push"]
        if "push direction" in values:
            changes["direction_deg"] = values["push direction"]
        if "push duration" in values:
            changes["duration"] = 1e-3 * values["push duration"]
        if "push height" in values:
            changes["height"] = values["push height"]
        self._post(ApplyPush(msgspec.structs.replace(self._base, **changes)))

    def follow(self, truth: Truth) -> None:
        """Show what is the case."""
        for bound, value in self._followed:
            found = value(truth)
            if found is not None:
                bound.follow(found)

    def _add_push_slider(self, gui: viser.GuiApi, name: str) -> None:
        base = self._base
        if name == "push":
            force = base.force or 0.0
            slider = gui.add_slider("force (N)", 0.0, round(_STRONGEST * force), 1.0, round(force))
        elif name == "push direction":
            marks = ((-90.0, "right"), (0.0, "forward"), (90.0, "left"))
            slider = gui.add_slider("direction (°)", -180.0, 180.0, 5.0, base.direction_deg, marks=marks)
        elif name == "push duration":
            slider = gui.add_slider("duration (ms)", 10.0, 1000.0, 10.0, 1e3 * base.duration)
        else:
            slider = gui.add_slider("height (m)", 0.1, 2.0, 0.01, base.height or 1.0)
        self._sliders[name] = slider

    def _add(self, gui: viser.GuiApi, name: str, truth: Truth) -> None:
        if name == "priority":
            hint = "0: hold the CoM. 1: hold the posture."
            slider = gui.add_slider("priority", 0.0, 1.0, 0.01, truth.priority, hint=hint)
            self._bind(Bound[float](slider, SetPriority, self._post), lambda truth: truth.priority)
        elif name == "robot":
            box = gui.add_dropdown("robot", tuple(robot_names()), initial_value=truth.robot)
            self._bind(Bound[str](box, SelectRobot, self._post), lambda truth: truth.robot)
        elif name == "controller":
            box = gui.add_dropdown("controller", tuple(CONTROLLERS), initial_value=truth.controller)
            self._bind(Bound[str](box, SelectController, self._post), lambda truth: truth.controller)
        elif name == "momenta":
            self._add_momenta(gui, truth)
        elif name == "angular goal":
            box = gui.add_dropdown("angular goal", ANGULAR_GOALS, initial_value=truth.angular_goal)
            self._bind(Bound[str](box, _angular_goal, self._post), lambda truth: truth.angular_goal)
        else:
            self._add_gain(gui, name, truth)

    def _add_momenta(self, gui: viser.GuiApi, truth: Truth) -> None:
        words = {text: name for name, text in _MOMENTA.items()}
        known = {text_of(directions(text)): name for text, name in words.items()}
        box = gui.add_dropdown(
            "momenta held", tuple(_MOMENTA), initial_value=known.get(truth.controlled, next(iter(_MOMENTA)))
        )
        self._bind(
            Bound[str](box, lambda name: SetDirections(_MOMENTA[name]), self._post),
            lambda truth: known.get(truth.controlled),
        )

    def _add_gain(self, gui: viser.GuiApi, name: str, truth: Truth) -> None:
        gain = declared_gains(CONTROLLERS[truth.controller].gains).get(name)
        if gain is None:
            return  # another controller is on stage, which has no such gain
        slider = gain_slider(gui, gain, truth.gains.get(name, gain.default))
        self._bind(
            Bound[float](slider, lambda value: SetGain(name, value), self._post),
            lambda truth: truth.gains.get(name),
        )

    def _bind(self, bound: Bound[Any], value: Callable[[Truth], Any]) -> None:
        self._followed.append((bound, value))


def _angular_goal(name: str) -> SetAngularGoal:
    return SetAngularGoal(next(goal for goal in ANGULAR_GOALS if goal == name))
