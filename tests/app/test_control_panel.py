"""The control tab: sliders from declarations, choices, and what has changed."""

from __future__ import annotations

import re

import msgspec
import numpy as np
import pytest

from momentum_lab.app.control_panel import Choices, ControlPanel
from momentum_lab.app.playback import Playback
from momentum_lab.app.tuning_panel import changed_gains
from momentum_lab.control.computed_torque_gains import ComputedTorqueGains
from momentum_lab.control.controller import SLACKS
from momentum_lab.control.gains import GainInfo, declared_gains
from momentum_lab.events import (
    LoadScenario,
    SelectRobot,
    SetAngularGoal,
    SetDirections,
    SetGain,
    SetGains,
    SetMotion,
    SetPriority,
)
from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session
from tests.app.fakes import FakeGui

DECLARED = declared_gains(ComputedTorqueGains())


class Desk:
    def __init__(self) -> None:
        self.gui, self.posted, self.told = FakeGui(), [], []
        self.truth = Playback(Scenario("stand")).truth(1.0)
        choices = Choices(("talos", "g1"), ("stand", "one-leg"))
        self.panel = ControlPanel(self.gui, self.posted.append, self.told.append, choices, self.truth)
        self.panel.follow(self.truth)

    def slider(self, gain: GainInfo):
        words = gain.name.replace("_", " ")
        return next(w for label, w in self.gui.widgets.items() if label.split(" (")[0] == words)


@pytest.fixture
def desk() -> Desk:
    return Desk()


@pytest.mark.parametrize("gain", DECLARED.values(), ids=lambda gain: gain.name)
def test_every_gain_has_a_slider_with_its_range_and_help(desk, gain):
    slider = desk.slider(gain)
    assert (slider.min, slider.max, slider.value) == (gain.low, gain.high, gain.default)
    assert gain.help in slider.hint
    assert f"Default {gain.default:g}" in slider.hint


def test_a_slider_sets_its_gain(desk):
    desk.slider(DECLARED["linear_damping"]).set_by_person(12.0)
    assert desk.posted == [SetGain("linear_damping", 12.0)]


def test_the_priority_slider_has_words_at_its_ends(desk):
    desk.gui.widgets["priority"].set_by_person(0.25)
    assert desk.posted == [SetPriority(0.25)]
    text = " ".join(handle.content for handle in desk.gui.html)
    assert "hold the CoM" in text
    assert "hold the posture" in text


def test_choices(desk):
    desk.gui.widgets["robot"].set_by_person("g1")
    desk.gui.widgets["scenario"].set_by_person("one-leg")
    desk.gui.widgets["Start the scenario again"].set_by_person(True)
    assert desk.posted == [SelectRobot("g1"), LoadScenario("one-leg"), LoadScenario("stand")]


def test_widgets_follow_the_session(desk):
    gains = {**desk.truth.gains, "friction": 0.3}
    desk.panel.follow(msgspec.structs.replace(desk.truth, priority=0.6, robot="g1", gains=gains))
    assert desk.gui.widgets["priority"].value == 0.6
    assert desk.gui.widgets["robot"].value == "g1"
    assert desk.slider(DECLARED["friction"]).value == 0.3
    assert desk.posted == []


def test_what_changed_is_told_and_can_be_undone(desk):
    gains = {**desk.truth.gains, "friction": 0.3}
    desk.panel.follow(msgspec.structs.replace(desk.truth, gains=gains))
    taken_back = desk.gui.widgets["friction as before"]
    assert (taken_back.visible, taken_back.label) == (True, "friction: 0.6 → 0.3")
    assert "Changed since chapter-like" in desk.gui.html[-1].content
    taken_back.set_by_person(True)
    assert desk.posted.pop() == SetGain("friction", DECLARED["friction"].default)
    desk.gui.widgets["Reset the gains"].set_by_person(True)
    assert desk.posted == [SetGains({"friction": DECLARED["friction"].default})]
    desk.panel.follow(desk.truth)
    assert not taken_back.visible
    assert "defaults" in desk.gui.html[-1].content


def test_changes_have_units():
    values = {name: gain.default for name, gain in DECLARED.items()}
    values["linear_damping"] = 12.0
    default = DECLARED["linear_damping"].default
    assert changed_gains(DECLARED.values(), values) == [f"linear damping: {default:g} → 12 1/s"]


def test_a_motion_and_its_angular_goal_are_chosen(desk):
    motion, goal = desk.gui.widgets["motion"], desk.gui.widgets["angular goal"]
    assert motion.value == "stand still"
    motion.set_by_person("kick")
    goal.set_by_person("reference")
    motion.set_by_person("stand still")
    assert desk.posted == [SetMotion("kick"), SetAngularGoal("reference"), SetMotion("")]


def test_directions_are_ticked_one_by_one_and_follow_the_truth(desk):
    up, turn = desk.gui.widgets["lz: up"], desk.gui.widgets["kx: about forward"]
    assert up.value
    assert turn.value
    turn.set_by_person(False)
    up.set_by_person(False)
    assert desk.posted == [SetDirections("linear+ky+kz"), SetDirections("lx+ly+ky+kz")]
    desk.panel.follow(msgspec.structs.replace(desk.truth, controlled="lx"))
    assert not desk.gui.widgets["ly: left"].value


def test_slacks_are_named_while_there_are_any(desk):
    """Of the controller that has them, in mid-recovery: each with its size and unit; of no other."""
    session = Session(Scenario("s", controller="slack-qp", pushes=(Push(force=217.0, start=0.0),)))
    for _ in range(150):
        session.tick()
    panel = next(handle for handle in desk.gui.html if not handle.visible)
    desk.panel.see(session.recording.latest)
    assert panel.visible
    shown = dict(re.findall(r"<td>([a-z ]+)</td><td[^>]*>([0-9.]+) ", panel.content))
    assert list(shown) == list(SLACKS)
    assert [float(number) for number in shown.values()] == pytest.approx(
        np.abs(session.recording.latest["slack"]), abs=0.005
    )
    assert max(float(number) for number in shown.values()) > 0.1
    desk.panel._next = 0.0
    desk.panel.see(Playback(Scenario("stand")).latest)
    assert not panel.visible
