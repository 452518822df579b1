"""The push tab: the push it describes, its size, and what it does with nonsense."""

from __future__ import annotations

import math
import re

import pytest

from momentum_lab.app.push_panel import PushPanel
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.events import ApplyPush
from momentum_lab.physics.push import Push
from momentum_lab.recording import Layout
from tests.app.fakes import FakeGui


class Desk:
    def __init__(self, robot) -> None:
        self.gui = FakeGui()
        self.posted, self.told, self.redrawn = [], [], []
        self.panel = PushPanel(
            self.gui, self.posted.append, self.told.append, lambda: self.redrawn.append(True)
        )
        self.panel.set_robot(LoadedRobot(robot, (), Layout.of(robot)))

    def set(self, label: str, value: object) -> None:
        self.gui.widgets[label].set_by_person(value)

    @property
    def size(self) -> str:
        return self.line.strip()

    @property
    def line(self) -> str:
        return re.sub("<[^>]*>", "", self.gui.html[1].content)


@pytest.fixture
def desk(talos) -> Desk:
    return Desk(talos)


def test_the_first_push_is_the_chapters(desk):
    desk.gui.widgets["Push  (P)"].set_by_person(True)
    assert desk.posted == [ApplyPush(Push(force=217.0, duration=0.1))]


def test_small_robots_get_small_pushes(g1):
    desk = Desk(g1)
    assert desk.panel.push().force == 80.0
    assert desk.gui.widgets["force (N)"].max < 300.0


def test_everything_can_be_chosen(desk):
    desk.set("force (N)", 100.0)
    desk.set("duration (ms)", 250.0)
    desk.set("direction (°)", -90.0)
    desk.set("body", "left_hand")
    desk.set("through the CoM", False)
    desk.set("height (m)", 1.3)
    desk.set("shape", "half-sine")
    assert desk.panel.push() == Push(
        force=100.0, duration=0.25, direction_deg=-90.0, height=1.3, body="left_hand", shape="half-sine"
    )


@pytest.mark.parametrize("shape", ["triangle", "", 3, None, ["rectangle"]])
def test_a_shape_that_no_widget_offers_is_told_and_no_push(desk, shape):
    desk.gui.widgets["shape"].value = shape
    desk.panel.refresh()
    assert "shape: got" in desk.size
    for act in (desk.panel.apply, desk.panel.ask):
        act()
        assert "allowed: one of rectangle, half-sine" in desk.told.pop()
    assert desk.posted == []


def test_bodies_are_those_of_the_robot(desk, talos):
    options = desk.gui.widgets["body"].options
    assert set(options) == set(talos.spec.push_bodies)
    assert options[0] == "trunk"


def test_the_height_is_free_when_the_push_does_not_go_through_the_com(desk):
    assert desk.gui.widgets["height (m)"].disabled
    desk.set("through the CoM", False)
    assert not desk.gui.widgets["height (m)"].disabled


@pytest.mark.parametrize(("name", "degrees"), [("forward", 0), ("left", 90), ("back", 180), ("right", -90)])
def test_direction_buttons(desk, name, degrees):
    desk.set(" ", name)
    assert desk.gui.widgets["direction (°)"].value == degrees
    assert desk.panel.push().direction_deg == degrees


def test_repeat_gives_the_last_push_again(desk):
    desk.panel.apply()
    desk.set("force (N)", 10.0)
    desk.gui.widgets["Repeat the last push"].set_by_person(True)
    assert desk.posted[1] == desk.posted[0]


def test_size_against_the_pendulum(desk, standing):
    # J = m omega d * omega T / (1 - exp(-omega T)), d from the CoM to the toes.
    desk.panel.see(standing)
    desk.panel.refresh()
    x, _, z = standing["com"]
    omega = math.sqrt(9.81 / z)
    bound = 90.272 * omega * (0.091 - x) * (omega * 0.1) / (1.0 - math.exp(-omega * 0.1))
    assert desk.size.startswith(f"21.7 N s = {21.7 / bound:.2f} of the pendulum bound ({bound:.1f} N s")


def test_the_size_is_told_for_the_robot_as_it_last_stood(desk, standing, saturated):
    desk.panel.see(standing)
    desk.panel.refresh()
    before = desk.size
    desk.panel.see(saturated)
    desk.panel.refresh()
    assert desk.size == before


def test_changing_a_widget_asks_for_a_picture(desk):
    desk.set("force (N)", 33.0)
    assert desk.redrawn


@pytest.mark.parametrize("label", ["force (N)", "duration (ms)", "direction (°)"])
@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_what_is_no_number_is_told_and_not_posted(desk, label, value):
    desk.set(label, value)
    desk.panel.apply()
    desk.panel.refresh()
    assert desk.posted == []
    assert "allowed: a finite number" in desk.told[0]
    assert "allowed: a finite number" in desk.size


def test_the_line_of_the_size_keeps_its_width(desk, standing):
    desk.panel.see(standing)
    widths = set()
    for force in (30.0, 99.0, 100.0, 217.0, 650.0):  # 3.0 to 65.0 N s
        desk.set("force (N)", force)
        desk.panel.refresh()
        widths.add(len(desk.line))
    assert len(widths) == 1
