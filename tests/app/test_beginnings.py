"""When the robot was pushed, and which pushes a way back forgets."""

from __future__ import annotations

import pytest

from momentum_lab.app import beginnings as beginnings_of_a_run
from momentum_lab.app.beginnings import beginnings, latest_before
from momentum_lab.app.playback import Playback
from momentum_lab.app.wire import OpenRun
from momentum_lab.events import ApplyPush, Branch, HoldPush, LetGo, LookBack, Play
from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario

PUSH = Push(force=30.0, duration=0.05)


def test_pushes_that_have_begun_in_their_order():
    pushes = [Push(force=1.0, start=start, duration=0.1) for start in (2.0, 0.5, 0.55, 9.0)]
    assert beginnings(pushes, 2.0) == (0.5, 0.55, 2.0)
    assert latest_before((0.5, 2.0), 1.9) == 0.5
    assert latest_before((0.5, 2.0), 0.4) is None


class Counted(float):
    """A time that counts how often it is compared or computed with."""

    count = 0


def counting(name: str):
    def act(one: Counted, other: float):
        Counted.count += 1
        return getattr(float, name)(one, other)

    return act


for operation in ("__add__", "__sub__", "__truediv__", "__lt__", "__le__"):
    setattr(Counted, operation, counting(operation))


def work(pieces: int) -> int:
    """How much is done with the starts of so many pieces of one pull."""
    chain = [Push(force=1.0, start=Counted(0.001 * i), duration=0.001) for i in range(pieces)]
    Counted.count = 0
    assert beginnings(chain, 9.0) == (0.0,)
    return Counted.count


def test_ten_times_the_pieces_are_ten_times_the_work_in_the_process_that_keeps_time():
    assert work(1000) <= 12 * work(100)


def test_what_a_way_back_forgets_is_looked_up_once_while_nothing_changes(monkeypatch):
    asked = []
    known = beginnings_of_a_run.forgotten
    monkeypatch.setattr(beginnings_of_a_run, "forgotten", lambda *given: asked.append(given) or known(*given))
    playback = Playback(Scenario("s", robot="g1"))
    playback.take(ApplyPush(PUSH))
    playback.tick(100)
    playback.take(LookBack(0.05))
    assert [playback.truth(1.0).forgotten for _ in range(3)] == [()] * 3
    playback.take(LookBack(1.0))
    assert [playback.truth(1.0).forgotten for _ in range(3)] == [pytest.approx((0.001,))] * 3
    assert len(asked) == 2


def test_what_a_way_back_forgets_is_that_of_the_present_run():
    """Two runs that go on from the same instant, each with one push, at other times."""
    playback = Playback(Scenario("s", robot="g1"))
    playback.tick(50)
    told = []
    for wait in (10, 30):
        playback.tick(wait)
        playback.take(ApplyPush(PUSH))
        playback.tick(40)
        playback.take(LookBack(playback.session.time - 0.041))
        told.append(playback.truth(1.0).forgotten)
        playback.take(Branch())
    assert len(told[0]) == len(told[1]) == 1
    assert told[0] != told[1]


def test_a_hand_that_moves_pulls_once():
    playback = Playback(Scenario("s", robot="g1"))
    for force in (10.0, 20.0, 30.0):
        playback.take(HoldPush(Push(force=force)))
        playback.tick(20)
    playback.take(LetGo())
    playback.tick(50)
    playback.take(ApplyPush(PUSH))
    playback.tick(20)
    assert playback.truth(1.0).pushed == pytest.approx((0.001, 0.111))
    playback.take(LookBack(1.0))
    assert playback.truth(1.0).forgotten == pytest.approx((0.001, 0.111))


def test_what_a_way_back_forgets_is_told_before_and_is_true():
    playback = Playback(Scenario("s", robot="g1", pushes=(Push(force=20.0, duration=0.02, start=0.03),)))
    playback.tick(9)
    playback.take(ApplyPush(PUSH))
    playback.tick(90)
    assert playback.truth(1.0).forgotten == ()  # nobody looks back
    playback.take(LookBack(0.05))
    assert playback.truth(1.0).forgotten == ()  # the push came before
    playback.take(LookBack(0.095))
    truth = playback.truth(1.0)
    assert truth.forgotten == pytest.approx((0.01,))
    assert truth.pushed == pytest.approx((0.01, 0.03))
    playback.take(Branch())
    playback.tick(100)
    # The scenario's own push comes again, that of the hand does not.
    assert [push.start for push in playback.session.pushes] == [0.03]


def test_an_opened_run_pushes_again():
    theirs = Playback(Scenario("theirs", robot="g1"))
    theirs.take(ApplyPush(PUSH))
    theirs.tick(40)
    mine = Playback(Scenario("mine", robot="g1"))
    mine.take(OpenRun(theirs.taken().run))
    mine.tick(100)
    mine.take(Play())
    mine.take(ApplyPush(PUSH))
    mine.tick(20)
    mine.take(LookBack(9.0))
    assert mine.truth(1.0).forgotten == pytest.approx((0.041,))


def pulled(name: str) -> Playback:
    """A robot that has been pulled for 60 ms, and then let go for as long."""
    playback = Playback(Scenario(name, robot="g1"))
    playback.take(HoldPush(Push(force=10.0)))
    playback.tick(60)
    playback.take(LetGo())
    playback.tick(60)
    return playback


def test_a_hand_that_is_forgotten_lets_go():
    """Going on from the middle of a pull: nobody is there any more to end it."""
    playback = pulled("s")
    playback.take(LookBack(0.09))
    at = playback.shown.number("time")
    playback.take(Branch())
    playback.tick(200)
    (push,) = playback.session.pushes
    assert push.start + push.duration == pytest.approx(at)
    assert not playback.session.holds


def test_an_opened_run_lets_go_when_it_did():
    theirs = pulled("theirs")
    mine = Playback(Scenario("mine", robot="g1"))
    mine.take(OpenRun(theirs.taken().run))
    mine.tick(200)
    mine.take(LookBack(0.09))
    mine.take(Branch())
    mine.tick(200)
    assert mine.session.log == theirs.session.log
    assert mine.truth(1.0).opened.agrees is not False
