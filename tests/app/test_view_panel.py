"""The view tab: presets, switches and cameras."""

from __future__ import annotations

import pytest

from momentum_lab.app.camera import VIEWS
from momentum_lab.app.marks import PRESETS, STYLES
from momentum_lab.app.view_panel import ViewPanel, ViewSettings
from tests.app.fakes import FakeGui


class Desk:
    def __init__(self) -> None:
        self.gui, self.settings = FakeGui(), ViewSettings()
        self.looks, self.redrawn = [], []
        ViewPanel(self.gui, self.settings, self.looks.append, lambda: self.redrawn.append(True))
        self.settings.changed = False

    def set(self, label: str, value: object) -> None:
        self.gui.widgets[label].set_by_person(value)


@pytest.fixture
def desk() -> Desk:
    return Desk()


@pytest.mark.parametrize("preset", PRESETS)
def test_presets_move_the_switches_too(desk, preset):
    desk.set("marks", preset)
    assert desk.settings.shown == PRESETS[preset]
    for key, style in STYLES.items():
        assert desk.gui.widgets[style.label].value == (key in PRESETS[preset])
    assert desk.settings.changed
    assert desk.redrawn


def test_every_mark_has_a_switch(desk):
    desk.set("marks", "everything")
    for key, style in STYLES.items():
        desk.set(style.label, False)
        assert key not in desk.settings.shown
    assert desk.settings.shown == set()
    desk.set("CMP", True)
    assert desk.settings.shown == {"cmp"}


def test_labels_arrows_and_body(desk):
    desk.set("labels", False)
    desk.set("see-through robot", False)
    desk.set("force arrows", "2 ×")
    assert (desk.settings.labelled, desk.settings.see_through, desk.settings.arrow_scale) == (set(), False, 2)
    desk.set("labels", True)
    assert desk.settings.labelled == set(STYLES)


def test_cameras(desk):
    for name in VIEWS:
        desk.set("camera", name)
    assert desk.looks == list(VIEWS)


def test_names_that_do_not_exist_change_nothing(desk):
    desk.set("marks", "nonsense")
    desk.set("force arrows", "99 ×")
    assert desk.settings.shown == PRESETS["teaching"]
    assert desk.settings.arrow_scale == 1.0


def test_the_legend_explains_every_mark(desk):
    assert all(style.label in desk.gui.html[-1].content for style in STYLES.values())
