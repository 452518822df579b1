"""A push that is held lasts exactly from one tick to another, whatever a hand does in between."""

from __future__ import annotations

import msgspec
import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.errors import InputError
from momentum_lab.events import ApplyPush, ApplyPushes, HoldPush, LetGo, LoggedEvent, Reset
from momentum_lab.physics.held_push import Pushed
from momentum_lab.physics.push import MAX_DURATION, MAX_REACH, Push, apply_pushes
from momentum_lab.replay import replayed
from momentum_lab.robot.state import State
from momentum_lab.run_file import run_of
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session
from momentum_lab.share_code import from_code, to_code
from tests.conftest import assert_close, random_state

LEFT = Push(force=40.0, direction_deg=90.0, start=9.0, duration=7.0, shape="half-sine")
FORWARD = Push(force=30.0, body="left_hand", point=(0.02, -0.01, -0.1))


def session_of(robot) -> Session:
    return Session(Scenario("test", robot=robot.spec.name), robot=robot)


def played(session: Session, events: dict[int, list], ticks: int) -> Session:
    for tick in range(ticks):
        for event in events.get(tick, []):
            session.post(event)
        session.tick()
    return session


def test_a_hand_that_turns_leaves_no_gap_and_no_overlap(talos):
    events = {20: [HoldPush(LEFT)], 50: [HoldPush(FORWARD)], 90: [LetGo()]}
    session = played(session_of(talos), events, 120)
    wrench = session.recording.column("push_wrench")
    expected = np.zeros((120, 2))
    expected[20:50, 1], expected[50:90, 0] = 40.0, 30.0
    assert_close(wrench[:, :2], expected, 1e-9)
    assert [round(push.duration, 9) for push in session.pushes] == [0.03, 0.04]
    assert [push.shape for push in session.pushes] == ["rectangle", "rectangle"]


def test_what_is_held_now_has_lasted_until_now(talos):
    session = played(session_of(talos), {10: [HoldPush(LEFT)]}, 35)
    (push,) = session.pushes
    assert push.duration == pytest.approx(0.025)


def test_nobody_holds_for_ever():
    pushed = Pushed(()).held_from(1.0, LEFT)
    assert pushed.all[0].duration == MAX_DURATION
    assert pushed.let_go(60.0).all[0].duration == MAX_DURATION


def test_grabbed_and_let_go_in_a_pause_is_no_push(talos):
    session = played(session_of(talos), {5: [HoldPush(LEFT), HoldPush(FORWARD), LetGo(), LetGo()]}, 10)
    assert session.pushes == ()
    assert not session.recording.column("push_wrench").any()


def test_a_robot_that_stands_up_is_held_no_more(talos):
    session = played(session_of(talos), {5: [HoldPush(LEFT)], 20: [Reset()], 25: [LetGo()]}, 40)
    assert session.pushes == ()
    assert not session.recording.column("push_wrench").any()


def test_a_held_push_is_repeated_bit_for_bit(robot):
    """The log of a run in which a hand pulls, turns, is joined by a pulse and lets go, posted to a new session."""
    events = {
        15: [HoldPush(LEFT)],
        40: [HoldPush(FORWARD), ApplyPush(Push(velocity_change=0.05))],
        41: [HoldPush(msgspec.structs.replace(FORWARD, force=35.0))],
        130: [LetGo()],
    }
    first = played(session_of(robot), events, 160)
    log = msgspec.json.decode(msgspec.json.encode(first.log), type=list[LoggedEvent])
    again = session_of(robot)
    played(again, {tick: [e.event for e in log if e.tick == tick] for tick in range(160)}, 160)
    assert len(log) == 5
    assert again.recording.rows().tobytes() == first.recording.rows().tobytes()


def test_going_back_into_a_held_push_and_on_again_changes_no_bit(talos):
    session = played(session_of(talos), {10: [HoldPush(LEFT)]}, 30)
    before = session.snapshot()
    rows = played(session, {10: [LetGo()]}, 40).recording.rows().tobytes()
    session.resume(before)
    assert played(session, {10: [LetGo()]}, 40).recording.rows().tobytes() == rows


def test_the_pieces_of_a_hold_as_a_sequence_are_the_same_push(talos):
    events = {20: [HoldPush(LEFT)], 50: [HoldPush(FORWARD)], 90: [LetGo()]}
    held = played(session_of(talos), events, 150)
    pieces = tuple(msgspec.structs.replace(p, start=p.start - 0.02) for p in held.pushes)
    given = played(session_of(talos), {20: [ApplyPushes(pieces)]}, 150)
    assert_close(given.recording.column("q"), held.recording.column("q"), 1e-9)


def test_a_point_moves_with_its_body(robot, rng):
    """Force and moment about the origin of the world, and the power of the force, in any state."""
    for _ in range(5):
        state = random_state(robot, rng)
        push = Push(force=50.0, direction_deg=25.0, start=0.0, body="left_hand", point=(0.1, -0.05, 0.2))
        data = robot.model.createData()
        applied = apply_pushes(robot, data, robot.at(state), (push,), 0.0, 1e-3)
        link = robot.frame(robot.spec.push_bodies["left_hand"])
        places = []
        for eps in (-1e-6, 0.0, 1e-6):
            pin.framesForwardKinematics(robot.model, data, robot.integrate(state.q, eps * state.v))
            places.append(data.oMf[link].act(np.array(push.point)))
        force = 50.0 * push.direction
        assert_close(applied.wrench, np.concatenate([force, np.cross(places[1], force)]), 1e-9)
        power = force @ (places[2] - places[0]) / 2e-6
        assert applied.generalized @ state.v == pytest.approx(power, rel=1e-6, abs=1e-5)


def test_any_link_can_be_pushed(talos):
    link = talos.model.frames[talos.frame("arm_left_5_link")].name
    session = played(session_of(talos), {5: [ApplyPush(Push(force=20.0, body=link, point=(0, 0, 0)))]}, 20)
    assert_close(session.recording.column("push_wrench")[10, :3], [20.0, 0.0, 0.0], 1e-9)
    assert isinstance(session.state, State)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"point": (0.0, np.nan, 0.0)}, "point: got"),
        ({"point": (0.0, 2.0 * MAX_REACH, 0.0)}, "three numbers from -3 to 3 m"),
        ({"point": (0.0, 0.0)}, "three numbers"),
        ({"point": (0.0, 0.0, 0.0), "height": 1.0}, "one of the two"),
        ({"body": "universe"}, "body: got universe; allowed: one of pelvis.*or a link"),
        ({"force": None}, "either a force"),
    ],
)
def test_what_cannot_be_held_is_refused_and_leaves_no_trace(talos, changes, message):
    session = session_of(talos)
    with pytest.raises(InputError, match=message):
        session.post(HoldPush(msgspec.structs.replace(FORWARD, **changes)))
    session.tick()
    assert session.log == []


def test_what_waits_for_the_next_tick_counts_as_done(talos):
    """A run that is taken right after a hand has let go holds the whole hold, as the next tick will have it."""
    session = played(session_of(talos), {10: [HoldPush(LEFT)]}, 35)
    waiting = [LetGo(), ApplyPush(FORWARD), Reset(), HoldPush(LEFT), LetGo(), ApplyPush(FORWARD)]
    for count in (1, 2):
        later = session.pushes_after(waiting[:count])
        for event in waiting[:count]:
            session.post(event)
        before = session.snapshot()
        session.tick()
        assert session.pushes == later
        session.resume(before)
    assert [push.start for push in session.pushes_after(waiting)] == [session.time]
    assert session.pushes_after(()) == session.pushes


def test_a_pull_upwards_lifts_a_part_of_the_weight_and_is_replayed_to_the_bit(talos):
    """Under the soles there is less of the weight by the force that pulls up, once the robot has come to rest."""
    up = Push(force=100.0, elevation_deg=90.0, body="trunk", point=(0.0, 0.0, 0.1))
    session = played(session_of(talos), {20: [HoldPush(up)], 1000: [LetGo()]}, 1020)
    assert_close(session.recording.column("push_wrench")[21:999, :3], [[0.0, 0.0, 100.0]] * 978, 1e-9)
    pressed = session.recording.column("foot_wrench_measured")[:, :, 2].sum(axis=1)
    weight = pressed[10]
    assert pressed[900:999].mean() == pytest.approx(weight - 100.0, abs=5.0)
    again = replayed(from_code(to_code(run_of(session))))[0]
    assert again.recording.rows().tobytes() == session.recording.rows().tobytes()
