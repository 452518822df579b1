"""Playing, pausing, stepping, and another robot or scenario without losing what was chosen."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.app.playback import Playback
from momentum_lab.errors import InputError, SimulationError
from momentum_lab.events import (
    ApplyPush,
    Branch,
    LoadScenario,
    LookBack,
    Pause,
    Play,
    Reset,
    SelectController,
    SelectRobot,
    SetAngularGoal,
    SetDirections,
    SetGain,
    SetMotion,
    SetPriority,
    SetSpeed,
    StepOnce,
)
from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario


@pytest.fixture
def playback() -> Playback:
    return Playback(Scenario("mine", robot="talos"))


def truth(playback: Playback):
    return playback.truth(1.0)


def test_it_starts_playing_with_a_sample(playback):
    assert truth(playback).playing
    assert playback.latest.number("time") == 0.0
    assert truth(playback).robot == "talos"
    assert truth(playback).push is None


def test_step_pauses_and_advances(playback):
    playback.take(StepOnce(5))
    assert not truth(playback).playing
    assert playback.latest.number("time") == pytest.approx(0.005)
    playback.take(Play())
    assert truth(playback).playing


def test_speed(playback):
    playback.take(SetSpeed(0.25))
    assert truth(playback).speed == 0.25


def test_what_waits_for_the_next_tick_counts_as_done(playback):
    playback.take(Pause())
    playback.take(SetPriority(0.4))
    playback.take(SetGain("linear_damping", 12.5))
    assert playback.session.choices.priority == 0.0
    assert truth(playback).priority == 0.4
    assert truth(playback).gains["linear_damping"] == 12.5
    playback.tick(1)
    assert playback.session.choices.priority == truth(playback).priority == 0.4
    assert playback.session.choices.gains.linear_damping == truth(playback).gains["linear_damping"] == 12.5


@pytest.mark.parametrize(
    "event",
    [
        SetPriority(2.0),
        SetDirections("up"),
        SetGain("nonsense", 1.0),
        SetGain("friction", 99.0),
        SelectRobot("nobody"),
    ],
)
def test_what_is_not_allowed_changes_nothing(playback, event):
    before = truth(playback)
    with pytest.raises(InputError):
        playback.take(event)
    playback.tick(3)
    assert truth(playback) == before


def test_a_push_is_told_once_it_has_begun(playback):
    playback.take(ApplyPush(Push(force=50.0, start=9.0)))
    playback.tick(2)
    push = truth(playback).push
    assert push is not None
    assert (push.force, push.start) == (50.0, pytest.approx(0.001))


def test_scripted_pushes_are_told_when_they_begin():
    playback = Playback(Scenario("s", pushes=(Push(force=10.0, start=0.005),)))
    assert truth(playback).push is None
    playback.tick(10)
    assert truth(playback).push.force == 10.0


def test_standing_up_is_immediate_and_keeps_choices(playback):
    playback.take(SetPriority(0.7))
    playback.tick(20)
    run = truth(playback).run
    playback.take(Pause())
    playback.take(Reset())
    assert playback.latest.number("time") == 0.0
    assert truth(playback).run == run + 1
    assert truth(playback).priority == 0.7
    assert not truth(playback).playing


def test_another_robot_keeps_scenario_priority_and_changed_gains(playback):
    playback.take(SetPriority(0.3))
    playback.take(SetGain("linear_damping", 11.0))
    playback.tick(1)
    run = truth(playback).run
    playback.take(SelectRobot("g1"))
    now = truth(playback)
    assert (now.robot, now.scenario, now.priority, now.run) == ("g1", "mine", 0.3, run + 1)
    assert now.gains["linear_damping"] == 11.0
    assert playback.latest["q"].shape == (playback.session.robot.nq,)


def test_another_scenario_keeps_the_robot():
    playback = Playback(Scenario("mine", robot="g1"))
    playback.take(LoadScenario("push-forward"))
    assert truth(playback).robot == "g1"
    assert truth(playback).scenario == "push-forward"
    playback.take(LoadScenario("mine"))
    assert truth(playback).scenario == "mine"


def test_another_robot_keeps_a_motion_that_it_knows(playback):
    playback.take(SetMotion("arm-swing"))
    playback.tick(1)
    playback.take(SelectRobot("g1"))
    assert truth(playback).motion == "arm-swing"
    playback.take(SelectRobot("icub"))
    assert truth(playback).motion == ""


def test_the_same_scenario_again_keeps_the_loaded_robot(playback):
    robot = playback.session.robot
    playback.take(LoadScenario("stand"))
    assert playback.session.robot is robot


def test_a_simulation_that_cannot_go_on_says_so_and_keeps_its_recording(playback, monkeypatch):
    playback.tick(5)
    samples = len(playback.session.recording)

    def fail():
        raise SimulationError("the state is not finite after 0.006 s; the recording is kept")

    monkeypatch.setattr(playback.session, "tick", fail)
    playback.tick(3)
    now = truth(playback)
    assert now.stopped == "the state is not finite after 0.006 s; the recording is kept"
    assert not now.playing
    assert len(playback.session.recording) == samples
    with pytest.raises(InputError, match="stand the robot up first"):
        playback.take(Play())
    monkeypatch.undo()
    playback.take(Reset())
    assert truth(playback).stopped is None
    assert truth(playback).playing
    assert np.isfinite(playback.latest.row[:50]).all()


@pytest.fixture
def fallen() -> Playback:
    """A robot that was pushed far too hard at 0.1 s."""
    playback = Playback(Scenario("s", robot="g1", pushes=(Push(force=500.0, start=0.1),)))
    while truth(playback).fall is None:
        playback.tick(50)
    return playback


def test_looking_back_shows_what_was_and_stops_time(fallen):
    end = fallen.latest.number("time")
    fallen.take(LookBack(end - 0.05))
    now = truth(fallen)
    assert fallen.shown.number("time") == pytest.approx(0.05)
    assert fallen.latest.number("time") == end
    assert (now.playing, now.fall, now.push) == (False, None, None)
    assert now.behind == pytest.approx(end - 0.05)
    fallen.take(StepOnce(60))
    assert fallen.shown.number("time") == pytest.approx(0.11)
    assert truth(fallen).push is not None
    fallen.take(LookBack(1e3))
    assert fallen.shown.number("time") == 0.0
    fallen.take(Play())
    assert fallen.shown.number("time") == end
    assert truth(fallen).fall is not None


def test_a_branch_goes_on_from_there_with_what_was_chosen_meanwhile(fallen):
    end, rows = fallen.latest.number("time"), fallen.session.recording.rows().copy()
    fallen.take(LookBack(end - 0.05))
    fallen.take(SelectController("slack-qp"))
    fallen.take(SetGain("com_damping", 12.0))
    fallen.take(SetPriority(0.5))
    fallen.take(SetDirections("kz+linear"))
    fallen.take(SetMotion("arm-swing"))
    fallen.take(SetAngularGoal("reference"))
    assert truth(fallen).controlled == "linear+kz"
    fallen.take(Branch())
    now = truth(fallen)
    assert fallen.shown.number("time") == fallen.latest.number("time") == pytest.approx(0.05)
    assert (now.playing, now.fall, now.behind) == (True, None, 0.0)
    assert (now.controller, now.priority, now.gains["com_damping"]) == ("slack-qp", 0.5, 12.0)
    assert np.array_equal(fallen.session.recording.rows()[:50], rows[:50])
    assert (now.controlled, now.planner) == ("linear+kz", "momentum")
    assert (now.motion, now.angular_goal) == ("arm-swing", "reference")
    assert [entry.tick for entry in fallen.session.log] == 6 * [50]
    fallen.tick(1)
    assert fallen.session.choices.controller == "slack-qp"


def test_an_unchanged_branch_repeats_what_was(fallen):
    rows = fallen.session.recording.rows().copy()
    fallen.take(LookBack(fallen.latest.number("time") - 0.123))
    fallen.take(Branch())
    fallen.tick(len(rows) - len(fallen.session.recording))
    assert np.array_equal(fallen.session.recording.rows(), rows, equal_nan=True)


def test_a_branch_from_the_very_beginning(fallen):
    fallen.take(LookBack(1e3))
    fallen.take(Branch())
    assert fallen.latest.number("time") == 0.0
    assert len(fallen.session.recording) == 1


def test_a_branch_from_where_the_robot_was_stood_up(playback):
    """What was chosen since then holds, what was done since then has not been done."""
    playback.tick(30)
    playback.take(Reset())
    playback.tick(20)
    playback.take(ApplyPush(Push(force=60.0)))
    playback.tick(20)
    playback.take(Pause())
    playback.take(SetPriority(0.5))
    playback.take(LookBack(1e3))
    assert playback.shown.number("time") == 0.0
    playback.take(Branch())
    now = truth(playback)
    assert (now.playing, now.behind, now.priority, now.push) == (True, 0.0, 0.5, None)
    assert playback.latest.number("time") == 0.0
    playback.tick(40)
    fresh = Playback(Scenario("mine", robot="talos", priority=0.5))
    fresh.tick(40)
    assert np.array_equal(fresh.session.recording.rows(), playback.session.recording.rows(), equal_nan=True)


def test_a_branch_at_the_end_just_goes_on(playback):
    playback.tick(10)
    playback.take(Pause())
    playback.take(Branch())
    assert truth(playback).playing
    assert playback.session.ticks == 11
