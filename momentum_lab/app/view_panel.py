"""The view tab: which marks are drawn, how, and from where."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import viser

from momentum_lab.app import html
from momentum_lab.app.camera import VIEWS
from momentum_lab.app.marks import ALL_LABELS, PRESETS, START_PRESET, STYLES, Theme

_TIMES = {"½ ×": 0.5, "1 ×": 1.0, "2 ×": 2.0}


@dataclass
class ViewSettings:
    """What a person has chosen to see; belongs to one browser tab and never to a session.

    Attributes:
        shown: keys of the marks that are switched on.
        labelled: keys of the marks that may have a label in the scene.
        see_through: whether the robot is transparent.
        arrow_scale: length of force arrows against their natural length.
        theme: whether the page is light or dark.
        changed: whether the next drawing has to look at all of this again.
    """

    shown: set[str] = field(default_factory=lambda: set(PRESETS[START_PRESET]))
    labelled: frozenset[str] = ALL_LABELS
    see_through: bool = True
    arrow_scale: float = 1.0
    theme: Theme = "light"
    changed: bool = True


class ViewPanel:
    """The widgets of the view tab.

    Args:
        gui: where they go.
        settings: what they change.
        look: turns the camera to a named view.
        redraw: asks for a new picture.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        settings: ViewSettings,
        look: Callable[[str], None],
        redraw: Callable[[], None],
    ) -> None:
        self._settings, self._redraw = settings, redraw
        cameras = gui.add_button_group("camera", tuple(VIEWS))
        cameras.on_click(lambda event: look(event.target.value))
        presets = gui.add_button_group("marks", tuple(PRESETS))
        presets.on_click(lambda event: self._preset(event.target.value))
        lengths = gui.add_button_group("force arrows", tuple(_TIMES))
        lengths.on_click(lambda event: self._scale(event.target.value))
        labels = gui.add_checkbox("labels", bool(settings.labelled))
        labels.on_update(lambda event: self._label(event.target.value))
        see_through = gui.add_checkbox(
            "see-through robot", settings.see_through, hint="Shows the marks inside the body."
        )
        see_through.on_update(lambda event: self._set("see_through", event.target.value))
        with gui.add_folder("Each mark", expand_by_default=False):
            self._switches: dict[str, Any] = {
                key: gui.add_checkbox(style.label, key in settings.shown, hint=style.help)
                for key, style in STYLES.items()
            }
        for key, switch in self._switches.items():
            switch.on_update(self._switched(key))
        gui.add_html(html.legend(STYLES, explained=True))

    def _preset(self, name: str) -> None:
        if name not in PRESETS:
            return
        for key, switch in self._switches.items():
            switch.value = key in PRESETS[name]
        self._set("shown", set(PRESETS[name]))

    def _switched(self, key: str) -> Callable[[Any], None]:
        """What happens when the switch of one mark moves."""

        def switch(event: Any) -> None:
            if event.client is None:
                return  # it was a preset, not a person
            shown = self._settings.shown
            self._set("shown", shown | {key} if event.target.value else shown - {key})

        return switch

    def _label(self, on: bool) -> None:
        self._set("labelled", ALL_LABELS if on else frozenset[str]())

    def _scale(self, name: str) -> None:
        self._set("arrow_scale", _TIMES.get(name, 1.0))

    def _set(self, name: str, value: object) -> None:
        setattr(self._settings, name, value)
        self._settings.changed = True
        self._redraw()
