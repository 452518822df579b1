"""The control tab: robot, scenario, controller, which momentum is kept, and the gains as they declare themselves."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

import viser

from momentum_lab.app import html, look_html
from momentum_lab.app.bounds_panel import BoundsPanel
from momentum_lab.app.changes_panel import ChangesPanel
from momentum_lab.app.tuning_panel import TuningPanel
from momentum_lab.app.widgets import Bound, Post
from momentum_lab.app.wire import Truth
from momentum_lab.control.controller import SLACKS
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
        tell: shows a person what was wrong.
        choices: what can be chosen.
        truth: what is the case at the start.
    """

    def __init__(
        self, gui: viser.GuiApi, post: Post, tell: Callable[[str], None], choices: Choices, truth: Truth
    ) -> None:
        self._gui, self._post, self._tell = gui, post, tell
        self._scenario_name = truth.scenario
        self._add_scenario(choices, truth)
        self._add_goals(truth)
        self._add_priority(truth)
        self.bounds = BoundsPanel(gui)
        self._slacks = gui.add_html("", visible=False)
        self._slacks_text = ""
        self._next = -math.inf
        self._directions = _Directions(gui, post, truth)
        self._changes = ChangesPanel(gui, post, tell, truth)
        self._place = gui.add_form(None)  # where gains of another controller find the way back to
        with self._place:
            gui.add_html(look_html.LEVEL)
            self._gains = TuningPanel(gui, post, tell, truth)

    def _add_scenario(self, choices: Choices, truth: Truth) -> None:
        """Who stands where."""
        gui, post = self._gui, self._post
        self._robot = Bound(
            gui.add_dropdown("robot", choices.robots, initial_value=truth.robot), SelectRobot, post
        )
        self._scenario = Bound(
            gui.add_dropdown("scenario", choices.scenarios, initial_value=truth.scenario), LoadScenario, post
        )
        again = gui.add_button("Start the scenario again", color="gray", icon=viser.Icon.PLAYER_TRACK_PREV)
        again.on_click(lambda _: post(LoadScenario(self._scenario_name)))

    def _add_goals(self, truth: Truth) -> None:
        """Who keeps the balance, and what is asked for."""
        gui, post = self._gui, self._post
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

    def _add_priority(self, truth: Truth) -> None:
        """Which momentum gives way."""
        gui, post = self._gui, self._post
        gui.add_html(html.sentence("When the ground cannot give both momentum rates:"))
        self._priority: Bound[float] = Bound(
            gui.add_slider(
                "priority",
                0.0,
                1.0,
                0.01,
                truth.priority,
                hint="From 0 to 1 (no unit). 0 keeps linear momentum: the CoP moves and the body turns, until its "
                "joints run out of room and the capture point is safe. 1 keeps angular momentum: the force tilts "
                "and the CoM moves.",
            ),
            SetPriority,
            post,
        )
        gui.add_html(html.slider_ends("hold the CoM", "hold the posture"))

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
            with self._place:
                self._gains = TuningPanel(self._gui, self._post, self._tell, truth)
        self._gains.follow(truth)
        self._changes.follow(truth)

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
