"""Undo, redo and what has changed, with a session that does what it is asked for."""

from __future__ import annotations

from dataclasses import fields

import pytest

from momentum_lab.app.changes_panel import ChangesPanel
from momentum_lab.app.chosen import chosen_in
from momentum_lab.app.playback import Playback
from momentum_lab.app.wire import Truth
from momentum_lab.choices import Choices
from momentum_lab.control.presets import preset_named
from momentum_lab.events import (
    Event,
    LoadScenario,
    Reset,
    RunAgain,
    SelectController,
    SelectPlanner,
    SetAngularGoal,
    SetDirections,
    SetGain,
    SetGains,
    SetGroundSense,
    SetMismatch,
    SetMotion,
    SetPriority,
)
from momentum_lab.scenario import Scenario
from tests.app.fakes import FakeGui


class Desk:
    """A panel and a session; every frame comes a while after the one before."""

    def __init__(self) -> None:
        self.now = 100.0
        self.gui, self.told = FakeGui(), []
        self.playback = Playback(Scenario("stand", robot="g1", priority=0.25))
        self.panel = ChangesPanel(
            self.gui, self.playback.take, self.told.append, self.truth, lambda: self.now
        )

    @property
    def truth(self) -> Truth:
        return self.playback.truth(1.0)

    def do(self, event: Event) -> None:
        self.playback.take(event)
        self.look()

    def press(self, name: str) -> None:
        self.gui.widgets["change"].set_by_person(name)
        self.look()

    def look(self) -> None:
        self.now += 2.0
        self.playback.tick(2)
        self.panel.follow(self.truth)

    @property
    def said(self) -> str:
        return self.gui.html[0].content


@pytest.fixture
def desk() -> Desk:
    return Desk()


STIFF = SetGains(preset_named("stiff", "computed-torque").gains)
# One change of every kind; what it says.
CHANGES: list[tuple[Event, str]] = [
    (SetPriority(0.75), "priority: 0.25 → 0.75"),
    (SetGain("friction", 0.3), "friction: 0.6 → 0.3"),
    (STIFF, "linear damping: 8 → 12 1/s"),
    (SelectController("whole-body-qp"), "controller: computed-torque → whole-body-qp"),
    (SelectPlanner("cop-to-com"), "planner: momentum → cop-to-com"),
    (SetDirections("linear+kz"), "directions: all → linear+kz"),
    (SetMotion("kick"), "motion: stand still → kick"),
    (SetAngularGoal("reference"), "angular goal: zero → reference"),
    (SetGroundSense("felt"), "how the ground moves: told → felt"),
    (SetMismatch("mass_error", 0.1), "model: mass error: 0 → 0.1"),
]


@pytest.mark.parametrize(("event", "words"), CHANGES, ids=[type(event).__name__ for event, _ in CHANGES])
def test_every_choice_is_told_undone_and_done_again(desk, event, words):
    first = chosen_in(desk.truth)
    assert "as the scenario has it" in desk.said
    desk.do(event)
    changed = chosen_in(desk.truth)
    assert words in desk.said
    desk.press("Undo")
    assert chosen_in(desk.truth) == first
    assert "as the scenario has it" in desk.said
    desk.press("Redo")
    assert chosen_in(desk.truth) == changed
    assert words in desk.said


def test_every_kind_of_choice_is_among_those_tests():
    touched: set[str] = set()
    for event, _ in CHANGES:
        desk = Desk()
        first = chosen_in(desk.truth)
        desk.do(event)
        now = chosen_in(desk.truth)
        touched |= {
            field.name for field in fields(Choices) if getattr(first, field.name) != getattr(now, field.name)
        }
    assert touched == {field.name for field in fields(Choices)}


def test_all_the_way_back_and_forth(desk):
    states = [chosen_in(desk.truth)]
    for event, _ in CHANGES:
        desk.do(event)
        states.append(chosen_in(desk.truth))
    for state in states[-2::-1]:
        desk.press("Undo")
        assert chosen_in(desk.truth) == state
    desk.press("Undo")
    assert desk.told == ["There is nothing to undo."]
    for state in states[1:]:
        desk.press("Redo")
        assert chosen_in(desk.truth) == state
    desk.press("Redo")
    assert desk.told[1:] == ["There is nothing to redo."]


def test_another_controllers_gains_are_told_against_their_defaults(desk):
    desk.do(SelectController("slack-qp"))
    assert "com damping" not in desk.said
    desk.do(SetGain("com_damping", 9.0))
    assert "com damping: 8 → 9 1/s" in desk.said


def test_a_run_again_and_standing_up_leave_the_list_as_it_is(desk):
    desk.do(SetPriority(1.0))
    for event in (Reset(), RunAgain()):
        desk.do(event)
        assert "priority: 0.25 → 1" in desk.said
    desk.press("Undo")
    assert desk.truth.priority == 0.25


def test_another_scenario_begins_another_list(desk):
    desk.do(SetPriority(1.0))
    desk.do(LoadScenario("push-forward"))
    assert "as the scenario has it" in desk.said
    desk.press("Undo")
    assert desk.told == ["There is nothing to undo."]
