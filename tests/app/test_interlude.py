"""Scenes in a session's process: what was on stage waits, and comes back with the same bits."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.app.classroom import Classroom
from momentum_lab.app.demo_wire import LeaveScenes, ShowScene
from momentum_lab.app.lesson_wire import OpenLesson
from momentum_lab.app.playback import Playback
from momentum_lab.errors import InputError
from momentum_lab.events import LookBack, Pause, SetPriority
from momentum_lab.robot.model import RobotModel
from momentum_lab.scenario import Scenario
from tests.test_lesson import written

SCENES = [Scenario("stand", robot="g1"), Scenario("stand", robot="g1", priority=1.0)]


@pytest.fixture
def own(g1: RobotModel) -> Playback:
    playback = Playback(Scenario("stand", robot="g1"), g1)
    playback.take(SetPriority(0.7))
    playback.tick(40)
    playback.take(LookBack(0.02))
    playback.speed = 0.25
    return playback


def test_a_person_finds_everything_as_it_was(own: Playback) -> None:
    room, before = Classroom(own), own.truth(1.0)
    rows = own.session.recording.rows().copy()
    runs = [own.run]
    for scene in SCENES:
        room.take(ShowScene(scene))
        room.stage.tick(30)
        assert room.in_demo
        assert room.stage.session.scenario == scene
        assert room.stage.speed == 1.0
        assert room.stage.run not in runs
        runs.append(room.stage.run)
    room.take(LeaveScenes())
    assert not room.in_demo
    assert room.stage is own
    assert own.truth(1.0) == before
    np.testing.assert_array_equal(own.session.recording.rows(), rows)


def test_a_hand_ends_the_scenes_and_acts_on_its_own_robot(own: Playback) -> None:
    room = Classroom(own)
    room.take(ShowScene(SCENES[1]))
    room.take(SetPriority(0.3))
    assert room.stage is own
    assert own.truth(1.0).priority == 0.3


def test_a_scene_that_cannot_be_played_changes_nothing(own: Playback) -> None:
    room = Classroom(own)
    with pytest.raises(InputError, match="motion"):
        room.take(ShowScene(Scenario("kick", robot="g1", motion="somersault")))
    assert room.stage is own
    assert not room.in_demo


def test_a_lesson_waits_too(own: Playback, tmp_path) -> None:
    room = Classroom(own)
    room.take(OpenLesson(str(written(tmp_path)), "g1"))
    lesson, told = room.stage, room.news()
    room.take(ShowScene(SCENES[0]))
    assert room.news() is None
    room.take(Pause())
    assert room.stage is lesson
    assert told is not None
    assert told.file
