"""The widgets of the ground: the events they ask for, and what they show."""

from __future__ import annotations

import math
from types import SimpleNamespace

import pytest

from momentum_lab.app.ground_panel import GroundPanel
from momentum_lab.events import MoveGround, SetFriction, SetGroundSense, StopGround
from momentum_lab.physics.plate import PlateMotion
from tests.app.fakes import FakeGui


class Desk:
    def __init__(self) -> None:
        self.gui, self.posted, self.told = FakeGui(), [], []
        self.panel = GroundPanel(self.gui, self.posted.append, self.told.append, ("left", "right"))

    def set(self, label: str, value: object) -> None:
        self.gui.widgets[label].set_by_person(value)


@pytest.fixture
def desk() -> Desk:
    return Desk()


def test_centimetres_along_and_degrees_about(desk):
    desk.set("Move the ground", True)
    desk.set("under", "right")
    desk.set("motion", "pitch (front down)")
    desk.set("how often", "once")
    desk.set("how far (cm, °)", -8.0)
    desk.set("period (s)", 1.5)
    desk.set("Move the ground", True)
    desk.set("Let it come to rest", True)
    assert desk.posted == [
        MoveGround(PlateMotion("x", 0.05, "sine", 2.0)),
        MoveGround(PlateMotion("pitch", -8.0, "step", 1.5), "right"),
        StopGround(),
    ]


def test_friction_is_that_of_the_chosen_foot(desk):
    desk.set("under", "left")
    desk.set("friction", 0.2)
    desk.set("the robot", "feels it through its soles")
    assert desk.posted == [SetFriction(0.2, "left"), SetGroundSense("felt")]


def test_it_shows_what_is_the_case(desk):
    desk.set("under", "right")
    desk.panel.follow(SimpleNamespace(friction=(0.7, 0.3), ground_sense="felt"))
    assert desk.gui.widgets["friction"].value == 0.3
    assert desk.gui.widgets["the robot"].value == "feels it through its soles"


def test_nonsense_is_answered_in_words(desk):
    desk.set("period (s)", math.nan)
    desk.set("Move the ground", True)
    assert desk.posted == []
    assert "period" in desk.told[0]


def test_another_robot_has_other_feet(desk):
    desk.panel.set_feet(("l_sole", "r_sole"))
    assert desk.gui.widgets["under"].options == ("both", "l_sole", "r_sole")
