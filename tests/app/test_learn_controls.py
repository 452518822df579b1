"""What a learner may try: the controls a lesson names, the run's push in them, the same events as a hand's."""

from __future__ import annotations

import pytest

from momentum_lab.app.learn_controls import TryOut
from momentum_lab.app.playback import Playback
from momentum_lab.app.robots import RobotShelf
from momentum_lab.events import (
    ApplyPush,
    Reset,
    SelectController,
    SelectRobot,
    SetAngularGoal,
    SetDirections,
    SetGain,
    SetPriority,
)
from momentum_lab.lesson.parts import CONTROLS
from momentum_lab.scenario import Scenario, changed, load_scenario
from tests.app.fakes import FakeGui

SHELF = RobotShelf()  # meshes take a second to load


class Desk:
    def __init__(self, *names: str, scenario: str = "fig7") -> None:
        self.gui, self.posted = FakeGui(), []
        robot = SHELF.get("g1")
        truth = Playback(Scenario("stand", robot="g1"), robot.model).truth(1.0)
        run = changed(load_scenario(scenario), robot="g1")
        self.push = run.pushes[0].sized_for(robot.model.mass) if run.pushes else None
        self.try_out = TryOut(self.gui, self.posted.append, names, run, robot, truth)


def test_only_the_controls_that_are_named_are_there() -> None:
    desk = Desk("priority")
    assert set(desk.gui.widgets) == {"priority", "Start again  (R)"}
    assert not desk.try_out.pushes


def test_push_starts_as_the_lessons_and_goes_where_the_sliders_say() -> None:
    desk = Desk("push", "push direction")
    desk.try_out.push()
    (event,) = desk.posted
    assert isinstance(event, ApplyPush)
    assert event.push.force == pytest.approx(desk.push.force, abs=0.5)
    assert event.push.duration == desk.push.duration
    desk.gui.widgets["force (N)"].value = 33.0
    desk.gui.widgets["direction (°)"].value = 90.0
    desk.gui.widgets["Push it  (P)"].set_by_person(True)
    assert (desk.posted[-1].push.force, desk.posted[-1].push.direction_deg) == (33.0, 90.0)


@pytest.mark.parametrize(
    ("name", "label", "value", "event"),
    [
        ("priority", "priority", 0.5, SetPriority(0.5)),
        ("robot", "robot", "talos", SelectRobot("talos")),
        ("controller", "controller", "slack-qp", SelectController("slack-qp")),
        ("momenta", "momenta held", "linear only", SetDirections("linear")),
        ("angular goal", "angular goal", "reference", SetAngularGoal("reference")),
        ("linear_damping", "linear damping (1/s)", 3.0, SetGain("linear_damping", 3.0)),
    ],
)
def test_every_control_asks_for_what_a_hand_asks_for(
    name: str, label: str, value: object, event: object
) -> None:
    desk = Desk(name)
    desk.gui.widgets[label].set_by_person(value)
    desk.gui.widgets["Start again  (R)"].set_by_person(True)
    assert desk.posted == [event, Reset()]


def test_every_control_that_a_lesson_may_name_is_known() -> None:
    assert len(Desk(*CONTROLS).gui.widgets) == len(CONTROLS) + 2
