"""A run that another was opened in place of is not lost."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.app.classroom import Classroom
from momentum_lab.app.left_runs import LeftRuns
from momentum_lab.app.playback import Playback
from momentum_lab.app.wire import FrameTaken, OpenRun, TakeBack, rows_of
from momentum_lab.errors import InputError
from momentum_lab.events import ApplyPush, LoggedEvent, SetGain, SetPriority
from momentum_lab.physics.push import Push
from momentum_lab.robot.model import RobotModel
from momentum_lab.run_file import Run
from momentum_lab.scenario import Scenario
from tests.app.test_worker import played

OTHER = OpenRun(Run(Scenario("other", robot="g1"), ticks=30))


def mine(g1: RobotModel) -> Playback:
    playback = Playback(Scenario("mine", robot="g1"), g1)
    playback.take(SetPriority(0.7))
    playback.take(ApplyPush(Push(force=60.0)))
    playback.tick(40)
    return playback


def test_what_was_live_comes_back_and_goes_on_as_if_nothing_had_been_opened(g1: RobotModel) -> None:
    room, undisturbed = Classroom(mine(g1)), mine(g1)
    run = room.stage.run
    room.take(OTHER)
    assert room.left == ("mine until 0.04 s",)
    assert room.stage.session.scenario.name == "other"
    assert room.stage.truth(1.0).opened is not None
    room.stage.tick(20)
    opened = room.stage.run
    room.take(TakeBack())
    assert len({run, opened, room.stage.run}) == 3  # or what is drawn would be mixed
    assert room.left == ()
    for playback in (room.stage, undisturbed):
        playback.tick(60)
    rows = [playback.session.recording.rows() for playback in (room.stage, undisturbed)]
    assert np.array_equal(*rows, equal_nan=True)
    assert room.stage.session.log == undisturbed.session.log


def test_a_run_that_cannot_be_opened_changes_nothing(g1: RobotModel) -> None:
    room = Classroom(mine(g1))
    stage = room.stage
    with pytest.raises(InputError, match="magic"):
        room.take(
            OpenRun(Run(Scenario("bad", robot="g1"), (LoggedEvent(3, SetGain("magic", 1.0)),), ticks=9))
        )
    assert room.stage is stage
    assert room.left == ()
    with pytest.raises(InputError, match="take back: got no run"):
        room.take(TakeBack())


def test_a_robot_that_only_stood_there_is_not_kept(g1: RobotModel) -> None:
    room = Classroom(Playback(Scenario("stand", robot="g1"), g1))
    room.take(OTHER)
    assert room.left == ()


def test_the_last_few_are_kept(g1: RobotModel) -> None:
    left, stage = LeftRuns(), mine(g1)
    for name in ("a", "b", "c"):
        stage.take(SetPriority(0.5))
        stage.tick(5)
        stage = left.open(stage, Run(Scenario(name, robot="g1")))
    assert [name.split()[0] for name in left.names] == ["a", "b"]
    assert left.take_back(stage).session.scenario.name == "b"


def test_what_was_done_in_an_opened_run_can_be_taken_back_in_turn(g1: RobotModel) -> None:
    room = Classroom(mine(g1))
    room.take(OTHER)
    room.take(SetPriority(0.2))
    room.stage.tick(40)
    opened = room.stage
    room.take(TakeBack())
    assert room.stage.session.scenario.name == "mine"
    assert room.left == ("other until 0.03 s",)  # it stops where it ended
    room.take(TakeBack())
    assert room.stage is opened


def test_a_worker_sends_all_of_what_has_been_taken_back() -> None:
    answers = [[FrameTaken()]] * 2 + [[FrameTaken(), ApplyPush(Push(force=100.0))]] + [[FrameTaken()]] * 3
    answers += [[FrameTaken(), OpenRun(Run(Scenario("other")))]] + [[FrameTaken()]] * 3
    pipe = played([*answers, [FrameTaken(), TakeBack()], [FrameTaken()]])
    before = next(frame for frame in pipe.frames if frame.left)
    back = next(frame for frame in pipe.frames[pipe.frames.index(before) :] if not frame.left)
    assert before.left[0].startswith("s until 0.")
    assert (before.truth.scenario, back.truth.scenario) == ("other", "s")
    assert back.truth.run > before.truth.run
    width = len(np.frombuffer(back.row))
    times = rows_of(back.history, width)[:, 0]
    assert times[0] == 0.0
    assert times[-1] > 0.1
