"""The same run again: pushes, moving ground and ice as they were, choices as they are now."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.app.playback import Playback
from momentum_lab.app.wire import OpenRun
from momentum_lab.events import (
    ApplyPush,
    HoldPush,
    LetGo,
    LoggedEvent,
    MoveGround,
    Reset,
    RunAgain,
    SessionEvent,
    SetFriction,
    SetPriority,
    StopGround,
)
from momentum_lab.physics.plate import PlateMotion
from momentum_lab.physics.push import Push
from momentum_lab.run_file import Run
from momentum_lab.scenario import Scenario, changed, load_scenario

PUSH = Push(force=120.0, duration=0.1)
ICE, SWAY = SetFriction(0.3, "left"), MoveGround(PlateMotion("x", 0.01, period=1.0))


@pytest.fixture
def playback() -> Playback:
    return Playback(Scenario("mine", robot="g1"))


def do(playback: Playback, *script: tuple[int, SessionEvent], until: int) -> np.ndarray:
    """Do some things at their ticks; all samples."""
    for tick, event in script:
        playback.tick(tick - playback.session.ticks)
        playback.take(event)
    playback.tick(until - playback.session.ticks)
    return playback.session.recording.rows().copy()


def test_what_begins_early_is_repeated_to_the_bit(playback):
    before = do(playback, (300, ICE), (400, SWAY), (700, ApplyPush(PUSH)), (900, StopGround()), until=1500)
    assert np.ptp(before[:, playback.session.recording.slices["ground_pose"]], axis=0).max() > 0.005
    playback.take(RunAgain())
    playback.tick(1499)
    np.testing.assert_array_equal(playback.session.recording.rows(), before)


def test_choices_are_those_of_now(playback):
    before = do(playback, (300, ICE), (400, ApplyPush(PUSH)), until=700)
    playback.take(SetPriority(1.0))
    playback.take(RunAgain())
    playback.tick(699)
    session = playback.session
    assert session.choices.priority == 1.0
    assert session.ground.friction(0.299).tolist() != session.ground.friction(0.3).tolist() == [0.3, 0.7]
    np.testing.assert_allclose(session.recording.rows()[:400, 1:50], before[:400, 1:50], atol=1e-6)
    assert not np.array_equal(session.recording.rows()[-1], before[-1])


def test_everything_comes_sooner_alike(playback):
    do(playback, (2000, SWAY), (2300, ApplyPush(PUSH)), (2350, ICE), until=2400)
    playback.take(RunAgain())
    playback.tick(899)
    ground, (push,) = playback.session.ground, playback.session.pushes
    assert ground.motions[0].motion.start == pytest.approx(0.5)
    assert push.start == pytest.approx(0.8)
    assert ground.changes[0][1].start == pytest.approx(0.85)


def test_twice_again_is_the_same_again(playback):
    do(playback, (900, ICE), (1000, ApplyPush(PUSH)), until=1400)
    rows = []
    for _ in range(2):
        playback.take(RunAgain())
        playback.tick(999)
        rows.append(playback.session.recording.rows().copy())
    np.testing.assert_array_equal(*rows)
    playback.tick(1)
    assert playback.session.log == [LoggedEvent(500, ICE)]


def test_what_has_not_come_yet_is_not_lost(playback):
    do(playback, (300, ApplyPush(PUSH)), (400, ICE), until=500)
    playback.take(RunAgain())
    playback.tick(100)
    playback.take(RunAgain())  # before the push and the ice have come
    playback.take(SetFriction(0.2, "right"))
    playback.take(RunAgain())  # and this one waits for the next tick
    playback.tick(450)
    assert [push.start for push in playback.session.pushes] == pytest.approx([0.3])
    assert playback.session.ground.friction(0.45).tolist() == [0.3, 0.2]


def test_what_came_before_the_robot_stood_up_is_over(playback):
    do(playback, (300, SWAY), (400, Reset()), until=800)
    playback.take(ICE)
    playback.tick(10)
    playback.take(RunAgain())
    playback.tick(700)
    assert not playback.session.ground.motions
    assert [(entry.tick, entry.event) for entry in playback.session.log] == [(400, ICE)]


def test_an_opened_run_is_repeated_up_to_its_first_stand_up(playback):
    later = (LoggedEvent(300, ApplyPush(PUSH)), LoggedEvent(400, Reset()), LoggedEvent(500, ICE))
    playback.take(OpenRun(Run(Scenario("kept", robot="g1"), later, ticks=600)))
    playback.tick(100)
    playback.take(RunAgain())
    playback.tick(600)
    assert [push.start for push in playback.session.pushes] == pytest.approx([0.3])
    assert playback.session.log == [later[0]]


def test_on_ground_that_moves_by_itself_nothing_comes_sooner():
    boat = changed(load_scenario("boat"), robot="g1", pushes=())
    playback = Playback(boat)
    before = do(playback, (1700, ApplyPush(PUSH)), until=2000)
    playback.take(RunAgain())
    playback.tick(1999)
    np.testing.assert_array_equal(playback.session.recording.rows(), before)


def test_what_an_opened_run_will_hold_is_held_in_its_repetition(playback):
    later = (LoggedEvent(300, HoldPush(PUSH)), LoggedEvent(360, LetGo()))
    playback.take(OpenRun(Run(Scenario("kept", robot="g1"), later, ticks=600)))
    playback.tick(100)
    playback.take(RunAgain())
    playback.tick(500)
    (push,) = playback.session.pushes
    assert (push.start, push.duration, push.force) == pytest.approx((0.3, 0.06, 120.0))
