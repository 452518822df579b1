"""What goes through the pipe comes out the same."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from momentum_lab import events
from momentum_lab.app.playback import Playback
from momentum_lab.app.wire import (
    Frame,
    FrameTaken,
    FrameWanted,
    TakeBack,
    packed,
    rows_of,
    unpacked_answer,
    unpacked_message,
)
from momentum_lab.beside import Beside
from momentum_lab.physics.plate import PlateMotion
from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario

EVENTS = [
    events.SetGain("friction", 0.5),
    events.SetGains({"friction": 0.5, "linear_damping": 9.0}),
    events.SetPriority(0.25),
    events.SelectController("computed-torque"),
    events.SetDirections("linear+kz"),
    events.SelectPlanner("cop-to-com"),
    events.SetMotion("kick"),
    events.SetAngularGoal("reference"),
    events.SetFriction(0.2, "left"),
    events.MoveGround(PlateMotion("pitch", -5.0, "step", 1.5), "right"),
    events.StopGround(),
    events.SetGroundSense("felt"),
    events.SetMismatch("mass_error", -0.1),
    events.ApplyPush(Push(force=217.0, body="head", shape="half-sine")),
    events.ApplyPushes((Push(force=217.0, start=0.2), Push(velocity_change=0.1))),
    events.HoldPush(Push(force=50.0, body="left_hand", point=(0.0, 0.1, -0.2))),
    events.LetGo(),
    events.Reset(),
    events.Play(),
    events.Pause(),
    events.StepOnce(7),
    events.SetSpeed(0.5),
    events.SelectRobot("g1"),
    events.LoadScenario("stand"),
    events.LookBack(1.5),
    events.Branch(),
    events.SetBeside(Beside("slack-qp", 0.5, {"com_weight": 2.0})),
    events.RunAgain(),
    events.Foresee(Push(force=217.0)),
]


@pytest.mark.parametrize(
    "message", [*EVENTS, FrameTaken(), FrameWanted(), TakeBack()], ids=lambda m: type(m).__name__
)
def test_messages(message):
    assert unpacked_message(packed(message)) == message


def test_every_event_is_here():
    named = {cls.__name__ for cls in events.Event.__args__}
    assert {type(event).__name__ for event in EVENTS} == named


def test_frames():
    playback = Playback(Scenario("s", robot="g1"))
    row = playback.latest.row
    frame = Frame(playback.truth(0.99), row.tobytes(), np.vstack([row, row]).tobytes(), ("a", "b"))
    back = unpacked_answer(packed(frame))
    assert back == frame
    assert np.array_equal(rows_of(back.row, row.size), row[None], equal_nan=True)
    assert rows_of(back.history, row.size).shape == (2, row.size)


def test_foreign_bytes_are_refused():
    with pytest.raises(msgspec.DecodeError):
        unpacked_message(b"\xc1")
    with pytest.raises(msgspec.ValidationError):
        unpacked_message(msgspec.msgpack.encode({"type": "Explode"}))
