"""Runs as files: there and back, and one clear line for everything that is no run."""

from __future__ import annotations

import json

import msgspec
import numpy as np
import pytest

from momentum_lab.errors import InputError
from momentum_lab.events import ApplyPush, ApplyPushes, LoggedEvent, SetGain, SetGains
from momentum_lab.physics.push import Push
from momentum_lab.run_file import Run, decoded, encoded, fingerprint, read_run
from momentum_lab.scenario import Scenario, load_scenario

RUN = Run(
    load_scenario("push-forward"),
    (
        LoggedEvent(10, SetGain("linear_damping", 7.123456789012345)),
        LoggedEvent(10, SetGains({"friction": 1 / 3})),
        LoggedEvent(200, ApplyPush(Push(force=50.0))),
        LoggedEvent(400, ApplyPushes((Push(force=50.0, start=0.1), Push(velocity_change=0.1)))),
    ),
    ticks=900,
    end="0123456789ab",
)
TOML = """
format = "momentum_lab run"
version = 1
ticks = 300
[scenario]
name = "mine"
robot = "g1"
[[events]]
tick = 100
event = { type = "SetGains", values = { linear_damping = 9.0 } }
"""


def test_there_and_back(tmp_path):
    path = tmp_path / "run.json"
    path.write_bytes(encoded(RUN))
    assert read_run(path) == RUN


def test_a_file_written_by_hand():
    run = decoded("mine.toml", TOML.encode())
    events = (LoggedEvent(100, SetGains({"linear_damping": 9.0})),)
    assert run == Run(Scenario("mine", robot="g1"), events, ticks=300)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"format": "other"}, r'^run file: got r\.json; allowed: a file with format = "momentum_lab run"$'),
        ({"version": 2}, r"^version in r\.json: got 2; allowed: 1, which this lab writes$"),
        ({"scenario": None}, r"^scenario in r\.json: got nothing; allowed: a table"),
        (
            {"scenario": {"name": "x", "priority": 3.0}},
            r"^priority in r\.json: got 3\.0; allowed: number <= 1",
        ),
        (
            {"scenario": {"name": "x", "colour": 3.0}},
            r"^scenario in r\.json: got colour; allowed: the fields name",
        ),
        ({"ticks": -1}, r"^ticks in r\.json: got -1; allowed: 0 to 3600000"),
        ({"ticks": 300}, r"^events in r\.json: got ticks .*; allowed: ticks in order, 0 to 300$"),
        ({"ticks": "long"}, r"^ticks in r\.json: got something else; allowed: Expected int, got str$"),
        ({"events": [{"tick": 0, "event": {"type": "Explode"}}]}, r"^events\[0\]\.event\.type in r\.json: "),
    ],
)
def test_what_is_no_run_is_refused(changes, message):
    data = {**json.loads(encoded(RUN)), **changes}
    with pytest.raises(InputError, match=message) as caught:
        decoded("r.json", json.dumps(data).encode())
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("r.json", b"{"),
        ("r.json", b"[" * 100_000),
        ("r.json", b"[1]"),
        ("r.json", b""),
        ("r.toml", b"= ["),
        ("r.toml", b"\xff"),
        ("r.npz", b"PK"),
        ("r.exe", b"MZ"),
        ("r", b"x"),
        ("r.json", b" " * 5_000_001),
    ],
)
def test_foreign_files_are_refused(name, content):
    with pytest.raises(InputError, match=r"^(run file|recording): got r.*; allowed: ") as caught:
        decoded(name, content)
    assert "\n" not in str(caught.value)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(InputError, match="No such file"):
        read_run(tmp_path / "no.json")


def test_events_out_of_order_are_refused():
    late_first = msgspec.structs.replace(RUN, events=RUN.events[::-1])
    with pytest.raises(InputError, match="ticks in order"):
        decoded("r.json", encoded(late_first))


def test_a_fingerprint_sees_the_last_bit():
    row = np.linspace(0.0, 1.0, 50)
    other = row.copy()
    other[-1] = np.nextafter(1.0, 0.0)
    assert fingerprint(row) == fingerprint(row.copy())
    assert fingerprint(row) != fingerprint(other)
    assert len(fingerprint(row)) == 12


def test_without_ticks_a_run_is_as_long_as_its_scenario():
    assert Run(Scenario("s", seconds=0.0015)).length == 2
    assert Run(Scenario("s", seconds=2.0), ticks=7).length == 7
