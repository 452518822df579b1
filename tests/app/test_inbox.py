"""Nothing that a client invents reaches a session."""

from __future__ import annotations

import math

import msgspec
import pytest

from momentum_lab.app.inbox import checked_event
from momentum_lab.beside import Beside
from momentum_lab.errors import InputError
from momentum_lab.events import (
    ApplyPush,
    LoadScenario,
    LookBack,
    Pause,
    SelectRobot,
    SetBeside,
    SetGain,
    SetPriority,
    SetSpeed,
    StepOnce,
)
from momentum_lab.physics.push import MAX_FORCE, Push

NAN, INF = math.nan, math.inf


def check(event):
    return checked_event(event, ("talos", "g1"), ("stand",))


@pytest.mark.parametrize(
    "event",
    [
        Pause(),
        StepOnce(1),
        StepOnce(1000),
        SetSpeed(0.125),
        SetSpeed(1.0),
        SelectRobot("g1"),
        SetBeside(None),
        SetBeside(Beside("slack-qp", 0.5, {"com_weight": 2.0})),
        LoadScenario("stand"),
        LookBack(0.0),
        LookBack(60.0),
        SetGain("anything", 1e9),
        SetPriority(0.5),
        ApplyPush(Push(force=10.0, height=None)),
    ],
)
def test_what_is_allowed_passes_unchanged(event):
    assert check(event) == event


@pytest.mark.parametrize(
    ("event", "message"),
    [
        (SetGain("linear_damping", NAN), "value: got nan; allowed: a finite number"),
        (SetPriority(INF), "value: got inf; allowed: a finite number"),
        (SetSpeed(NAN), "value: got nan; allowed: a finite number"),
        (SetSpeed(2.0), "speed: got 2.0; allowed: 0.125 to 1"),
        (SetSpeed(0.0), "speed: got 0.0; allowed: 0.125 to 1"),
        (LookBack(-0.1), "look back: got -0.1; allowed: 0 to 3600 s"),
        (LookBack(1e9), "look back: got 1000000000.0; allowed: 0 to 3600 s"),
        (StepOnce(0), "step: got 0; allowed: 1 to 1000 ticks"),
        (StepOnce(10**9), "step: got 1000000000; allowed: 1 to 1000 ticks"),
        (SelectRobot("/etc/passwd"), "robot: got /etc/passwd; allowed: one of talos, g1"),
        (LoadScenario("../x.toml"), "scenario: got ../x.toml; allowed: one of stand"),
        (
            SetGain("x" * 300, 1.0),
            "name: got xxxxxxxxxxxxxxxxxxxx...; allowed: at most 200 letters",
        ),
        (ApplyPush(Push(force=NAN)), "force: got nan; allowed: a finite number"),
        (ApplyPush(Push(force=10.0, height=-INF)), "height: got -inf; allowed: a finite number"),
    ],
)
def test_what_is_not_allowed_is_named(event, message):
    with pytest.raises(InputError) as error:
        check(event)
    assert str(error.value) == message


@pytest.mark.parametrize(
    ("field", "value"),
    [("force", MAX_FORCE * 2), ("force", -1.0), ("duration", 0.0), ("direction_deg", 1e4), ("height", 99.0)],
)
def test_a_push_stays_within_its_ranges(field, value):
    push = msgspec.structs.replace(Push(force=10.0), **{field: value})
    with pytest.raises(InputError, match=f"^{field}: got {value}"):
        check(ApplyPush(push))
