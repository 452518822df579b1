"""The legend has what is drawn, neither more nor less."""

from __future__ import annotations

from momentum_lab.app.foresight_scene import PATHS
from momentum_lab.app.legend import Legend
from momentum_lab.app.marks import PRESETS, START_PRESET, STYLES
from tests.app.fakes import FakeGui

START = PRESETS[START_PRESET]


def names(text: str) -> set[str]:
    return {key for key, style in STYLES.items() if f"<span>{style.label}</span>" in text}


def test_it_follows_the_switches_and_a_push_that_is_tried():
    gui, legend = FakeGui(), Legend()
    legend.add(gui)
    assert names(gui.html[0].content) == START
    legend.show(START, PATHS)
    assert names(gui.html[0].content) == START | {"capture"}
    legend.show(PRESETS["minimal"], ())
    assert names(gui.html[0].content) == PRESETS["minimal"]


def test_a_legend_that_comes_later_says_the_same():
    gui, legend = FakeGui(), Legend()
    legend.show({"com"}, ())
    legend.add(gui)
    assert names(gui.html[0].content) == {"com"}
