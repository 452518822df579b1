"""Two runs of a lesson beside each other: both are what was rehearsed, and a hand can go on with both."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.app.classroom import Classroom
from momentum_lab.app.lesson_runs import RunPlayback, difference
from momentum_lab.app.lesson_wire import LeaveLesson, OpenLesson, PlayRun, ShowRun
from momentum_lab.app.playback import Playback
from momentum_lab.beside import Beside
from momentum_lab.events import ApplyPush, Branch, Pause, SetBeside, SetPriority
from momentum_lab.lesson.record import rehearsed
from momentum_lab.physics.push import Push
from momentum_lab.robot.model import RobotModel
from momentum_lab.scenario import Scenario, changed
from tests.test_lesson import written

PAIR = (
    ('"seconds": 2.0})}', '"seconds": 0.4}), "late": lab.Run("stand", {"priority": 0.9, "seconds": 0.55})}'),
    ('("push", "linear_stiffness")', '("push", "priority"), beside="late"'),
    ("time=0.35", "time=0.25"),
)


@pytest.fixture
def own(g1: RobotModel) -> Playback:
    """A person's own session with a second robot in it."""
    playback = Playback(Scenario("stand", robot="g1"), g1)
    playback.take(SetBeside(Beside(priority=0.8)))
    playback.tick(10)
    return playback


@pytest.fixture
def lesson(tmp_path) -> OpenLesson:
    return OpenLesson(str(written(tmp_path, *PAIR)), "g1")


def played(room: Classroom) -> Classroom:
    room.take(PlayRun("push"))
    while room.stage.playing:
        room.stage.tick(20)
    return room


def test_both_are_played_at_once_and_measured(own: Playback, lesson: OpenLesson) -> None:
    """Each to its own end, with the bits that it has when it is played alone."""
    room = Classroom(own)
    room.take(lesson)
    assert room.stage.names == ("push", "late")
    assert not room.stage.playing
    room.take(PlayRun("push"))
    room.stage.tick(200)
    assert room.stage.beside.session.ticks == 201
    assert room.news().seen == ()
    room.stage.tick(250)
    assert room.news().seen == ("push",)
    assert room.stage.playing
    room.stage.tick(500)
    assert room.stage.beside.session.time == pytest.approx(0.55)
    news = room.news()
    assert set(news.seen) == {"push", "late"}
    assert news.record == rehearsed(lesson.file, "g1")


def test_both_are_shown_at_the_same_instant(own: Playback, lesson: OpenLesson) -> None:
    room = Classroom(own)
    room.take(lesson)
    room.take(ShowRun("push", 0.25))
    for sample in (room.stage.shown, room.stage.beside_shown):
        assert sample.number("time") == pytest.approx(0.25)
    first = room.stage.truth(1.0)
    second = room.stage.beside_truth(first)
    assert (first.priority, second.priority) == (0.0, 0.9)
    assert (first.push.force, second.push) == (60.0, None)
    assert second.run == first.run
    room.take(ShowRun("late", 0.4))
    assert room.stage.beside is None
    assert room.stage.shown.number("time") == pytest.approx(0.4)


@pytest.mark.parametrize("begun_by", [ApplyPush(Push(force=50.0)), Branch()])
def test_a_hand_goes_on_with_both(own: Playback, lesson: OpenLesson, begun_by) -> None:
    """What differs stays different; a push and everything else is for both."""
    room = Classroom(own)
    room.take(lesson)
    played(room)
    room.take(ShowRun("push", 0.25))
    room.take(begun_by)
    assert room.news().on_stage == ""
    assert room.stage.beside.beside == Beside(priority=0.9)
    room.take(ApplyPush(Push(force=50.0)))
    room.take(SetPriority(0.3))
    room.stage.tick(100)
    first, second = room.stage.session, room.stage.beside.session
    assert (first.choices.priority, second.choices.priority) == (0.3, 0.9)
    assert first.pushes[-1] == second.pushes[-1]
    assert first.ticks == second.ticks


def test_a_hand_after_a_run_without_a_step_goes_on_with_the_steps_own(own: Playback, tmp_path) -> None:
    """A third run is only shown; what is tried is the pair of the step."""
    third = (PAIR[0][0], PAIR[0][1].replace("})}", '}), "third": lab.Run("stand", {"seconds": 0.4})}'))
    room = Classroom(own)
    room.take(OpenLesson(str(written(tmp_path, third, *PAIR[1:])), "g1"))
    played(room)
    room.take(PlayRun("third"))
    room.stage.tick(500)
    assert room.stage.beside is None
    room.take(ApplyPush(Push(force=50.0)))
    assert room.stage.beside.beside == Beside(priority=0.9)


def test_leaving_gives_the_second_robot_back(own: Playback, lesson: OpenLesson) -> None:
    room = Classroom(own)
    own.take(Pause())
    companion, row = own.beside, own.beside_shown.row.copy()
    truth = own.truth(1.0)
    other = own.beside_truth(truth)
    room.take(lesson)
    played(room)
    room.take(SetBeside(None))
    room.stage.tick(20)
    assert room.stage.beside is None
    room.take(LeaveLesson())
    assert room.stage is own
    assert own.beside is companion
    np.testing.assert_array_equal(own.beside_shown.row, row)
    assert own.truth(1.0) == truth
    assert own.beside_truth(truth) == other


def test_what_a_second_robot_can_differ_in() -> None:
    first = Scenario("a", priority=0.2, gains={"linear_damping": 3.0})
    assert difference(first, changed(first, seconds=9.0)) == Beside()
    assert difference(first, changed(first, priority=0.0)) == Beside(priority=0.0)
    tuned = changed(first, gains={"linear_damping": 4.0})
    assert difference(first, tuned) == Beside(gains={"linear_damping": 4.0})
    other = changed(first, controller="resolved-momentum", gains={})
    assert difference(first, other) == Beside(controller="resolved-momentum")
    assert difference(first, changed(first, controlled="linear")) is None
    assert difference(first, changed(first, gains={})) is None


def test_a_pair_that_differs_otherwise_is_played_but_not_handed_over(g1: RobotModel, tmp_path) -> None:
    path = written(
        tmp_path, (PAIR[0][0], PAIR[0][1].replace('"priority": 0.9', '"controlled": "linear"')), *PAIR[1:]
    )
    room = Classroom(Playback(Scenario("stand", robot="g1"), g1))
    room.take(OpenLesson(str(path), "g1"))
    played(room)
    stage = room.stage
    assert isinstance(stage, RunPlayback)
    assert set(room.news().seen) == {"push", "late"}
    assert stage.truth(1.0).beside is None
    assert stage.beside_truth(stage.truth(1.0)).controlled == "linear"
    room.take(SetPriority(0.5))
    assert room.stage.beside is None
