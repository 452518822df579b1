"""All panels of one browser tab: tabs right, plots and lessons left, status and time below, keys for everything."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from pathlib import Path

import viser

from momentum_lab.app import access_html, html, keyboard_html, look_html, share_html, typed_html
from momentum_lab.app.appearance import Appearance, dress
from momentum_lab.app.control_panel import Choices, ControlPanel
from momentum_lab.app.demo_panel import DemoPanel
from momentum_lab.app.demo_stage import DemoStage
from momentum_lab.app.ground_panel import GroundPanel
from momentum_lab.app.hand import Hand
from momentum_lab.app.keys import add_keys
from momentum_lab.app.learn_panel import LearnPanel
from momentum_lab.app.learn_style import ON_A_PHONE
from momentum_lab.app.lesson_wire import LessonEvent
from momentum_lab.app.library import Library
from momentum_lab.app.marks import ALL_LABELS, FEW_LABELS, PRESETS, START_PRESET, STYLES
from momentum_lab.app.mismatch_panel import MismatchPanel
from momentum_lab.app.page_plan import LEFT, RIGHT, PagePlan
from momentum_lab.app.plots import Plots
from momentum_lab.app.pulling import Pulling
from momentum_lab.app.push_panel import PushPanel
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.runs_panel import RunsPanel
from momentum_lab.app.sequence_panel import SequencePanel
from momentum_lab.app.share_panel import SharePanel, Sharing
from momentum_lab.app.status_bar import StatusBar
from momentum_lab.app.tabs import Tabs
from momentum_lab.app.time_bar import time_bar
from momentum_lab.app.view_panel import ViewPanel, ViewSettings
from momentum_lab.app.widgets import Post
from momentum_lab.app.wire import Truth

_PLOTS, _LEARN = ("Plots", viser.Icon.CHART_LINE), ("Learn", viser.Icon.SCHOOL)


class Panels:
    """Every widget of one browser tab.

    Args:
        client: the browser tab.
        plan: what its page has room for.
        post: where events go.
        tell: shows a person what was wrong.
        look: turns the camera to a named view.
        redraw: asks for a new picture.
        choices: robots and scenarios to choose from.
        truth: what is the case at the start.
        sharing: what the share tab can ask for.
        feet: names of the robot's feet.
        ask: where a lesson's events go.
        library: the lessons.
        lesson: the script of the lesson to begin with.
        demo: what plays while nobody touches the tab.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        plan: PagePlan,
        post: Post,
        tell: Callable[[str], None],
        look: Callable[[str], None],
        redraw: Callable[[], None],
        choices: Choices,
        truth: Truth,
        sharing: Sharing,
        feet: tuple[str, ...],
        ask: Callable[[LessonEvent], None],
        library: Library,
        lesson: Path | None,
        demo: DemoStage,
    ) -> None:
        gui = client.gui
        dress(gui, "light")
        gui.set_panel_label("Momentum lab")
        gui.main_panel.dock_right()
        gui.main_panel.set_width(RIGHT)
        self.settings = ViewSettings(labelled=ALL_LABELS if plan.roomy else FEW_LABELS)
        appearance = Appearance(client, self.settings, redraw)
        with time_bar(client, plan.picture) if plan.bar else contextlib.nullcontext():
            self.status = StatusBar(gui, post)
            if plan.bar:
                demo.add_caption()
        gui.add_html(share_html.HIDDEN_NEXT)
        address = gui.add_text("address", "")
        group = gui.add_tab_group()  # five of them fit into one line without icons
        with group.add_tab("Push"):
            self.push = PushPanel(gui, post, tell, redraw)
            SequencePanel(gui, post, tell, self.push, lambda: sharing.take_run().pushes)
            pulling = Pulling(client, self.push, self.settings, post, lambda: sharing.take_run().pushes)
            self.hand = Hand(self.push.hand, pulling, tell)
            self.ground = GroundPanel(gui, post, tell, feet)
        with group.add_tab("Control"):
            self.control = ControlPanel(gui, post, tell, choices, truth)
            self.mismatch = MismatchPanel(gui, post, truth)
        with group.add_tab("View"):
            ViewPanel(gui, self.settings, look, redraw)
            appearance.add_choice(gui)
            DemoPanel(gui, demo.demo)
        with group.add_tab("Runs"):
            self.runs = RunsPanel(gui, post, redraw, truth)
        with group.add_tab("Share"):
            self.share = SharePanel(gui, sharing, address)
        demo.furnish()
        appearance.add_ear(gui)
        gui.add_html(access_html.NAMES + typed_html.TYPED + look_html.STYLE + ON_A_PHONE)
        gui.add_html(keyboard_html.KEYS)
        gui.add_html(share_html.READ_ADDRESS)  # last: by now somebody listens to the address
        self._lesson_plots: tuple[viser.GuiFormHandle, Plots] | None = None
        self._robot: LoadedRobot | None = None
        learn_tab = self._add_left(gui, plan, lesson, demo)
        self._gui, self._group, self._roomy = gui, group, plan.roomy
        self.learn = LearnPanel(client, learn_tab, library, post, ask, tell, look, self._lesson_opened, truth)
        # The list of commands has them in this order: what is used most comes first.
        tabs = Tabs(client, group)
        add_keys(client, post, self._push, self.push, self.status, tabs, self.runs, self.hand, appearance)
        self.learn.start(lesson)
        demo.listen()

    def _add_left(
        self, gui: viser.GuiApi, plan: PagePlan, lesson: Path | None, demo: DemoStage
    ) -> viser.GuiTabHandle:
        """Plots, and the tab where lessons go."""
        left = gui.add_panel()
        # The browser opens the first tab; a phone has no room for plots beside the picture.
        learn_first = lesson is not None or not plan.roomy
        tabs = [
            left.add_tab(label, icon)
            for label, icon in ((_LEARN, _PLOTS) if learn_first else (_PLOTS, _LEARN))
        ]
        learn_tab, plots_tab = tabs if learn_first else tabs[::-1]
        with plots_tab:
            gui.add_html(_legend())
            self.plots = self._usual_plots = Plots(gui)
            demo.add_caption()
        left.dock_left()
        left.set_width(LEFT)
        if not plan.roomy:
            # A phone shows what is folded away as one line.
            (left.minimize if lesson is None else left.expand)()
        return learn_tab

    def begin_plots(self, robot: LoadedRobot) -> None:
        """Start with empty plots for a robot."""
        self._robot = robot
        lesson = () if self._lesson_plots is None else (self._lesson_plots[1],)
        for plots in (self._usual_plots, *lesson):
            plots.begin(robot.model, robot.layout)

    def _lesson_opened(self, on: bool) -> None:
        """While a lesson is open its text has the left side, and plots stand where the tabs were."""
        if self._lesson_plots is None:
            self._lesson_plots = self._add_lesson_plots()
        box, plots = self._lesson_plots
        self.plots = plots if on else self._usual_plots
        self._group.visible, box.visible = not on, on and self._roomy
        self.status.invite(not on)

    def _add_lesson_plots(self) -> tuple[viser.GuiFormHandle, Plots]:
        box = self._gui.add_form(None, visible=False)
        with box:
            self._gui.add_html(_legend())
            plots = Plots(self._gui)
        if self._robot is not None:
            plots.begin(self._robot.model, self._robot.layout)
        return box, plots

    def _push(self) -> None:
        """Push as the lesson says, or as the push tab does."""
        if not self.learn.push():
            self.push.apply()


def _legend() -> str:
    return html.legend([key for key in STYLES if key in PRESETS[START_PRESET]], explained=False)
