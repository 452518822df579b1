"""A lesson in a session's process: what is seen is what is measured, and the person's own session waits."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.app.classroom import Classroom
from momentum_lab.app.lesson_runs import RunPlayback
from momentum_lab.app.lesson_wire import LeaveLesson, OfferRun, OpenLesson, PlayRun, ShowRun
from momentum_lab.app.playback import Playback
from momentum_lab.errors import InputError
from momentum_lab.events import (
    ApplyPush,
    Branch,
    Pause,
    Play,
    Reset,
    SetGain,
    SetPriority,
    SetSpeed,
    StepOnce,
)
from momentum_lab.lesson.record import LessonRecord, rehearsed
from momentum_lab.physics.push import Push
from momentum_lab.robot.model import RobotModel
from momentum_lab.scenario import Scenario
from tests.test_lesson import written

SHORT = ('"seconds": 2.0', '"seconds": 0.45')


@pytest.fixture
def own(g1: RobotModel) -> Playback:
    playback = Playback(Scenario("stand", robot="g1"), g1)
    playback.take(SetPriority(0.7))
    playback.tick(10)
    return playback


@pytest.fixture
def lesson(tmp_path) -> OpenLesson:
    return OpenLesson(str(written(tmp_path, SHORT)), "g1")


def played_to_its_end(room: Classroom) -> None:
    while room.stage.playing:
        room.stage.tick(20)


def test_nothing_moves_before_the_prediction(own: Playback, lesson: OpenLesson) -> None:
    room = Classroom(own)
    room.take(lesson)
    assert isinstance(room.stage, RunPlayback)
    assert not room.stage.playing
    for event in (Play(), StepOnce(20), ApplyPush(Push(force=50.0)), Reset(), SetGain("linear_damping", 3.0)):
        with pytest.raises(InputError, match="your prediction first"):
            room.take(event)
    room.take(SetSpeed(0.5))
    assert room.stage.speed == 0.5
    assert room.stage.session.ticks == 1


def test_play_plays_the_run_that_its_step_offers(own: Playback, lesson: OpenLesson) -> None:
    """The prediction has been made: any Play is the lesson's, and a hand still has to wait for it."""
    room = Classroom(own)
    room.take(lesson)
    room.take(OfferRun("push"))
    assert not room.stage.playing
    for event in (ApplyPush(Push(force=50.0)), StepOnce(20)):
        with pytest.raises(InputError, match="Play, to see the run"):
            room.take(event)
    room.take(Play())
    played_to_its_end(room)
    assert room.news().seen == ("push",)


def test_what_was_seen_is_what_was_rehearsed(own: Playback, lesson: OpenLesson) -> None:
    """The run that is played in sight, in several goes, gives the same bits as one without a screen."""
    room = Classroom(own)
    room.take(lesson)
    assert room.news().record is None
    room.take(PlayRun("push"))
    room.stage.tick(100)
    room.take(Pause())
    room.take(Play())
    played_to_its_end(room)
    assert room.stage.session.time == pytest.approx(0.45)
    news = room.news()
    assert news.seen == ("push",)
    assert isinstance(news.record, LessonRecord)
    assert news.record == rehearsed(lesson.file, "g1")
    assert room.news() is None


def test_hand_tries_on_a_copy_and_the_measured_run_stays(own: Playback, lesson: OpenLesson) -> None:
    room = Classroom(own)
    room.take(lesson)
    room.take(PlayRun("push"))
    played_to_its_end(room)
    rows = room.stage.session.recording.rows().copy()
    run = room.stage.run
    room.take(ApplyPush(Push(force=50.0)))
    room.take(SetGain("linear_damping", 3.0))
    room.stage.tick(30)
    assert room.news().on_stage == ""
    assert room.stage.run != run
    assert room.stage.session.choices.gains.linear_damping == 3.0
    assert room.stage.session.pushes[0].force == 50.0
    room.take(ShowRun("push", 0.3))
    played = room.stage.session
    assert room.news().on_stage == "push"
    assert room.stage.shown.number("time") == pytest.approx(0.3)
    np.testing.assert_array_equal(room.stage.session.recording.rows(), rows)
    room.take(Branch())
    assert room.news().on_stage == ""
    assert room.stage.playing
    column = room.stage.session.recording.column("com")
    np.testing.assert_array_equal(column, played.recording.column("com")[: len(column)])
    assert len(column) == pytest.approx(301, abs=1)
    room.take(SetPriority(1.0))
    room.stage.tick(500)
    assert room.stage.session.time > 0.75  # past the end of the run
    assert room.stage.session.choices.priority == 1.0


def test_instant_of_a_run_that_nobody_has_seen(own: Playback, lesson: OpenLesson) -> None:
    room = Classroom(own)
    room.take(lesson)
    room.take(ShowRun("push", 0.3))
    assert room.stage.shown.number("time") == pytest.approx(0.3)
    assert not room.stage.playing
    news = room.news()
    assert (news.on_stage, news.seen, news.record) == ("push", (), None)


def test_play_at_the_end_of_a_run_plays_it_again(own: Playback, lesson: OpenLesson) -> None:
    room = Classroom(own)
    room.take(lesson)
    room.take(PlayRun("push"))
    played_to_its_end(room)
    room.take(Play())
    assert room.stage.playing
    assert room.stage.session.ticks == 1


@pytest.mark.parametrize("playing", [True, False])
def test_leaving_gives_the_persons_own_session_back(own: Playback, lesson: OpenLesson, playing: bool) -> None:
    room = Classroom(own)
    own.take(Play() if playing else Pause())
    session, ticks, truth = own.session, own.session.ticks, own.truth(1.0)
    room.take(lesson)
    room.take(PlayRun("push"))
    played_to_its_end(room)
    room.take(SetPriority(0.2))
    assert room.news().file == lesson.file
    room.take(LeaveLesson())
    assert room.stage is own
    assert own.session is session
    assert own.session.ticks == ticks
    assert own.truth(1.0) == truth
    assert room.news().file == ""


def test_run_that_is_none_is_refused(own: Playback, lesson: OpenLesson) -> None:
    room = Classroom(own)
    with pytest.raises(InputError, match="no lesson is open"):
        room.take(PlayRun("push"))
    room.take(lesson)
    with pytest.raises(InputError, match="run: got pull; allowed: one of push"):
        room.take(PlayRun("pull"))


def test_lesson_that_broke_meanwhile_is_told(own: Playback, tmp_path) -> None:
    path = written(tmp_path, ("CLAIMS = (", "CLAIMED = ("))
    room = Classroom(own)
    room.take(OpenLesson(str(path), "g1"))
    assert room.stage is own
    assert room.news().error.startswith(f"{path}:1: got no CLAIMS")
