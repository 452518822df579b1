"""A run again: the same bits, and the first place where they are not."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from momentum_lab.errors import InputError
from momentum_lab.events import (
    ApplyPushes,
    LoggedEvent,
    Reset,
    SelectController,
    SetGain,
    SetGains,
    SetPriority,
)
from momentum_lab.finished import FinishedRun
from momentum_lab.physics.push import Push
from momentum_lab.provenance import provenance
from momentum_lab.replay import end_agreement, prepared, replayed, trace_agreement
from momentum_lab.run_file import Run, run_of, run_of_trace
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session
from momentum_lab.share_code import from_code, to_code
from momentum_lab.trace import load_trace, save_trace

EVENTS = {
    20: [SetPriority(0.5), SetGains({"linear_damping": 11.0, "linear_stiffness": 30.0})],
    50: [
        ApplyPushes(
            (Push(force=40.0, start=0.02), Push(velocity_change=0.05, start=0.05, direction_deg=90.0))
        )
    ],
    120: [SelectController("whole-body-qp"), SetGain("linear_damping", 9.0)],
}


@pytest.fixture(scope="module")
def original(request) -> Session:
    """A session in which a person has done this and that."""
    session = Session(Scenario("busy", robot="g1", pushes=(Push(force=30.0, start=0.03),)), capacity=200)
    for tick in range(200):
        for event in EVENTS.get(tick, []):
            session.post(event)
        session.tick()
    return session


def test_a_code_repeats_a_run_bit_for_bit(original):
    run = run_of(original)
    again, timing = replayed(from_code(to_code(run)))
    assert timing.error is None
    assert again.log == original.log
    assert np.array_equal(again.recording.rows(), original.recording.rows(), equal_nan=True)
    assert end_agreement(run, again).agrees
    assert [round(push.start, 3) for push in again.pushes] == [0.03, 0.07, 0.1]


def test_a_trace_holds_its_run_and_agrees_with_it(original, tmp_path):
    path = tmp_path / "t.npz"
    save_trace(original.recording, provenance(original), path)
    trace = load_trace(path)
    assert run_of_trace(trace) == run_of(original)
    again, _ = replayed(run_of_trace(trace))
    agreement = trace_agreement(trace, again)
    assert agreement.agrees
    assert agreement.compared == f"200 samples of {len(trace.columns)} quantities"


def test_the_first_different_bit_is_named(original, tmp_path):
    path = tmp_path / "t.npz"
    save_trace(original.recording, provenance(original), path)
    trace = load_trace(path)
    trace.columns["momentum"][150, 4] = np.nextafter(trace.columns["momentum"][150, 4], 1e9)
    trace.columns["com"][170, 0] += 1e-3
    agreement = trace_agreement(trace, original)
    assert not agreement.agrees
    assert agreement.difference == "momentum at 0.150 s is the first of them"


def test_a_trace_of_the_end_alone_is_compared_at_its_end(original, tmp_path):
    path = tmp_path / "t.npz"
    save_trace(original.recording, provenance(original), path)
    trace = load_trace(path)
    for name, column in trace.columns.items():
        trace.columns[name] = column[-50:]
    assert trace_agreement(trace, original).agrees


def test_another_run_has_another_end(original):
    run = run_of(original)
    other, _ = replayed(msgspec.structs.replace(run, events=run.events[:-1]))
    assert not end_agreement(run, other).agrees


def test_a_run_may_contain_standing_up_again():
    session = Session(Scenario("s", robot="g1"), capacity=60)
    for tick in range(60):
        if tick == 30:
            session.post(Reset())
        session.tick()
    assert len(session.recording) == 30
    run = run_of(session)
    assert run.ticks == 60
    again, _ = replayed(run)
    assert end_agreement(run, again).agrees
    assert FinishedRun.of(again).time == pytest.approx(0.03)


@pytest.mark.parametrize(
    ("event", "message"),
    [
        (SetGain("magic", 1.0), "^gain: got magic; allowed: one of "),
        (SetGains({"linear_damping": 1e9}), "^linear_damping: got "),
        (ApplyPushes((Push(),)), "^push: got force None, velocity_change None"),
        (ApplyPushes((Push(force=1.0, body="tail"),)), "^body: got tail; allowed: "),
    ],
)
def test_events_that_are_not_possible_are_refused_before_the_first_tick(event, message):
    with pytest.raises(InputError, match=message):
        prepared(Run(Scenario("s", robot="g1"), (LoggedEvent(5, event),), ticks=10))


def test_checking_events_leaves_the_session_as_it_was(g1):
    session = Session(Scenario("s", robot="g1"), robot=g1)
    session.post(SetPriority(0.25))
    session.check([SelectController("slack-qp"), SetGain("com_weight", 5.0)])
    with pytest.raises(InputError):
        session.check([SetPriority(0.5), SetGain("com_weight", 5.0)])
    session.tick()
    assert [entry.event for entry in session.log] == [SetPriority(0.25)]
