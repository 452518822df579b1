"""A robot beside the first: pushed alike, the same bits where nothing differs, and only what was chosen differs."""

from __future__ import annotations

import pytest

from momentum_lab.app.playback import Playback
from momentum_lab.beside import Beside
from momentum_lab.errors import InputError, SimulationError
from momentum_lab.events import (
    ApplyPush,
    Branch,
    LoadScenario,
    LookBack,
    Reset,
    RunAgain,
    SelectController,
    SelectRobot,
    SetBeside,
    SetGain,
    SetPriority,
)
from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario, load_scenario

PUSH = ApplyPush(Push(velocity_change=0.2))


def pair(beside: Beside, **fields: object) -> Playback:
    return Playback(Scenario("pair", robot="g1", beside=beside, **fields))


def other(playback: Playback):
    truth = playback.beside_truth(playback.truth(1.0))
    assert truth is not None
    return truth


def rows(playback: Playback) -> tuple[bytes, bytes]:
    assert playback.beside is not None
    count = min(len(playback.session.recording), len(playback.beside.session.recording))
    one, two = (s.recording.rows()[-count:] for s in (playback.session, playback.beside.session))
    return one.tobytes(), two.tobytes()


def test_fig7_opens_with_one_robot_that_stands_and_one_that_falls():
    playback = Playback(load_scenario("fig7"))
    assert other(playback).priority == 1.0
    playback.tick(2000)
    assert playback.truth(1.0).fall is None
    assert other(playback).fall is not None
    assert playback.truth(1.0).push == other(playback).push


def test_without_a_difference_both_move_bit_for_bit_alike_whatever_is_done():
    playback = pair(Beside())
    events = [PUSH, SetGain("linear_damping", 11.0), SetPriority(0.6), SelectController("slack-qp"), Reset()]
    for event in [*events, PUSH]:
        playback.tick(40)
        playback.take(event)
    playback.tick(80)
    assert len(set(rows(playback))) == 1


def test_the_first_robot_does_not_notice_the_second():
    alone, together = Playback(Scenario("s", robot="g1")), pair(Beside(priority=1.0))
    for playback in (alone, together):
        playback.tick(20)
        playback.take(PUSH)
        playback.tick(300)
    assert alone.session.recording.rows().tobytes() == together.session.recording.rows().tobytes()
    assert len(set(rows(together))) == 2


def test_a_second_robot_begins_where_the_first_is_even_in_mid_push():
    playback = Playback(Scenario("s", robot="g1"))
    playback.take(PUSH)
    playback.tick(50)
    playback.take(SetPriority(0.25))  # still waits for its tick
    playback.take(SetBeside(Beside()))
    playback.tick(200)
    assert other(playback).priority == 0.25
    assert len(set(rows(playback))) == 1
    playback.take(SetBeside(None))
    assert playback.beside_truth(playback.truth(1.0)) is None


def test_what_differs_stays_and_everything_else_follows_the_first():
    playback = pair(Beside(priority=1.0, gains={"linear_damping": 5.0}))
    for event in (SetPriority(0.3), SetGain("linear_damping", 9.0), SetGain("angular_damping", 7.0)):
        playback.take(event)
    playback.tick(2)
    first, second = playback.truth(1.0), other(playback)
    assert (first.priority, second.priority) == (0.3, 1.0)
    assert (first.gains["linear_damping"], second.gains["linear_damping"]) == (9.0, 5.0)
    assert first.gains["angular_damping"] == second.gains["angular_damping"] == 7.0
    playback.take(SetBeside(Beside()))
    assert (other(playback).priority, other(playback).gains) == (0.3, first.gains)


def test_another_controller_keeps_the_gains_it_knows():
    playback = pair(Beside(gains={"linear_damping": 5.0}))
    playback.take(SelectController("slack-qp"))
    playback.tick(1)
    assert other(playback).controller == "slack-qp"
    assert other(playback).gains == playback.truth(1.0).gains


@pytest.mark.parametrize(
    ("beside", "message"),
    [
        (Beside("nobody"), "controller: got nobody; allowed"),
        (Beside(priority=2.0), "priority: got 2.0; allowed: 0 to 1"),
        (Beside(gains={"nonsense": 1.0}), "gain: got nonsense; allowed"),
        (Beside(gains={"friction": 99.0}), "friction: got 99.0; allowed"),
    ],
)
def test_what_is_not_allowed_changes_nothing(beside, message):
    playback = pair(Beside(priority=1.0))
    with pytest.raises(InputError, match=message):
        playback.take(SetBeside(beside))
    playback.tick(1)
    assert playback.truth(1.0).beside == Beside(priority=1.0)


def test_both_are_looked_back_at_and_go_on_from_there():
    playback = pair(Beside(priority=1.0))
    playback.tick(50)
    playback.take(PUSH)
    playback.tick(150)
    playback.take(LookBack(0.1))
    shown = playback.beside_shown
    assert shown is not None
    assert shown.number("time") == playback.shown.number("time")
    playback.take(Branch())
    assert playback.beside is not None
    assert playback.beside.session.ticks == playback.session.ticks


def test_a_branch_to_before_the_second_came_lets_it_begin_there():
    playback = Playback(Scenario("s", robot="g1"))
    playback.tick(100)
    playback.take(SetBeside(Beside()))
    playback.tick(20)
    playback.take(LookBack(0.06))
    playback.take(Branch())
    playback.tick(30)
    assert len(set(rows(playback))) == 1


def test_a_simulation_that_cannot_go_on_leaves_the_first_alone(monkeypatch):
    playback = pair(Beside(priority=1.0))
    assert playback.beside is not None

    def fail():
        raise SimulationError("not finite")

    monkeypatch.setattr(playback.beside.session, "tick", fail)
    playback.tick(30)
    assert (playback.truth(1.0).stopped, other(playback).stopped) == (None, "not finite")
    monkeypatch.undo()
    playback.take(Reset())
    playback.tick(1)
    assert other(playback).stopped is None


def test_a_second_robot_counts_its_own_failures_only():
    playback = Playback(Scenario("s", robot="g1"))
    playback.session.solver_failures = 3
    playback.take(SetBeside(Beside()))
    playback.tick(2)
    assert (playback.truth(1.0).failures, other(playback).failures) == (3, 0)


def test_the_second_robot_stays_for_another_robot_and_leaves_with_its_scenario():
    playback = pair(Beside(priority=1.0))
    playback.take(SetBeside(Beside(priority=0.5)))
    playback.take(SelectRobot("icub"))
    assert other(playback).priority == 0.5
    playback.take(LoadScenario("stand"))
    assert playback.beside is None


# Same pushes again


def test_the_same_pushes_again_are_the_same_run_bit_for_bit():
    playback = Playback(Scenario("s", robot="g1"))
    for _ in range(2):
        playback.tick(100)
        playback.take(PUSH)
    playback.tick(199)
    before = playback.session.recording.rows().tobytes()
    run = playback.run
    playback.take(RunAgain())
    playback.tick(399)
    assert playback.run == run + 1
    assert playback.session.recording.rows()[:400].tobytes() == before


def test_the_same_pushes_come_soon_and_meet_the_choices_of_now():
    playback = Playback(Scenario("s", robot="g1"))
    playback.tick(2000)
    playback.take(PUSH)
    playback.tick(10)
    playback.take(SetPriority(1.0))
    playback.take(RunAgain())
    (push,) = playback.session.pushes
    assert push.start == pytest.approx(0.5)
    assert playback.session.choices.priority == 1.0
    assert playback.truth(1.0).first_push is None
    playback.tick(600)
    assert playback.truth(1.0).first_push == push
