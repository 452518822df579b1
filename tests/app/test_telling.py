"""Which of two robots does what, in one line."""

from __future__ import annotations

import re

import msgspec
import pytest

from momentum_lab.app.playback import Playback
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.telling import told
from momentum_lab.app.wire import Fallen, Frame, Other
from momentum_lab.beside import Beside
from momentum_lab.events import ApplyPush
from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario
from momentum_lab.status import SOME_LIMIT, Status


class Desk:
    def __init__(self, beside: Beside | None) -> None:
        self.playback = Playback(Scenario("stand", robot="g1", beside=beside))
        session = self.playback.session
        self.loaded = LoadedRobot(session.robot, (), session.recording.layout)

    def told(
        self, first: dict | None = None, second: dict | None = None, names: tuple[str, str] | None = None
    ) -> Status:
        playback = self.playback
        truth = msgspec.structs.replace(playback.truth(1.0), **(first or {}))
        other_truth, shown = playback.beside_truth(truth), playback.beside_shown
        row, other = playback.shown.row.tobytes(), None
        if other_truth is not None and shown is not None:
            other = Other(
                msgspec.structs.replace(other_truth, **(second or {})), shown.row.tobytes(), b"", names
            )
        return told(Frame(truth, row, b"", other=other), playback.shown, self.loaded)


@pytest.fixture
def desk() -> Desk:
    return Desk(Beside(priority=1.0))


def test_one_robot_has_no_name():
    assert Desk(None).told() == Status("standing", "standing", "green")


def test_two_that_do_the_same_are_told_together(desk):
    assert desk.told() == Status("standing", "both: standing", "green")


FELL = {"fall": Fallen(1.324, "the CoM sank to 0.53 m")}


def test_the_one_that_fell_is_named_as_over_its_head(desk):
    assert desk.told(second=FELL) == Status(
        "fallen", "priority 0: standing; priority 1: fell at 1.32 s", "vermillion"
    )
    assert desk.told(first={**FELL, "behind": 0.0}, second={"fall": None}).words == (
        "priority 0: fell at 1.32 s; priority 1: standing"
    )


def test_robots_of_a_lesson_have_the_names_that_it_gives_them(desk):
    words = desk.told(second=FELL, names=("bend", "upright")).words
    assert words == "bend: standing; upright: fell at 1.32 s"


def test_falls_at_different_times_are_told_apart(desk):
    later = {"fall": Fallen(2.0, "x")}
    assert desk.told(FELL, later).words == "priority 0: fell at 1.32 s; priority 1: fell at 2.00 s"


def test_each_gives_way_in_its_own_words(desk):
    desk.playback.take(ApplyPush(Push(force=128.0, duration=0.1)))
    desk.playback.tick(120)
    status = desk.told()
    assert status.kind == "border"
    assert re.fullmatch(
        r"priority 0: angular goal short by \d+ N m; priority 1: linear goal short by \d+ N", status.words
    )


def test_a_solver_without_an_answer_and_an_end_are_short(desk):
    status = desk.told(second={"stopped": "the state is not finite after 2.000 s"})
    assert status == Status("stopped", "priority 0: standing; priority 1: stopped", "black")


@pytest.mark.parametrize("controller", ["computed-torque", "whole-body-qp"])
def test_slippery_ground_is_named_where_it_stops_a_force(controller):
    gains = {"friction": 0.05, "linear_damping": 20.0}
    playback = Playback(Scenario("stand", robot="g1", controller=controller, gains=gains))
    playback.take(ApplyPush(Push(force=80.0, duration=0.1)))
    loaded = LoadedRobot(playback.session.robot, (), playback.session.recording.layout)
    said = set()
    for _ in range(20):
        playback.tick(5)
        frame = Frame(playback.truth(1.0), playback.shown.row.tobytes(), b"")
        said.add(told(frame, playback.shown, loaded).words.partition(": ")[0])
    assert "friction limit (left foot)" in said
    assert not said & {SOME_LIMIT, "CoP on the toes"}
