"""Going back in time: an unchanged branch repeats the run bit for bit, a changed one leaves it from there on."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.control.registry import CONTROLLERS
from momentum_lab.errors import InputError
from momentum_lab.events import ApplyPush, Reset, SelectController, SetGain, SetPriority
from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session
from momentum_lab.timeline import Timeline, fork

EVENTS = {
    10: ApplyPush(Push(velocity_change=0.15)),
    57: SetGain("friction", 0.5),
    58: SetPriority(0.5),
    101: ApplyPush(Push(velocity_change=0.1, direction_deg=90.0)),
}


def session_of(robot, controller: str = "computed-torque", capacity: int = 400) -> Session:
    return Session(Scenario("test", robot=robot.spec.name, controller=controller), robot, capacity)


def run(session: Session, timeline: Timeline, until: int, events=EVENTS) -> None:
    while session.ticks < until:
        if session.ticks in events:
            session.post(events[session.ticks])
        timeline.note()
        session.tick()


def bits(session: Session) -> bytes:
    return session.recording.rows().tobytes()


@pytest.mark.parametrize("controller", CONTROLLERS)
def test_an_unchanged_branch_repeats_the_run_bit_for_bit(robot, controller):
    """Back from the middle of a recovery to an instant between two snapshots, with every kind of controller."""
    events = {tick: event for tick, event in EVENTS.items() if not isinstance(event, SetGain)}
    session = session_of(robot, controller)
    timeline = Timeline(session)
    run(session, timeline, 150, events)
    before, log = bits(session), list(session.log)
    timeline.go_back(150 - 77)
    assert session.ticks == 77
    assert session.time == pytest.approx(0.077)
    assert bits(session) == before[: len(bits(session))]
    assert len(session.recording) == 77
    run(session, timeline, 150, events)
    assert bits(session) == before
    assert session.log == log


def test_another_priority_from_there_on_leads_elsewhere(talos):
    session = session_of(talos)
    timeline = Timeline(session)
    events = {10: ApplyPush(Push(force=340.0))}
    run(session, timeline, 300, events)
    before = session.recording.column("momentum").copy()
    timeline.go_back(240)
    session.post(SetPriority(1.0))
    run(session, timeline, 300, {})
    after = session.recording.column("momentum")
    assert np.array_equal(before[:61], after[:61])
    assert np.abs(before[-1, 4] - after[-1, 4]) > 0.5  # angular momentum is kept small instead


def test_a_takeover_that_lasts_is_taken_up_again(g1):
    events = {20: SelectController("slack-qp"), 30: ApplyPush(Push(velocity_change=0.1))}
    session = session_of(g1)
    timeline = Timeline(session)
    run(session, timeline, 90, events)
    before = bits(session)
    timeline.go_back(55)
    assert session.choices.controller == "slack-qp"
    timeline.go_back(20)
    assert session.choices.controller == "computed-torque"
    run(session, timeline, 90, events)
    assert bits(session) == before


def test_nothing_is_remembered_across_standing_up_or_beyond_the_recording(talos):
    session = session_of(talos, capacity=100)
    timeline = Timeline(session)
    run(session, timeline, 300, {150: Reset()})
    assert session.time == pytest.approx(0.150)
    with pytest.raises(InputError, match="ticks: got 151; allowed: 0 to 1"):
        timeline.go_back(151)
    timeline.go_back(90)
    assert session.time == pytest.approx(0.060)


def test_samples_that_have_given_way_do_not_come_back(talos):
    session = session_of(talos, capacity=100)
    timeline = Timeline(session)
    run(session, timeline, 250, {})
    timeline.go_back(70)
    assert len(session.recording) == 30
    assert session.recording.column("time")[[0, -1]] == pytest.approx([0.150, 0.179])
    run(session, timeline, 230, {})
    assert session.recording.column("time")[[0, -1]] == pytest.approx([0.150, 0.229])


@pytest.mark.parametrize("controller", CONTROLLERS)
def test_a_fork_goes_on_as_the_session_does_bit_for_bit(robot, controller):
    session = session_of(robot, controller)
    for _ in range(150):
        session.tick()
    other = fork(session, 200)
    assert np.array_equal(other.recording.latest.row, session.recording.latest.row, equal_nan=True)
    for each in (session, other):
        each.post(ApplyPush(Push(velocity_change=0.15)))
    for _ in range(120):
        one, two = session.tick(), other.tick()  # in turns: neither may write into what is the other's
        assert one.row.tobytes() == two.row.tobytes()
    other.post(SetPriority(1.0))
    other.tick()
    assert (session.choices.priority, other.choices.priority) == (0.0, 1.0)
