"""An opened run: played as it was, stopped where it ended, compared to the bit."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.app.playback import Playback
from momentum_lab.app.wire import Opened, OpenRun
from momentum_lab.beside import Beside
from momentum_lab.cli.beside import Second
from momentum_lab.errors import InputError
from momentum_lab.events import (
    ApplyPush,
    Branch,
    LoadScenario,
    LoggedEvent,
    LookBack,
    Pause,
    Play,
    Reset,
    SelectController,
    SetGain,
    SetGains,
)
from momentum_lab.headless import run_headless
from momentum_lab.physics.push import Push
from momentum_lab.run_file import Run
from momentum_lab.scenario import Scenario


@pytest.fixture(scope="module")
def original() -> Playback:
    """Somebody has pushed, stood the robot up, tuned, and paused."""
    playback = Playback(Scenario("theirs", robot="g1"))
    playback.take(ApplyPush(Push(force=60.0)))
    playback.tick(40)
    playback.take(Reset())
    playback.take(SetGain("linear_damping", 12.0))
    playback.tick(30)
    playback.take(ApplyPush(Push(force=50.0, direction_deg=90.0)))
    playback.tick(50)
    playback.take(Pause())
    return playback


@pytest.fixture
def opened(original) -> Playback:
    playback = Playback(Scenario("mine", robot="g1"))
    playback.take(OpenRun(original.taken().run))
    return playback


def test_it_is_played_to_its_end_with_the_same_bits(original, opened):
    runs = opened.run
    opened.tick(500)
    assert not opened.playing
    assert opened.session.log == original.session.log
    assert np.array_equal(opened.session.recording.rows(), original.session.recording.rows(), equal_nan=True)
    assert opened.truth(1.0).opened == Opened(0.122, over=True, agrees=True)
    assert opened.run == runs + 1  # it stood up on the way: what was drawn before is history


def test_play_goes_on_from_the_end(opened):
    opened.tick(500)
    ticks = opened.session.ticks
    opened.take(Play())
    opened.tick(5)
    assert opened.session.ticks == ticks + 5


def test_what_else_is_done_is_no_difference_of_bits(opened):
    opened.tick(10)
    opened.take(SetGain("friction", 0.5))
    opened.tick(500)
    assert opened.truth(1.0).opened == Opened(0.122, over=True, agrees=None)


def test_what_its_robot_cannot_do_any_more_is_left_out(original, opened):
    """Another controller has no such gain; what else was done in the run is done."""
    opened.tick(10)
    opened.take(SelectController("slack-qp"))
    opened.tick(500)
    assert not opened.playing
    done = [entry.event for entry in opened.session.log]
    theirs = [entry.event for entry in original.session.log]
    assert SetGain("linear_damping", 12.0) in theirs
    wanted = [event for event in theirs if event != SetGain("linear_damping", 12.0)]
    assert done == [wanted[0], SelectController("slack-qp"), *wanted[1:]]
    assert opened.truth(1.0).opened == Opened(0.122, over=True, agrees=None)


def test_a_way_back_plays_what_was_to_come_again(original, opened):
    opened.tick(500)
    opened.take(LookBack(0.06))
    opened.take(Branch())
    opened.tick(500)
    assert opened.session.log[: len(original.session.log)] == original.session.log


def test_standing_up_ends_it(opened):
    opened.tick(10)
    opened.take(Reset())
    opened.tick(300)
    assert opened.playing
    assert opened.truth(1.0).opened is None
    assert len(opened.session.log) == 2


def test_the_scenario_again_is_the_opened_run_again(opened):
    opened.tick(500)
    opened.take(LoadScenario("theirs"))
    assert opened.playing
    opened.tick(500)
    assert opened.truth(1.0).opened.agrees


def test_an_event_that_is_not_possible_leaves_everything_as_it_was():
    playback = Playback(Scenario("mine", robot="g1"))
    session = playback.session
    bad = Run(Scenario("theirs", robot="g1"), (LoggedEvent(3, SetGain("magic", 1.0)),), ticks=9)
    with pytest.raises(InputError, match="magic"):
        playback.take(OpenRun(bad))
    assert playback.session is session
    playback.tick(20)
    assert playback.session.ticks == 21


def test_both_robots_of_a_run_do_what_was_done():
    theirs = Playback(
        Scenario("theirs", robot="g1", beside=Beside(priority=1.0, gains={"linear_damping": 9.0}))
    )
    theirs.tick(20)
    theirs.take(ApplyPush(Push(force=60.0)))
    theirs.take(SetGains({"linear_damping": 12.0, "linear_stiffness": 40.0}))
    theirs.tick(40)
    run = theirs.taken().run
    mine = Playback(Scenario("mine", robot="g1"))
    mine.take(OpenRun(run))
    mine.tick(500)
    assert mine.truth(1.0).opened.agrees
    assert mine.truth(1.0).beside == run.scenario.beside
    assert mine.beside.session.choices.gains == theirs.beside.session.choices.gains
    assert mine.beside.session.choices.gains.linear_damping == 9.0
    rows = theirs.beside.session.recording.rows()
    assert np.array_equal(mine.beside.session.recording.rows(), rows, equal_nan=True)
    assert not np.array_equal(mine.session.recording.rows(), rows, equal_nan=True)
    without_a_screen = Second(run)
    run_headless(without_a_screen.session, cue=without_a_screen.cue, ticks=run.length)
    assert np.array_equal(without_a_screen.session.recording.rows(), rows, equal_nan=True)
