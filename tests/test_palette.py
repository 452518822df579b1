"""A quantity has one colour, wherever it is drawn: marks in the scene, curves on the page, pictures of reports."""

from __future__ import annotations

import re

import pytest
from matplotlib.colors import to_hex

from momentum_lab import palette
from momentum_lab.app.marks import STYLES
from momentum_lab.app.plots import Plots
from momentum_lab.experiments.run_plots import on_the_ground, over_time
from momentum_lab.finished import FinishedRun
from momentum_lab.replay import replayed
from momentum_lab.run_file import Run
from momentum_lab.scenario import Scenario
from tests.app.fakes import FakeGui

POINTS = {STYLES[key].label: STYLES[key].css for key in ("com", "cop", "cmp", "capture")}
RATES = {"desired", "admissible", "measured"}


@pytest.fixture(scope="module")
def run() -> FinishedRun:
    return FinishedRun.of(replayed(Run(Scenario("stand", robot="g1"), (), ticks=20))[0])


def in_pictures(run: FinishedRun) -> dict[str, set[str]]:
    """Colours by label, of all lines in the pictures of a run."""
    found: dict[str, set[str]] = {}
    for picture in (over_time(run), on_the_ground(run)):
        for axes in picture.axes:
            for line in axes.get_lines():
                found.setdefault(str(line.get_label()), set()).add(to_hex(line.get_color()))
    return found


def on_the_page() -> dict[str, set[str]]:
    """Colours by label, of all curves in the plots of the page."""
    gui = FakeGui()
    Plots(gui)
    found: dict[str, set[str]] = {}
    for plot in gui.widgets.values():
        for line in plot.series[1:-1]:
            rgb = re.fullmatch(r"rgba\((\d+),(\d+),(\d+),[\d.]+\)", line["stroke"])
            found.setdefault(line["label"], set()).add(palette.css(tuple(map(int, rgb.groups()))))
    return found


def test_points_have_the_colours_of_their_marks_in_every_picture(run):
    pictures, page = in_pictures(run), on_the_page()
    for label, color in POINTS.items():
        assert pictures[label] == page[label] == {color}, label


def test_rates_and_momenta_are_drawn_alike_on_the_page_and_in_pictures(run):
    pictures, page = in_pictures(run), on_the_page()
    assert {label: pictures[label] for label in RATES} == {label: page[label] for label in RATES}
    for name in ("linear, along the push", "angular, about the axis across"):
        (drawn,) = (colors for label, colors in pictures.items() if label.startswith(name))
        assert drawn == page[name]


def test_every_momentum_in_a_picture_has_its_unit(run):
    momenta = [label for label in in_pictures(run) if label.startswith(("linear,", "angular,"))]
    assert [label.rpartition("(")[2] for label in momenta] == ["N s)", "kg m²/s)"]
