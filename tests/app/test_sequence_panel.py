"""Sequences of pushes: added, changed, taken from a run, played, cleared."""

from __future__ import annotations

import pytest

from momentum_lab.app.push_panel import PushPanel
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.sequence_panel import SequencePanel
from momentum_lab.events import ApplyPushes
from momentum_lab.physics.push import Push
from momentum_lab.recording import Layout
from tests.app.fakes import FakeGui


class Desk:
    def __init__(self, robot) -> None:
        self.gui, self.posted, self.told = FakeGui(), [], []
        self.of_run: tuple[Push, ...] = ()
        push = PushPanel(self.gui, self.posted.append, self.told.append, lambda: None)
        push.set_robot(LoadedRobot(robot, (), Layout.of(robot)))
        self.panel = SequencePanel(self.gui, self.posted.append, self.told.append, push, lambda: self.of_run)
        self.push = push

    def do(self, label: str, value: object = True) -> None:
        self.gui.widgets[label].set_by_person(value)


@pytest.fixture
def desk(g1) -> Desk:
    return Desk(g1)


def test_pushes_are_added_in_time_and_played_together(desk):
    desk.do("Add to sequence")
    assert desk.gui.widgets["starts at (s)"].value == 0.6  # a gap after the first one's end
    desk.do("direction (°)", 90.0)
    desk.do("force (N)", 40.0)
    desk.do("Add to sequence")
    desk.do("Play the sequence")
    pushes = (Push(force=80.0, start=0.0), Push(force=40.0, start=0.6, direction_deg=90.0))
    assert desk.posted == [ApplyPushes(pushes)]


def test_a_push_goes_back_to_the_sliders_to_be_changed(desk):
    desk.do("force (N)", 33.0)
    desk.do("starts at (s)", 1.0)
    desk.do("Add to sequence")
    desk.do("force (N)", 44.0)
    desk.do("starts at (s)", 0.25)
    desk.do("Add to sequence")
    assert [push.start for push in desk.panel.sequence] == [0.25, 1.0]
    desk.do("1.00 s: 33 N, 100 ms, 0°")
    assert desk.gui.widgets["force (N)"].value == 33.0
    assert desk.gui.widgets["starts at (s)"].value == 1.0
    assert [push.force for push in desk.panel.sequence] == [44.0]


def test_the_pushes_of_a_run_are_taken_in_their_own_time(desk):
    desk.of_run = (Push(force=10.0, start=5.5), Push(force=20.0, start=6.25, body="head", height=1.0))
    desk.do("Take the pushes of this run")
    assert [(push.force, push.start) for push in desk.panel.sequence] == [(10.0, 0.0), (20.0, 0.75)]


def test_a_run_of_more_pushes_than_a_sequence_has_says_which_are_taken(desk):
    desk.of_run = tuple(Push(force=10.0, start=0.1 * i, duration=0.1) for i in range(137))
    desk.do("Take the pushes of this run")
    assert len(desk.panel.sequence) == 50
    (told,) = desk.told
    assert "first 50 of the 137 pushes" in told


def test_an_empty_sequence_says_what_to_do(desk):
    desk.do("Play the sequence")
    desk.do("Take the pushes of this run")
    assert desk.posted == []
    assert "add the push above" in desk.told[0]
    assert "has been pushed" in desk.told[1]


def test_clear(desk):
    desk.do("Add to sequence")
    item = desk.gui.widgets["0.00 s: 80 N, 100 ms, 0°"]
    desk.do("Clear the sequence")
    assert item.removed
    assert desk.panel.sequence == ()


def test_no_sequence_is_longer_than_the_inbox_takes(desk):
    for _ in range(51):
        desk.do("Add to sequence")
    assert len(desk.panel.sequence) == 50
    assert "at most 50" in desk.told[0]
