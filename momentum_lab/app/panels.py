"""All panels of one browser tab: status and tabs on the right, plots on the left, keys for everything."""

from __future__ import annotations

from collections.abc import Callable

import viser

from momentum_lab.app import html, share_html
from momentum_lab.app.control_panel import Choices, ControlPanel
from momentum_lab.app.ground_panel import GroundPanel
from momentum_lab.app.keys import add_keys
from momentum_lab.app.marks import ALL_LABELS, FEW_LABELS, PRESETS, START_PRESET, STYLES
from momentum_lab.app.plots import Plots
from momentum_lab.app.push_panel import PushPanel
from momentum_lab.app.runs_panel import RunsPanel
from momentum_lab.app.sequence_panel import SequencePanel
from momentum_lab.app.share_panel import SharePanel, Sharing
from momentum_lab.app.status_bar import StatusBar
from momentum_lab.app.tabs import Tabs
from momentum_lab.app.view_panel import ViewPanel, ViewSettings
from momentum_lab.app.widgets import Post
from momentum_lab.app.wire import Truth

_RIGHT, _LEFT = 350.0, 350.0
# Pages narrower than this, width over height, have no room for plots beside the picture or for many labels.
_ROOMY = 1.1


class Panels:
    """Every widget of one browser tab.

    Args:
        client: the browser tab.
        post: where events go.
        tell: shows a person what was wrong.
        look: turns the camera to a named view.
        redraw: asks for a new picture.
        choices: robots and scenarios to choose from.
        truth: what is the case at the start.
        sharing: what the share tab can ask for.
        feet: names of the robot's feet.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        post: Post,
        tell: Callable[[str], None],
        look: Callable[[str], None],
        redraw: Callable[[], None],
        choices: Choices,
        truth: Truth,
        sharing: Sharing,
        feet: tuple[str, ...],
    ) -> None:
        gui = client.gui
        gui.configure_theme(show_share_button=False, show_logo=False, brand_color=(0, 114, 178))
        gui.set_panel_label("Momentum lab")
        gui.main_panel.dock_right()
        gui.main_panel.set_width(_RIGHT)
        roomy = client.camera.image_width >= _ROOMY * client.camera.image_height
        self.settings = ViewSettings(labelled=ALL_LABELS if roomy else FEW_LABELS)
        self.status = StatusBar(gui, post)
        gui.add_html(share_html.HIDDEN_NEXT)
        address = gui.add_text("address", "")
        group = gui.add_tab_group()  # five of them fit into one line without icons
        with group.add_tab("Push"):
            self.push = PushPanel(gui, post, tell, redraw)
            SequencePanel(gui, post, tell, self.push, lambda: sharing.take(False).pushes)
            self.ground = GroundPanel(gui, post, tell, feet)
        with group.add_tab("Control"):
            self.control = ControlPanel(gui, post, tell, choices, truth)
        with group.add_tab("View"):
            ViewPanel(gui, self.settings, look, redraw)
        with group.add_tab("Runs"):
            self.runs = RunsPanel(gui, post, redraw, truth)
        with group.add_tab("Share"):
            self.share = SharePanel(gui, sharing, address)
        gui.add_html(share_html.READ_ADDRESS)  # last: by now somebody listens to the address
        plots = gui.add_panel()
        with plots.add_tab("Plots", viser.Icon.CHART_LINE):
            gui.add_html(
                html.legend([key for key in STYLES if key in PRESETS[START_PRESET]], explained=False)
            )
            self.plots = Plots(gui)
        plots.dock_left()
        plots.set_width(_LEFT)
        if not roomy:
            plots.minimize()
        add_keys(client, post, self.push, self.status, Tabs(client, group), self.runs)
