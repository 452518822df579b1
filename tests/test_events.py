"""Events are plain data: they survive a file and a wire, and nothing else is taken for one."""

from __future__ import annotations

import msgspec
import pytest

from momentum_lab.events import (
    ApplyPush,
    Event,
    LoggedEvent,
    Pause,
    Play,
    Reset,
    SelectController,
    SessionEvent,
    SetGain,
    SetPriority,
    StepOnce,
)
from momentum_lab.physics.push import Push

EVENTS = [
    SetGain("linear_damping", 7.5),
    SetPriority(0.25),
    SelectController("computed-torque"),
    ApplyPush(
        Push(force=100.0, duration=0.2, direction_deg=-30.0, height=1.2, body="head", shape="half-sine")
    ),
    Reset(),
    Play(),
    Pause(),
    StepOnce(ticks=5),
]


@pytest.mark.parametrize("event", EVENTS, ids=lambda event: type(event).__name__)
def test_an_event_survives_json(event):
    assert msgspec.json.decode(msgspec.json.encode(event), type=Event) == event


def test_every_kind_of_event_has_its_own_tag():
    names = [kind.__struct_config__.tag for kind in Event.__args__]
    assert len(set(names)) == len(names)


def test_a_log_survives_json():
    log = [LoggedEvent(tick, event) for tick, event in enumerate(EVENTS[:5])]
    assert msgspec.json.decode(msgspec.json.encode(log), type=list[LoggedEvent]) == log


def test_an_event_cannot_be_changed_afterwards():
    with pytest.raises(AttributeError):
        EVENTS[0].value = 9.0


@pytest.mark.parametrize(
    "text",
    [
        pytest.param(b'{"type": "Explode"}', id="unknown"),
        pytest.param(b'{"type": "SetGain", "name": "friction"}', id="incomplete"),
        pytest.param(b'{"type": "SetPriority", "value": "high"}', id="wrong type"),
        pytest.param(b'{"type": "ApplyPush", "push": {"force": -3.0}}', id="out of range"),
        pytest.param(b'{"type": "ApplyPush", "push": {"force": 3.0, "newtons": 3.0}}', id="unknown field"),
        pytest.param(b'{"type": "ApplyPush", "push": {"force": 3.0, "shape": "spike"}}', id="unknown shape"),
    ],
)
def test_what_is_no_event_is_refused(text):
    with pytest.raises(msgspec.ValidationError):
        msgspec.json.decode(text, type=Event)


def test_a_session_takes_no_playback_events_from_a_wire():
    with pytest.raises(msgspec.ValidationError):
        msgspec.json.decode(b'{"type": "Pause"}', type=SessionEvent)
