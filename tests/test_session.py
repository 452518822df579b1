"""The conductor: events at the next tick, the same bits from the same events, and an end in words."""

from __future__ import annotations

import dataclasses
import math

import msgspec
import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.control.computed_torque import ComputedTorque
from momentum_lab.errors import GainError, InputError, ScenarioError, SimulationError
from momentum_lab.events import (
    ApplyPush,
    LoggedEvent,
    MoveGround,
    Reset,
    SelectController,
    SetGain,
    SetPriority,
)
from momentum_lab.physics.plate import PlateMotion
from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session
from tests.conftest import assert_close, yaw_rotation
from tests.runs import PUSH_START, forward_push, play, played

PUSH = Push(force=60.0, duration=0.03, direction_deg=90.0, start=99.0)


def session_of(robot, **changes) -> Session:
    return Session(Scenario("test", robot=robot.spec.name, **changes), robot=robot)


def run(session: Session, ticks: int) -> Session:
    for _ in range(ticks):
        session.tick()
    return session


def bits(session: Session) -> bytes:
    return session.recording.rows().tobytes()


# Events


def test_an_event_acts_at_the_next_tick_and_not_before(talos):
    session = run(session_of(talos), 3)
    session.post(SetPriority(0.7))
    session.post(SetGain("linear_damping", 5.0))
    assert session.choices.priority == 0.0
    assert session.choices.gains.linear_damping != 5.0
    assert session.log == []
    assert session.tick().number("priority") == 0.7
    assert session.choices.gains.linear_damping == 5.0
    assert session.log == [
        LoggedEvent(3, SetPriority(0.7)),
        LoggedEvent(3, SetGain("linear_damping", 5.0)),
    ]


def test_events_act_in_the_order_in_which_they_came(talos):
    session = session_of(talos)
    for value in (0.1, 0.9, 0.4):
        session.post(SetPriority(value))
    session.tick()
    assert session.choices.priority == 0.4
    assert [entry.event.value for entry in session.log] == [0.1, 0.9, 0.4]


def test_a_push_begins_when_it_is_asked_for(robot):
    """At the tick that takes the event, whatever start it names; its impulse arrives whole."""
    session = run(session_of(robot), 20)
    session.post(ApplyPush(PUSH))
    run(session, 60)
    push = session.recording.column("push_wrench")[:, 1]
    assert np.flatnonzero(np.abs(push) > 1e-6).tolist() == list(range(20, 50))
    assert 1e-3 * push.sum() == pytest.approx(60.0 * 0.03, rel=1e-9)
    assert session.recording.column("momentum")[51, 1] > 0.5 * 60.0 * 0.03


def test_a_push_by_its_velocity_change_fits_the_robot(robot):
    session = session_of(robot)
    session.post(ApplyPush(Push(velocity_change=0.05, duration=0.05)))
    run(session, 60)
    impulse = 1e-3 * session.recording.column("push_wrench")[:, 0].sum()
    assert impulse == pytest.approx(0.05 * robot.mass, rel=1e-9)


def test_scenario_and_log_replay_the_run_bit_for_bit(robot):
    """Pushes, gains, priority, a controller and a reset, posted at the ticks of the log to a new session."""
    events = {
        40: [SetGain("linear_stiffness", 20.0), ApplyPush(PUSH)],
        55: [SetPriority(0.5)],
        120: [SelectController("computed-torque"), ApplyPush(Push(velocity_change=0.05, body="pelvis"))],
        180: [Reset()],
        200: [ApplyPush(PUSH), SetPriority(0.0)],
    }
    scenario = forward_push(robot, seconds=0.3)
    first = Session(scenario, robot=robot, capacity=300)
    for tick in range(300):
        for event in events.get(tick, []):
            first.post(event)
        first.tick()
    log = msgspec.json.decode(msgspec.json.encode(first.log), type=list[LoggedEvent])
    again = Session(scenario, robot=robot, capacity=300)
    for tick in range(300):
        for entry in log:
            if entry.tick == tick:
                again.post(entry.event)
        again.tick()
    assert len(log) == 8
    assert bits(again) == bits(first)
    assert again.log == first.log


@pytest.mark.parametrize(
    ("event", "message"),
    [
        (SetGain("stiffness", 1.0), "gain: got stiffness; allowed: one of linear_damping"),
        (SetGain("linear_damping", 1e6), "linear_damping: got 1000000.0; allowed: a number from"),
        (SetGain("linear_damping", math.nan), "linear_damping: got nan"),
        (SetPriority(1.1), "priority: got 1.1; allowed: a number from 0"),
        (SetPriority(math.nan), "priority: got nan"),
        (SelectController("lqr"), "controller: got lqr; allowed: one of computed-torque"),
        (ApplyPush(Push(force=10.0, body="tail")), "body: got tail; allowed: one of pelvis"),
        (ApplyPush(Push()), "push: got force None, velocity_change None"),
        (ApplyPush(Push(force=1.0, velocity_change=1.0)), "push: got force 1.0, velocity_change 1.0"),
        (ApplyPush(Push(force=math.nan)), "force: got nan"),
        (ApplyPush(Push(force=-10.0)), "force: got -10"),
        (ApplyPush(Push(force=1e9)), "force: got 1000000000"),
        (ApplyPush(Push(force=10.0, duration=0.0)), "duration: got 0"),
        (ApplyPush(Push(force=10.0, duration=math.inf)), "duration: got inf"),
        (ApplyPush(Push(force=10.0, direction_deg=math.nan)), "direction_deg: got nan"),
        (ApplyPush(Push(force=10.0, height=math.nan)), "height: got nan"),
    ],
)
def test_what_cannot_be_done_is_refused_at_once_and_leaves_no_trace(talos, event, message):
    session = run(session_of(talos), 2)
    with pytest.raises(InputError, match=message):
        session.post(event)
    run(session, 2)
    assert session.log == []
    assert bits(session) == bits(run(session_of(talos), 4))


TILT = MoveGround(PlateMotion("pitch", 8.0, course="step", period=1.0))


def test_what_waits_counts_when_the_next_is_asked_for(talos):
    """Two tilts of 8 degrees in one pause: the second is refused as it comes, and the next tick is done."""
    session = run(session_of(talos), 2)
    session.post(TILT)
    with pytest.raises(InputError, match="ground: got 16 degrees of pitch in all"):
        session.post(TILT)
    session.post(Reset())
    session.post(TILT)  # on the ground of the start
    session.tick()
    assert [entry.event for entry in session.log] == [TILT, Reset(), TILT]
    with pytest.raises(InputError, match="ground: got 16 degrees"):
        session.check([SetPriority(0.5), TILT])
    assert len(run(session, 1).log) == 3


def test_reset_stands_the_robot_up_with_its_gains(g1):
    """After a fall: the first state again, the clock at zero, an empty recording; gains and priority stay."""
    session = session_of(g1, seconds=1.5, pushes=(Push(force=400.0, duration=0.1, start=0.0),))
    first = session.tick()["q"].copy()
    session.post(SetGain("linear_damping", 9.0))
    session.post(SetPriority(0.3))
    while session.fall is None:
        session.tick()
    session.post(Reset())
    sample = session.tick()
    assert session.fall is None
    assert session.solver_failures == 0
    assert session.last_failure is None
    assert (sample.number("time"), session.time, len(session.recording)) == (0.0, 1e-3, 1)
    assert_close(sample["q"], first, 0.0)
    assert (session.choices.gains.linear_damping, session.choices.priority) == (9.0, 0.3)
    run(session, 200)
    assert session.fall is None
    assert session.log[-1].event == Reset()


def test_another_controller_starts_with_its_own_gains(talos):
    session = session_of(talos, gains={"linear_damping": 5.0})
    assert session.choices.gains.linear_damping == 5.0
    session.post(SelectController("computed-torque"))
    run(session, 5)
    assert session.choices.gains == type(session.choices.gains)()
    assert session.choices.controller == "computed-torque"


# Runs


def test_a_run_begins_with_the_priority_of_its_scenario(talos):
    session = session_of(talos, priority=0.6)
    assert session.choices.priority == 0.6
    assert session.tick().number("priority") == 0.6


def test_the_clock_counts_ticks(talos):
    session = session_of(talos, timestep=5e-4)
    run(session, 7)
    assert session.ticks == 7
    assert session.time == pytest.approx(3.5e-3)
    assert session.recording.latest.number("time") == pytest.approx(3e-3)


def test_the_ring_keeps_the_last_samples(robot):
    """Half a second in a ring of 0.09 s: the same rows as in a recording that keeps everything."""
    scenario = forward_push(robot, seconds=0.5)
    short = run(Session(scenario, robot=robot, capacity=90), 500)
    assert len(short.recording) == 90
    assert bits(short) == played(robot, scenario).recording.rows()[-90:].tobytes()


def test_a_recording_is_as_long_as_its_scenario(talos):
    assert session_of(talos, seconds=0.0105).recording.capacity == 11
    assert session_of(talos, seconds=2.0, timestep=5e-4).recording.capacity == 4000


def test_sessions_that_share_a_robot_do_not_meet(robot):
    """Tick by tick in turns, one pushed and one not: each as if it were alone."""
    pushed, calm = Session(forward_push(robot, seconds=0.4), robot=robot), session_of(robot, seconds=0.4)
    for _ in range(400):
        pushed.tick()
        calm.tick()
    assert bits(pushed) == played(robot, forward_push(robot, seconds=0.4)).recording.rows().tobytes()
    assert bits(calm) == bits(play(robot, calm.scenario))


def test_a_start_elsewhere_is_the_same_stance_moved_and_turned(robot):
    here, there = session_of(robot), session_of(robot, position=(3.0, -2.0), heading_deg=70.0)
    turn = yaw_rotation(math.radians(70.0))
    assert_close(there.dynamics.com_in_world, turn @ here.dynamics.com_in_world + [3.0, -2.0, 0.0], 1e-12)
    assert_close(there.dynamics.sole_rotation, turn @ here.dynamics.sole_rotation, 1e-12)
    assert_close(np.linalg.norm(there.state.q[3:7]), 1.0, 1e-15)
    assert_close(there.state.q[7:], here.state.q[7:], 0.0)


def test_standing_on_one_foot_starts_with_the_other_in_the_air(robot):
    session = session_of(robot, stance=("right",))
    left, right = session.dynamics.sole_position[:, 2]
    assert left > 0.02
    assert abs(right) < 1e-4
    assert session.stance == (1,)


def test_friction_is_the_scenarios_or_else_the_robots(robot):
    """On ice the same push ends in another place."""
    push = (Push(velocity_change=0.2, duration=0.1, start=0.0),)
    own = play(robot, Scenario("own", robot=robot.spec.name, seconds=0.3, pushes=push))
    same = msgspec.structs.replace(own.scenario, friction=robot.spec.friction)
    ice = msgspec.structs.replace(own.scenario, friction=0.02)
    assert bits(play(robot, same)) == bits(own)
    assert np.abs(play(robot, ice).state.q[:3] - own.state.q[:3]).max() > 1e-3


@pytest.mark.parametrize(
    ("changes", "error", "message"),
    [
        ({"controller": "lqr"}, InputError, "controller: got lqr"),
        ({"gains": {"magic": 1.0}}, GainError, "gain: got magic"),
        ({"stance": ("middle",)}, ScenarioError, "stance: got middle; allowed: feet among left, right"),
        ({"pushes": (Push(force=1.0, body="tail"),)}, InputError, "body: got tail"),
        ({"pushes": (Push(),)}, InputError, "push: got force None"),
    ],
)
def test_a_scenario_of_things_that_do_not_exist_is_refused(talos, changes, error, message):
    with pytest.raises(error, match=message):
        session_of(talos, **changes)


# Ends


def test_a_fall_is_said_once_with_its_time_and_its_reason(g1):
    session = session_of(g1, seconds=2.0, pushes=(Push(force=400.0, duration=0.1, start=0.0),))
    run(session, 2000)
    fallen = session.recording.column("fallen")
    first = int(np.argmax(fallen))
    assert 0 < first < 1999
    assert fallen[first:].all()
    assert session.fall.time == pytest.approx((first - 1) * 1e-3, abs=1.1e-3)
    assert session.fall.reason in (
        "something other than a sole touched the ground",
        session.fall.reason if session.fall.reason.startswith("the CoM sank to ") else "",
    )


def test_a_fallen_robot_is_limp_and_ends_on_the_ground(g1):
    """No command after the tick of the fall: torques only brake, nothing but weight is expected, no one is blamed."""
    session = session_of(g1, seconds=2.0, pushes=(Push(force=400.0, duration=0.1, start=0.0),))
    run(session, 2000)
    column = session.recording.column
    after = np.flatnonzero(column("fallen"))[1:]
    power = column("torque")[after] * column("v")[after][:, 6:]
    assert power.max() <= 1e-12
    assert_close(column("momentum_rate_desired")[after, 2], np.full(after.size, -g1.mass * 9.81), 1e-9)
    assert not column("solver_failed")[after].any()
    assert column("com")[-1, 2] < 0.5 * column("com")[0, 2]
    assert column("other_contact_wrench")[-1, 2] > 0.0


def test_standing_is_no_fall(robot):
    session = played(robot, forward_push(robot))
    assert session.fall is None
    assert not session.recording.column("fallen").any()


def test_a_solver_failure_is_counted_and_its_reason_kept(talos, monkeypatch):
    """One tick in three has no answer: the robot goes on, and the status knows why."""
    honest, calls = ComputedTorque.compute, []

    def flaky(self, *arguments):
        output = honest(self, *arguments)
        calls.append(1)
        return dataclasses.replace(output, failure="cannot be met: this") if len(calls) % 3 == 0 else output

    monkeypatch.setattr(ComputedTorque, "compute", flaky)
    session = run(session_of(talos), 9)
    assert session.solver_failures == 3
    assert session.last_failure == "cannot be met: this"
    assert session.recording.column("solver_failed").tolist() == [0, 0, 1] * 3


@pytest.fixture
def breaks_at_the_tenth_tick(monkeypatch):
    honest, calls = ComputedTorque.compute, []

    def breaking(self, *arguments):
        output = honest(self, *arguments)
        calls.append(1)
        return dataclasses.replace(output, torque=output.torque * np.nan) if len(calls) == 10 else output

    monkeypatch.setattr(ComputedTorque, "compute", breaking)


@pytest.mark.usefixtures("breaks_at_the_tenth_tick")
def test_a_state_that_is_not_finite_ends_the_run_and_keeps_the_recording(talos):
    session = run(session_of(talos), 9)
    before = bits(session)
    with pytest.raises(SimulationError, match=r"not finite after 0.01\d* s; the recording is kept"):
        session.tick()
    assert session.recording.rows()[:9].tobytes() == before
    assert np.isfinite(session.recording.column("q")).all()
    assert np.isfinite(session.recording.column("v")).all()


@pytest.mark.usefixtures("breaks_at_the_tenth_tick")
def test_a_run_that_has_ended_stays_ended_until_it_is_reset(talos):
    session = run(session_of(talos), 9)
    for _ in range(3):
        with pytest.raises(SimulationError):
            session.tick()
    assert np.isfinite(session.recording.column("q")).all()
    session.post(Reset())
    run(session, 5)
    assert len(session.recording) == 5
    assert session.state.is_finite()


def test_pushes_of_the_scenario_act_at_their_time(robot):
    session = played(robot, forward_push(robot))
    push = session.recording.column("push_wrench")[:, 0]
    first = int(np.flatnonzero(np.abs(push) > 1e-6)[0])
    assert first == round(PUSH_START / 1e-3)


def test_the_quaternion_of_the_base_stays_a_rotation(robot):
    q = played(robot, forward_push(robot)).recording.column("q")
    assert_close(np.linalg.norm(q[:, 3:7], axis=1), np.ones(len(q)), 1e-9)
    assert pin.isNormalized(robot.model, q[-1], 1e-9)
