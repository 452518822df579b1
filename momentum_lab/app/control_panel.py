"""The control tab: robot, scenario, controller, which momentum is kept, and the gains as they declare themselves."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import viser

from momentum_lab.app import html
from momentum_lab.app.widgets import Bound, Post, nice_step
from momentum_lab.app.wire import Truth
from momentum_lab.control.controller import SLACKS
from momentum_lab.control.gains import GainInfo, declared_gains
from momentum_lab.control.motion import ANGULAR_GOALS, MOTIONS
from momentum_lab.control.planner import PLANNERS
from momentum_lab.control.registry import CONTROLLERS
from momentum_lab.events import (
    LoadScenario,
    SelectController,
    SelectPlanner,
    SelectRobot,
    SetAngularGoal,
    SetDirections,
    SetGain,
    SetMotion,
    SetPriority,
)
from momentum_lab.momentum.directions import directions, text_of
from momentum_lab.recording import Sample

_DIRECTIONS = ("lx: forward", "ly: left", "lz: up", "kx: about forward", "ky: about left", "kz: about up")
_SLACK_UNITS = tuple("m/s²" if name.startswith("com") else "rad/s²" for name in SLACKS)
# How often the slacks change on the screen, s.
_PERIOD = 0.1
_STILL = "stand still"
# Viser breaks labels after a slash; this one it does not know.
_TYPOGRAPHY = str.maketrans("/", "∕")


@dataclass(frozen=True, slots=True)
class Choices:
    """What can be chosen.

    Attributes:
        robots: names of robots.
        scenarios: names of scenarios.
    """

    robots: tuple[str, ...]
    scenarios: tuple[str, ...]


class ControlPanel:
    """The widgets of the control tab.

    Args:
        gui: where they go.
        post: where events go.
        choices: what can be chosen.
        truth: what is the case at the start.
    """

    def __init__(self, gui: viser.GuiApi, post: Post, choices: Choices, truth: Truth) -> None:
        self._gui, self._post = gui, post
        self._scenario_name = truth.scenario
        self._robot = Bound(
            gui.add_dropdown("robot", choices.robots, initial_value=truth.robot), SelectRobot, post
        )
        self._scenario = Bound(
            gui.add_dropdown("scenario", choices.scenarios, initial_value=truth.scenario), LoadScenario, post
        )
        again = gui.add_button("Start the scenario again", color="gray", icon=viser.Icon.PLAYER_TRACK_PREV)
        again.on_click(lambda _: post(LoadScenario(self._scenario_name)))
        self._controller = Bound(
            gui.add_dropdown("controller", tuple(CONTROLLERS), initial_value=truth.controller),
            SelectController,
            post,
        )
        self._planner = Bound(
            gui.add_dropdown(
                "planner",
                tuple(PLANNERS),
                initial_value=truth.planner,
                hint=" ".join(f"{name}: {planner.summary}" for name, planner in PLANNERS.items()),
            ),
            SelectPlanner,
            post,
        )
        self._motion: Bound[str] = Bound(
            gui.add_dropdown("motion", (_STILL, *MOTIONS), initial_value=truth.motion or _STILL),
            lambda name: SetMotion("" if name == _STILL else name),
            post,
        )
        self._angular_goal: Bound[str] = Bound(
            gui.add_dropdown(
                "angular goal",
                ANGULAR_GOALS,
                initial_value=truth.angular_goal,
                hint="zero: no angular momentum is asked for. reference: that of the motion itself.",
            ),
            lambda name: SetAngularGoal(next(goal for goal in ANGULAR_GOALS if goal == name)),
            post,
        )
        gui.add_html(html.sentence("When the ground cannot give both momentum rates:"))
        self._priority: Bound[float] = Bound(
            gui.add_slider(
                "priority",
                0.0,
                1.0,
                0.01,
                truth.priority,
                hint="0 keeps linear momentum: the CoP moves and the body turns. 1 keeps angular momentum: "
                "the force tilts and the CoM moves.",
            ),
            SetPriority,
            post,
        )
        gui.add_html(html.slider_ends("hold the CoM", "hold the posture"))
        self._slacks = gui.add_html("", visible=False)
        self._slacks_text = ""
        self._next = -math.inf
        self._directions = _Directions(gui, post, truth)
        self._gains: _GainPanel = _GainPanel(gui, post, truth)

    def follow(self, truth: Truth) -> None:
        """Show what is the case."""
        self._scenario_name = truth.scenario
        self._robot.follow(truth.robot)
        if truth.scenario not in self._scenario.handle.options:
            self._scenario.handle.options = (*self._scenario.handle.options, truth.scenario)
        self._scenario.follow(truth.scenario)
        self._controller.follow(truth.controller)
        self._planner.follow(truth.planner)
        self._motion.follow(truth.motion or _STILL)
        self._angular_goal.follow(truth.angular_goal)
        self._priority.follow(truth.priority)
        self._directions.follow(truth)
        if truth.controller != self._gains.controller:
            self._gains.remove()
            self._gains = _GainPanel(self._gui, self._post, truth)
        self._gains.follow(truth)

    def see(self, sample: Sample) -> None:
        """Show the slacks of a sample, ten times a second at most, if its controller has any."""
        slack = sample["slack"]
        if time.monotonic() < self._next:
            return
        self._next = time.monotonic() + _PERIOD
        self._slacks.visible = bool(slack.any())
        text = html.slacks(zip(SLACKS, slack.tolist(), _SLACK_UNITS, strict=True))
        if text != self._slacks_text and self._slacks.visible:
            self._slacks_text = self._slacks.content = text


class _Directions:
    """Six ticks: which directions of momentum are asked for, and which may become what they like."""

    def __init__(self, gui: viser.GuiApi, post: Post, truth: Truth) -> None:
        self._chosen = list(directions(truth.controlled))
        with gui.add_folder("Directions asked for", expand_by_default=False):
            gui.add_html(html.sentence("A direction without a tick is left to posture and feet."))
            self._boxes: list[Bound[bool]] = [
                Bound(gui.add_checkbox(words, chosen), self._setter(i), post)
                for i, (words, chosen) in enumerate(zip(_DIRECTIONS, self._chosen, strict=True))
            ]

    def follow(self, truth: Truth) -> None:
        self._chosen = list(directions(truth.controlled))
        for box, chosen in zip(self._boxes, self._chosen, strict=True):
            box.follow(chosen)

    def _setter(self, i: int) -> Callable[[bool], SetDirections]:
        def event(on: bool) -> SetDirections:
            self._chosen[i] = on
            lx, ly, lz, kx, ky, kz = self._chosen
            return SetDirections(text_of((lx, ly, lz, kx, ky, kz)))

        return event


class _GainPanel:
    """One slider per declared gain, folded away until somebody wants them."""

    def __init__(self, gui: viser.GuiApi, post: Post, truth: Truth) -> None:
        self.controller = truth.controller
        self._post = post
        self._declared = declared_gains(CONTROLLERS[truth.controller].gains)
        self._folder = gui.add_folder("Gains", expand_by_default=False)
        with self._folder:
            self._sliders = {
                gain.name: Bound[float](_slider(gui, gain, truth.gains[gain.name]), _setter(gain.name), post)
                for gain in self._declared.values()
            }
        self._changed = gui.add_html("")
        self._changed_text = ""
        self._reset = gui.add_button("Reset the gains", color="gray", icon=viser.Icon.RESTORE)
        self._reset.on_click(lambda _: self._to_defaults())
        self._values: dict[str, float] = {}

    def follow(self, truth: Truth) -> None:
        for name, slider in self._sliders.items():
            slider.follow(truth.gains[name])
        if truth.gains == self._values:
            return
        self._values = dict(truth.gains)
        text = html.changes(changed_gains(self._declared.values(), self._values))
        if text != self._changed_text:
            self._changed_text = self._changed.content = text

    def remove(self) -> None:
        for handle in (self._folder, self._changed, self._reset):
            handle.remove()

    def _to_defaults(self) -> None:
        for gain in self._declared.values():
            if self._values.get(gain.name) != gain.default:
                self._post(SetGain(gain.name, gain.default))


def changed_gains(declared: Sequence[GainInfo] | Any, values: dict[str, float]) -> list[str]:
    """Gains that differ from their defaults, in words: name, default, value, unit.

    Args:
        declared: the gains.
        values: what they are now, by name.
    """
    return [
        f"{_words(gain)}: {gain.default:g} → {values[gain.name]:g} {_unit(gain)}".strip()
        for gain in declared
        if values[gain.name] != gain.default
    ]


def _slider(gui: viser.GuiApi, gain: GainInfo, value: float) -> Any:
    unit = _unit(gain)
    return gui.add_slider(
        f"{_words(gain)} ({unit})" if unit else _words(gain),
        gain.low,
        gain.high,
        nice_step(gain.low, gain.high, gain.default),
        value,
        hint=f"{gain.help} From {gain.low:g} to {gain.high:g} {unit}; default {gain.default:g}.",
    )


def _setter(name: str) -> Any:
    return lambda value: SetGain(name, value)


def _words(gain: GainInfo) -> str:
    return gain.name.replace("_", " ")


def _unit(gain: GainInfo) -> str:
    return "" if gain.unit == "1" else gain.unit.translate(_TYPOGRAPHY).replace("^2", "²").replace("^3", "³")
