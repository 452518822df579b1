"""The command line as other programs use it: exit codes, streams, names, and what is left on the disk."""

from __future__ import annotations

import functools
import io
import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from rich.console import Console
from threadpoolctl import threadpool_info

from momentum_lab.app.figures import AppMeasurement
from momentum_lab.cli import limit as limit_command
from momentum_lab.cli import listing, main, progress
from momentum_lab.cli import run as run_command
from momentum_lab.cli.arguments import parsed
from momentum_lab.cli.choices import chosen_scenario
from momentum_lab.control.planner import PLANNERS
from momentum_lab.control.registry import CONTROLLERS
from momentum_lab.errors import SimulationError
from momentum_lab.experiments.figures import FIGURES
from momentum_lab.experiments.push_limit import PushLimit
from momentum_lab.physics.mismatch import Mismatch
from momentum_lab.physics.push import Push
from momentum_lab.robot.catalog import robot_names
from momentum_lab.run_file import Run
from momentum_lab.scenario import Scenario, load_scenario, scenario_names
from momentum_lab.session import Session
from momentum_lab.trace import load_trace
from tests.app.test_figures import measurement
from tests.test_lesson import written
from tests.test_summary import KEYS

Output = pytest.CaptureFixture[str]
SHORT = ["--seconds", "0.02"]


def chosen(*words: str) -> Scenario:
    return chosen_scenario(parsed(["run", *words]))


def refusal(capsys: Output, *words: str) -> str:
    """What a command says about bad input; checks that it is one line and nothing else happened."""
    assert main(words) == 2
    output = capsys.readouterr()
    assert output.out == ""
    assert re.fullmatch(r"momentum-lab: [^\n]+: got [^\n]+; allowed: [^\n]+\n", output.err)
    return output.err.removeprefix("momentum-lab: ").rstrip("\n")


# Bad input

BAD_VALUES = [
    ("run stand --push 217N", "--push: got 217N; allowed: a number from 0 to 5000 (N)"),
    ("run stand --push nan", "--push: got nan; allowed: a number from 0 to 5000 (N)"),
    ("run stand --push inf", "--push: got inf; allowed: a number from 0 to 5000 (N)"),
    ("run stand --push -inf", "--push: got -inf; allowed: a number from 0 to 5000 (N)"),
    ("run stand --push -1", "--push: got -1; allowed: a number from 0 to 5000 (N)"),
    ("run stand --push -1e3", "--push: got -1e3; allowed: a number from 0 to 5000 (N)"),
    ("run stand --push 5001", "--push: got 5001; allowed: a number from 0 to 5000 (N)"),
    ("run stand --push 1_000", "--push: got 1_000; allowed: a number from 0 to 5000 (N)"),
    ("run stand --push", "--push: got nothing; allowed: a value after it"),
    ("run stand --push --json", "--push: got nothing; allowed: a value after it"),
    ("run stand --push-duration 0", "--push-duration: got 0; allowed: a number above 0, at most 10 (s)"),
    (
        "run stand --push-duration 100ms",
        "--push-duration: got 100ms; allowed: a number above 0, at most 10 (s)",
    ),
    ("run stand --push-duration nan", "--push-duration: got nan; allowed: a number above 0, at most 10 (s)"),
    (
        "run stand --push-direction left",
        "--push-direction: got left; allowed: a number from -360 to 360 (degrees)",
    ),
    (
        "run stand --push-direction 361",
        "--push-direction: got 361; allowed: a number from -360 to 360 (degrees)",
    ),
    ("run stand --push-height -0.1", "--push-height: got -0.1; allowed: a number above 0, at most 3 (m)"),
    (
        "run stand --push-height 1",
        "--push-height: got 1; allowed: together with --push N, because stand has no push",
    ),
    (
        "run stand --priority 1.1",
        "--priority: got 1.1; allowed: a number from 0 to 1 (0 keeps linear momentum, 1 angular momentum)",
    ),
    ("run stand --seconds 0", "--seconds: got 0; allowed: a number from 0.001 to 3600 (s)"),
    ("run stand --seconds inf", "--seconds: got inf; allowed: a number from 0.001 to 3600 (s)"),
    ("run stand --seed -1", "--seed: got -1; allowed: a whole number from 0 to 4294967295"),
    ("run stand --seed 1.5", "--seed: got 1.5; allowed: a whole number from 0 to 4294967295"),
    (
        "run stand --controlled up",
        "--controlled: got up; allowed: all, linear, angular, none, lx, ly, lz, kx, ky, kz, several joined by +",
    ),
    ("run stand --engine bullet", "--engine: got bullet; allowed: one of pinocchio, mujoco"),
    (
        "limit --direction up",
        "--direction: got up; allowed: forward, left, backward, right, all, or a number from -360 to 360 (degrees)",
    ),
    (
        "limit fig7 --push-duration 4",
        "--push-duration: got 4; allowed: less than 2.3 s, when fig7 ends",
    ),
    ("run stand --controller magic", f"--controller: got magic; allowed: one of {', '.join(CONTROLLERS)}"),
    (
        "run stand --set linear_damping",
        "--set: got linear_damping; allowed: GAIN=VALUE, such as linear_damping=8",
    ),
    ("run stand --set =8", "--set: got =8; allowed: GAIN=VALUE, such as linear_damping=8"),
    (
        "run stand --mismatch mass_error",
        "--mismatch: got mass_error; allowed: NAME=VALUE, such as mass_error=0.1",
    ),
    (
        "run stand --mismatch mass_error=0.31",
        "--mismatch mass_error: got 0.31; allowed: a number from -0.3 to 0.3",
    ),
    (
        "run stand --mismatch torque_delay_ms=nan",
        "--mismatch torque_delay_ms: got nan; allowed: a number from 0 to 5 ms",
    ),
    (
        "run stand --mismatch mass=0.1",
        "--mismatch: got mass; allowed: one of mass_error, joint_friction, torque_delay_ms, encoder_noise, "
        "imu_noise, torque_scale",
    ),
    (
        "run stand --set linear_damping=8/s",
        "--set linear_damping: got 8/s; allowed: a number from 0 to 60 1/s",
    ),
    (
        "run stand --set linear_damping=nan",
        "--set linear_damping: got nan; allowed: a number from 0 to 60 1/s",
    ),
    (
        "run stand --set linear_damping=1e9",
        "--set linear_damping: got 1e9; allowed: a number from 0 to 60 1/s",
    ),
    ("run stand --json=yes", "--json: got yes; allowed: the option alone, without a value"),
    ("app --port 65536", "--port: got 65536; allowed: a whole number from 0 to 65535"),
    ("app --port http", "--port: got http; allowed: a whole number from 0 to 65535"),
    ("--port -1", "--port: got -1; allowed: a whole number from 0 to 65535"),
    ("bench --seconds 0", "--seconds: got 0; allowed: a number from 1 to 600 (s)"),
    (
        "list",
        "list: got nothing; allowed: robots, controllers, planners, motions, scenarios, lessons, figures, gains, "
        "presets",
    ),
    (
        "list cats",
        "list: got cats; allowed: robots, controllers, planners, motions, scenarios, lessons, figures, gains, "
        "presets",
    ),
    ("list gains --controller magic", f"--controller: got magic; allowed: one of {', '.join(CONTROLLERS)}"),
    (
        "fly",
        "command: got fly; allowed: app, run, limit, report, record, replay, lesson, figure, list, equations, "
        "robot-check, bench",
    ),
]


@pytest.mark.parametrize(("words", "message"), BAD_VALUES, ids=[words for words, _ in BAD_VALUES])
def test_bad_value_is_one_line_that_names_it(words: str, message: str, capsys: Output) -> None:
    assert refusal(capsys, *words.split()) == message


@pytest.mark.parametrize(
    ("words", "start"),
    [
        ("run", "scenario: got nothing; allowed: one of arm-swing, board, boat, bus, "),
        ("run nope", "scenario: got nope; allowed: one of arm-swing, board, boat, bus, "),
        (
            "app --scenario nope",
            "--scenario: got nope; allowed: one of arm-swing, board, boat, bus, ",
        ),
        ("app --robot nope", "--robot: got nope; allowed: one of g1, human, icub, "),
        ("equations --robot nope", "--robot: got nope; allowed: one of g1, human, icub, "),
        ("run stand --robot nope", "--robot: got nope; allowed: one of g1, human, icub, "),
        ("run stand --robot /", "--robot: got /; allowed: one of g1, human, icub, "),
        ("run stand --set magic=1", "--set: got magic; allowed: one of linear_damping, "),
        ("run stand --pusch 3", "argument: got --pusch; allowed: run SCENARIO; options: --help, --robot, "),
        ("run stand --see 3", "argument: got --see; allowed: run SCENARIO; options: --help, --robot, "),
        ("run stand twice", "argument: got twice; allowed: run SCENARIO; options: --help, --robot, "),
    ],
)
def test_unknown_name_lists_the_known_ones(words: str, start: str, capsys: Output) -> None:
    assert refusal(capsys, *words.split()).startswith(start)


@pytest.mark.parametrize(
    ("content", "end"),
    [
        ("garbage [", r"robot\.toml; allowed: a TOML file that describes a robot \(.*\)"),
        ('name = "x"', r"robot\.toml; allowed: a TOML file that describes a robot \(.*\)"),
    ],
)
def test_foreign_robot_file_is_refused(content: str, end: str, tmp_path: Path, capsys: Output) -> None:
    path = tmp_path / "robot.toml"
    path.write_text(content)
    assert re.search(end, refusal(capsys, "run", "stand", "--robot", str(path)))


def test_fault_in_a_scenario_file_is_named(tmp_path: Path, capsys: Output) -> None:
    path = tmp_path / "mine.toml"
    for line, message in (
        ("seconds = -1", f"seconds in {path}: got -1; allowed: number >= 0.001"),
        ('robot = "r2d2"', "robot: got r2d2; allowed: one of g1, "),
        ('stance = ["third"]', "stance: got third; allowed: feet among left, right"),
        ("gains = { magic = 1.0 }", "gain: got magic; allowed: one of linear_damping, "),
        ("pushes = [{ duration = 0.1 }]", "push: got force None, velocity_change None; allowed: either "),
        ('pushes = [{ force = 1, body = "tail" }]', "body: got tail; allowed: one of "),
    ):
        path.write_text(f'name = "mine"\n{line}\n')
        assert refusal(capsys, "run", str(path)).startswith(message)


@pytest.mark.parametrize("name", ["nowhere/trace.npz", ".", "x" * 300])
def test_trace_that_cannot_be_written_stops_the_run_before_it_starts(
    name: str, tmp_path: Path, capsys: Output, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(run_command, "run_headless", None)
    assert refusal(capsys, "run", "stand", "--out", str(tmp_path / name)).startswith(f"--out: got {tmp_path}")
    assert list(tmp_path.iterdir()) == []


def test_name_too_long_for_a_file_is_one_line_too(capsys: Output) -> None:
    assert refusal(capsys, "run", "stand", "--robot", "x" * 300)


# What the options mean


def test_without_options_the_scenario_is_as_it_ships() -> None:
    for name in scenario_names():
        assert chosen(name) == load_scenario(name)


def test_options_change_their_fields() -> None:
    words = "stand --robot g1 --controller computed-torque --priority 0.5 --seconds 2 --seed 9"
    scenario = chosen(*f"{words} --engine pinocchio --set linear_damping=9 --set safe_border=0.01".split())
    gains = {"linear_damping": 9.0, "safe_border": 0.01}
    assert scenario == Scenario(
        "stand", load_scenario("stand").title, "g1", priority=0.5, seconds=2.0, seed=9, gains=gains
    )


def test_mismatch_changes_what_it_names() -> None:
    words = "stand --mismatch mass_error=-0.1 --mismatch torque_delay_ms=2"
    assert chosen(*words.split()).mismatch == Mismatch(mass_error=-0.1, torque_delay_ms=2.0)


def test_push_replaces_the_scenarios_pushes() -> None:
    assert chosen("push-lateral", "--push", "50").pushes == (Push(force=50.0, duration=0.1, start=0.5),)
    assert chosen("one-leg", "--push", "50").pushes == (Push(force=50.0, start=1.0),)
    details = ("--push-duration", "0.2", "--push-direction", "-90", "--push-height", "1.2")
    expected = Push(force=80.0, duration=0.2, direction_deg=-90.0, height=1.2, start=0.5)
    assert chosen("stand", "--push", "80", *details).pushes == (expected,)


def test_push_of_zero_is_no_push() -> None:
    assert chosen("push-forward", "--push", "0").pushes == ()
    assert chosen("stand", "--push", "0", "--push-duration", "1").pushes == ()


def test_details_without_a_force_change_the_scenarios_own_pushes() -> None:
    (own,) = load_scenario("push-lateral").pushes
    (push,) = chosen("push-lateral", "--push-direction", "45", "--push-duration", "0.3").pushes
    assert (push.direction_deg, push.duration) == (45.0, 0.3)
    assert (push.velocity_change, push.start, push.height) == (own.velocity_change, own.start, own.height)


def test_gains_of_a_scenario_stay_unless_set(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text('name = "mine"\n[gains]\nlinear_damping = 7.0\nsafe_border = 0.01\n')
    assert chosen(str(path), "--set", "linear_damping=9").gains == {
        "linear_damping": 9.0,
        "safe_border": 0.01,
    }


# run


def test_json_is_one_object_with_every_key(capsys: Output) -> None:
    assert main(["run", "stand", "--robot", "g1", "--seconds", "0.05", "--json"]) == 0
    output = capsys.readouterr()
    assert output.err == ""
    assert output.out.count("\n") == 1
    summary = json.loads(output.out)
    assert {key: type(summary[key]) in kinds for key, kinds in KEYS.items()} == dict.fromkeys(KEYS, True)
    assert (summary["robot"], summary["scenario"], summary["fell"]) == ("g1", "stand", False)
    assert summary["seconds"] == pytest.approx(0.05, abs=1e-12)


def test_a_second_robot_is_in_the_summary_of_the_first(capsys: Output, tmp_path: Path) -> None:
    out = str(tmp_path / "trace.npz")
    assert main(["run", "fig7", "--seconds", "0.4", "--json", "--out", out]) == 0
    output = capsys.readouterr()
    summary = json.loads(output.out)
    assert (summary["priority"], summary["beside"]["priority"]) == (0.0, 1.0)
    assert summary["beside"]["peak_angular_momentum"] < summary["peak_angular_momentum"]
    assert summary["beside"]["beside"] is None
    trace = load_trace(Path(out))
    assert trace.second.keys() == trace.columns.keys()
    lowest = {
        name: column["priority"].min()
        for name, column in (("first", trace.columns), ("second", trace.second))
    }
    assert lowest == {"first": 0.0, "second": 1.0}
    assert main(["replay", out]) == 0  # the first robot's bits, as before
    assert "the same bits: 400 samples" in capsys.readouterr().out
    assert main(["run", "fig7", "--seconds", "0.02"]) == 0
    assert "priority" in capsys.readouterr().out


def test_without_json_the_result_is_for_people(capsys: Output, tmp_path: Path) -> None:
    path = tmp_path / "[trace]"
    assert main(["run", "push-forward", *SHORT, "--out", str(path)]) == 0
    output = capsys.readouterr()
    assert "stands still after 0.02 s" in output.out
    assert "talos" in output.out
    assert output.out.endswith(f"\ntrace: {path}\n")
    assert output.err == "momentum-lab: the push at 0.5 s comes after the end of the run at 0.02 s\n"


def test_a_fall_is_a_result_and_not_an_error(capsys: Output, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("momentum_lab.fall._FALLEN_HEIGHT", 1.1)
    assert main(["run", "stand", *SHORT]) == 0
    assert "fell at 0.000 s" in capsys.readouterr().out


def test_two_processes_record_the_same_bits(tmp_path: Path, capsys: Output) -> None:
    words = [
        "run",
        "stand",
        "--push",
        "200",
        "--push-direction",
        "30",
        "--seconds",
        "0.6",
        "--seed",
        "3",
        "--json",
    ]
    assert main([*words, "--out", str(tmp_path / "here.npz")]) == 0
    here = json.loads(capsys.readouterr().out)
    there = process(*words, "--out", str(tmp_path / "there.npz"))
    assert (there.returncode, there.stderr) == (0, "")
    first, second = load_trace(tmp_path / "here.npz"), load_trace(tmp_path / "there.npz")
    assert first.columns.keys() == second.columns.keys()
    for name, column in first.columns.items():
        assert np.array_equal(column, second.columns[name], equal_nan=True), name
    assert first.meta == second.meta
    summary = json.loads(there.stdout)
    clock = {"real_time_factor", "tick_us_p50", "tick_us_p99"}
    assert {key for key in here if here[key] != summary[key]} <= clock


def test_trace_is_written_where_it_was_asked_for(tmp_path: Path, capsys: Output) -> None:
    assert main(["run", "stand", *SHORT, "--json", "--out", str(tmp_path / "trace")]) == 0
    assert json.loads(capsys.readouterr().out)["seconds"] == pytest.approx(0.02)
    assert [path.name for path in tmp_path.iterdir()] == ["trace"]
    trace = load_trace(tmp_path / "trace")
    assert len(trace.columns["time"]) == 20
    assert trace.meta["scenario"]["name"] == "stand"


def breaking_after(ticks: int, what: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """Sessions do `what` before the tick after so many ticks."""
    tick = Session.tick

    def faulty(session: Session) -> object:
        if session.ticks == ticks:
            what()
        return tick(session)

    monkeypatch.setattr(Session, "tick", faulty)


def broken() -> None:
    raise SimulationError("the state is not finite after 0.010 s")


def test_simulation_that_breaks_down_is_told_saved_and_summarized(
    tmp_path: Path, capsys: Output, monkeypatch: pytest.MonkeyPatch
) -> None:
    breaking_after(10, broken, monkeypatch)
    assert main(["run", "stand", *SHORT, "--json", "--out", str(tmp_path / "trace.npz")]) == 1
    output = capsys.readouterr()
    assert output.err == "momentum-lab: the state is not finite after 0.010 s\n"
    summary = json.loads(output.out)
    assert (summary["fell"], summary["settled"], summary["fall_time"]) == (True, False, pytest.approx(0.01))
    assert summary["error"] == "the state is not finite after 0.010 s"
    assert len(load_trace(tmp_path / "trace.npz").columns["time"]) == 10


def test_simulation_that_breaks_down_at_once_leaves_nothing(
    tmp_path: Path, capsys: Output, monkeypatch: pytest.MonkeyPatch
) -> None:
    breaking_after(0, broken, monkeypatch)
    assert main(["run", "stand", "--json", "--out", str(tmp_path / "trace.npz")]) == 1
    assert capsys.readouterr() == ("", "momentum-lab: the state is not finite after 0.010 s\n")
    assert list(tmp_path.iterdir()) == []


def test_ctrl_c_saves_what_there_is(tmp_path: Path, capsys: Output, monkeypatch: pytest.MonkeyPatch) -> None:
    breaking_after(10, lambda: os.kill(os.getpid(), signal.SIGINT), monkeypatch)
    before = signal.getsignal(signal.SIGINT)
    assert main(["run", "stand", "--json", "--out", str(tmp_path / "trace.npz")]) == 130
    assert capsys.readouterr() == ("", "momentum-lab: stopped\n")
    assert len(load_trace(tmp_path / "trace.npz").columns["time"]) == 11
    assert signal.getsignal(signal.SIGINT) is before


def test_recording_larger_than_memory_is_one_line(capsys: Output, monkeypatch: pytest.MonkeyPatch) -> None:
    def greedy(_run: Run) -> None:
        raise MemoryError

    monkeypatch.setattr(run_command, "prepared", greedy)
    message = refusal(capsys, "run", "stand", "--seconds", "3600")
    assert message == "--seconds: got 3600.0; allowed: a run whose recording fits into memory"


def test_mujoco_answers_and_says_so_in_summary_and_trace(tmp_path: Path, capsys: Output) -> None:
    path = tmp_path / "trace.npz"
    assert main(["run", "stand", *SHORT, "--engine", "mujoco", "--json", "--out", str(path)]) == 0
    assert json.loads(capsys.readouterr().out)["engine"] == "mujoco"
    meta = load_trace(path).meta
    assert meta["scenario"]["engine"] == "mujoco"
    assert meta["versions"]["mujoco"][0].isdigit()
    assert main(["run", "stand", *SHORT, "--engine", "mujoco"]) == 0
    assert re.search(r"engine\W+mujoco", capsys.readouterr().out)
    assert main(["run", "stand", *SHORT]) == 0
    assert "engine" not in capsys.readouterr().out  # the usual one goes without saying


@pytest.mark.parametrize("command", ["run stand", "limit"])
def test_without_mujoco_one_line_says_what_to_install(
    command: str, capsys: Output, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "mujoco", None)
    assert refusal(capsys, *command.split(), "--engine", "mujoco") == (
        "--engine: got mujoco, which is not installed; "
        "allowed: pinocchio, or first: pip install 'momentum-lab[mujoco]'"
    )


# limit


@pytest.fixture
def searched(monkeypatch: pytest.MonkeyPatch) -> list[tuple[Scenario, Push]]:
    """The searches that were asked for, each with a made-up answer."""
    asked: list[tuple[Scenario, Push]] = []

    def search(scenario: Scenario, robot: Any, push: Push, proceed: Callable[[float], bool]) -> PushLimit:
        assert proceed(0.5)
        asked.append((scenario, push))
        return PushLimit(
            direction_deg=push.direction_deg,
            force=100.0,
            impulse=100.0 * push.duration,
            impulse_ratio=1.25,
            beyond=101.0,
            why="fell at 1.00 s: it was pushed",
            signs=("left foot off the ground at 0.70 s",),
            trials=9,
        )

    monkeypatch.setattr(limit_command, "push_limit", search)
    return asked


@pytest.mark.parametrize(
    ("words", "degrees"),
    [
        ("", [0.0]),
        ("--direction left", [90.0]),
        ("--direction backward", [180.0]),
        ("--direction right", [270.0]),
        ("--direction -30", [-30.0]),
        ("--direction all", [0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0]),
    ],
)
def test_limit_is_searched_in_the_direction_that_was_asked(
    words: str, degrees: list[float], searched: list[tuple[Scenario, Push]], capsys: Output
) -> None:
    assert main(["limit", "--robot", "g1", *words.split(), "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert [push.direction_deg for _, push in searched] == degrees
    assert [found["direction_deg"] for found in answer["limits"]] == degrees
    assert (answer["robot"], answer["engine"], answer["push_duration"]) == ("g1", "pinocchio", 0.1)
    assert answer["limits"][0]["force"] == 100.0
    assert answer["limits"][0]["impulse_ratio"] == 1.25


def test_options_of_limit_reach_the_search(searched: list[tuple[Scenario, Push]], capsys: Output) -> None:
    words = "limit fig7 --robot g1 --controller slack-qp --engine mujoco --push-duration 0.2 --priority 0.5"
    assert main([*words.split(), "--seconds", "3"]) == 0
    ((scenario, push),) = searched
    assert (scenario.name, scenario.robot, scenario.controller) == ("fig7", "g1", "slack-qp")
    assert (scenario.engine, scenario.priority, scenario.seconds) == ("mujoco", 0.5, 3.0)
    assert (push.duration, push.start) == (0.2, load_scenario("fig7").pushes[0].start)
    printed = " ".join(capsys.readouterr().out.split())
    for text in ("0 forward", "100 N", "20.0 N s", "1.25", "101 N:", "left foot off"):
        assert text in printed


def test_ctrl_c_ends_a_search(
    searched: list[tuple[Scenario, Push]], monkeypatch: pytest.MonkeyPatch, capsys: Output
) -> None:
    def stopped(*_: Any) -> PushLimit:
        raise KeyboardInterrupt

    monkeypatch.setattr(limit_command, "push_limit", stopped)
    assert main(["limit", "--robot", "g1"]) == 130
    assert capsys.readouterr().out == ""


# list


@pytest.mark.parametrize(
    ("kind", "names"),
    [
        ("robots", robot_names()),
        ("scenarios", scenario_names()),
        ("controllers", list(CONTROLLERS)),
        ("planners", list(PLANNERS)),
        ("figures", list(FIGURES)),
    ],
)
def test_list_gives_the_names(kind: str, names: list[str], capsys: Output) -> None:
    assert main(["list", kind, "--json"]) == 0
    things = json.loads(capsys.readouterr().out)
    assert [thing["name"] for thing in things] == names
    assert all(thing["title"] for thing in things)
    assert main(["list", kind]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == ["name", *names]


def test_list_of_gains_says_unit_range_default_and_help(capsys: Output) -> None:
    assert main(["list", "gains", "--json"]) == 0
    gains = {gain.pop("name"): gain for gain in json.loads(capsys.readouterr().out)}
    damping = gains["linear_damping"]
    assert (damping["default"], damping["unit"], damping["range"]) == (8.0, "1/s", [0.0, 60.0])
    for gain in gains.values():
        low, high = gain["range"]
        assert low <= gain["default"] <= high
        assert gain["unit"]
        assert gain["help"].endswith(".")
    assert main(["list", "gains"]) == 0
    table = capsys.readouterr().out
    assert re.search(r"^linear_damping +8 +1/s +0 to 60 +Gamma_21: ", table, re.MULTILINE)


def test_list_of_lessons_is_in_their_order(
    tmp_path: Path, capsys: Output, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(listing, "LESSONS", tmp_path / "none")
    assert main(["list", "lessons", "--json"]) == 0
    assert capsys.readouterr().out == "[]\n"
    written(tmp_path, ("Leaning in", "Last")).rename(tmp_path / "02_last.py")
    written(tmp_path, ("You push a robot from behind. Where", "Where"))
    monkeypatch.setattr(listing, "LESSONS", tmp_path)
    assert main(["list", "lessons", "--json"]) == 0
    lessons = [
        {"name": "01_leaning_in", "number": 1, "title": "Leaning in", "question": "Where does it stop?"},
        {
            "name": "02_last",
            "number": 2,
            "title": "Last",
            "question": "You push a robot from behind. Where does it stop?",
        },
    ]
    assert json.loads(capsys.readouterr().out) == lessons


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("STEPS = (", "STEPS = = ("), "got STEPS = = ("),
        (("CLAIMS = (", "CLAIMED = ("), "got no CLAIMS"),
        (('"seconds": 2.0', '"gains": {"linear_dampng": 8.0}'), "got gain linear_dampng"),
    ],
)
def test_lesson_with_an_error_is_named_and_the_others_are_listed(
    tmp_path: Path, capsys: Output, change: tuple[str, str], words: str
) -> None:
    written(tmp_path).rename(tmp_path / "02_sound.py")
    path = written(tmp_path, change)
    assert main(["list", "lessons", "--lessons", str(tmp_path), "--json"]) == 2
    said = capsys.readouterr()
    assert [lesson["name"] for lesson in json.loads(said.out)] == ["02_sound"]
    (line,) = said.err.splitlines()
    assert re.match(rf"momentum-lab: {re.escape(str(path))}:\d+: {re.escape(words)}", line)


# app and bench


@pytest.fixture
def served(monkeypatch: pytest.MonkeyPatch) -> list[dict[str, Any]]:
    """Calls of the app's server, which is not started."""
    calls: list[dict[str, Any]] = []

    def serve(scenario: Scenario, **settings: Any) -> None:
        calls.append({"scenario": scenario, **settings})

    monkeypatch.setitem(sys.modules, "momentum_lab.app.server", SimpleNamespace(serve=serve))
    return calls


@pytest.mark.parametrize("words", [[], ["app"]])
def test_without_arguments_the_app_is_served_on_this_machine(words: list[str], served: list[Any]) -> None:
    assert main(words) == 0
    expected = {
        "scenario": Run(load_scenario("stand")),
        "host": "127.0.0.1",
        "port": 8080,
        "open_browser": True,
        "demo": None,
    }
    assert served == [expected]


def test_options_of_the_app_reach_it(served: list[Any]) -> None:
    words = [
        "--scenario",
        "push-lateral",
        "--robot",
        "g1",
        "--host",
        "0.0.0.0",
        "--port",
        "0",
        "--no-browser",
    ]
    assert main(words) == main(["app", *words]) == 0
    first, second = served
    assert first == second
    assert (first["scenario"].scenario.name, first["scenario"].scenario.robot) == ("push-lateral", "g1")
    assert (first["host"], first["port"], first["open_browser"]) == ("0.0.0.0", 0, False)


@pytest.mark.parametrize(("words", "patience"), [(["--demo"], 120.0), (["--demo", "45"], 45.0)])
def test_lab_plays_by_itself_when_asked(words: list[str], patience: float, served: list[Any]) -> None:
    assert main(["app", *words]) == 0
    assert served[0]["demo"] == patience


def test_wait_before_the_demonstration_has_a_range(served: list[Any], capsys: Output) -> None:
    assert "5 to 600" in refusal(capsys, "app", "--demo", "1")
    assert served == []


def test_app_is_not_served_for_a_robot_that_cannot_stand(
    served: list[Any], tmp_path: Path, capsys: Output
) -> None:
    (tmp_path / "broken.toml").write_text("")
    refusal(capsys, "app", "--robot", str(tmp_path / "broken.toml"))
    assert served == []


@pytest.fixture
def measured_for(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """For how many seconds the app has been measured, without measuring it."""
    asked: list[float] = []

    def measure_app(seconds: float, report: Callable[[float], None]) -> AppMeasurement:
        asked.append(seconds)
        report(1.0)
        return measurement(drawings_per_second=29.0, memory_growth=None)

    monkeypatch.setitem(sys.modules, "momentum_lab.app.measure", SimpleNamespace(measure_app=measure_app))
    return asked


def test_bench_of_the_app_prints_what_was_measured(capsys: Output, measured_for: list[float]) -> None:
    assert main(["bench", "--app", "--seconds", "3", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["app"]["drawings_per_second"] == 29.0
    assert document["app"]["memory_growth"] is None
    assert {figure["name"]: figure["reached"] for figure in document["figures"]}[
        "drawings per second"
    ] is False
    assert main(["bench", "--app"]) == 0
    table = capsys.readouterr().out
    assert re.search(r"drawings per second\W+29.0\W+at least 30\W+NO", table)
    assert re.search(r"real-time factor\W+1.000\W+1.00 ± 0.01\W+yes", table)
    assert main(["bench", "--app", "--minutes", "10"]) == 0
    assert measured_for == [3.0, 20.0, 600.0]


def test_bench_takes_its_time_once(capsys: Output, measured_for: list[float]) -> None:
    line = refusal(capsys, "bench", "--app", "--minutes", "1", "--seconds", "3")
    assert line == "--minutes: got 1; allowed: either --minutes or --seconds"
    assert "from 0.1 to 60" in refusal(capsys, "bench", "--app", "--minutes", "0")
    assert measured_for == []


# All commands


def test_blas_has_one_thread_inside_a_command(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[int] = []

    def spy(_args: object) -> int:
        seen.extend(library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas")
        return 0

    monkeypatch.setattr(listing, "list_things", spy)
    assert main(["list", "robots"]) == 0
    assert seen
    assert set(seen) == {1}


def test_help_and_version_are_no_errors(capsys: Output) -> None:
    for words in (["--help"], ["-h"], ["run", "--help"], ["--version"]):
        with pytest.raises(SystemExit) as caught:
            main(words)
        assert caught.value.code == 0
    output = capsys.readouterr()
    assert output.err == ""
    assert "--push-direction DEG" in output.out
    assert output.out.endswith("momentum-lab 0.1.0\n")


def test_progress_is_drawn_on_a_terminal_and_wiped_at_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = io.StringIO()
    terminal = functools.partial(Console, file=screen, force_terminal=True, width=80)
    monkeypatch.setattr(progress, "Console", lambda stderr: terminal())
    monkeypatch.setattr(progress, "_PATIENCE", 0.0)
    with progress.progress("push-forward") as report:
        report(0.42)
    assert "push-forward" in screen.getvalue()
    assert "42%" in screen.getvalue()
    assert screen.getvalue().endswith("\x1b[2K")


def test_progress_is_silent_when_no_one_watches_and_when_there_is_no_wait(
    monkeypatch: pytest.MonkeyPatch, capsys: Output
) -> None:
    screen = io.StringIO()
    monkeypatch.setattr(progress, "_PATIENCE", 0.0)
    with progress.progress("piped") as report:
        report(0.5)
    assert capsys.readouterr() == ("", "")
    monkeypatch.setattr(progress, "_PATIENCE", 60.0)
    monkeypatch.setattr(progress, "Console", lambda stderr: Console(file=screen, force_terminal=True))
    with progress.progress("quick") as report:
        report(0.5)
    assert "quick" not in screen.getvalue()


# The real process


def process(
    *words: str, program: tuple[str, ...] = ("-m", "momentum_lab")
) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, *program, *words], capture_output=True, text=True, timeout=60, check=False
    )


def test_installed_command_and_module_are_the_same() -> None:
    script = Path(sys.executable).with_name("momentum-lab")
    installed = subprocess.run(
        [script, "list", "robots", "--json"], capture_output=True, text=True, check=False
    )
    module = process("list", "robots", "--json")
    assert (installed.returncode, installed.stdout, installed.stderr) == (0, module.stdout, "")
    bad = process("run", "stand", "--push", "217N")
    assert (bad.returncode, bad.stdout) == (2, "")
    assert bad.stderr == "momentum-lab: --push: got 217N; allowed: a number from 0 to 5000 (N)\n"


def test_headless_run_loads_nothing_of_the_app() -> None:
    code = (
        "import sys; from momentum_lab.cli import main; assert main(sys.argv[1:]) == 0; "
        "print([name for name in sys.modules if name.split('.')[0] == 'viser' or 'momentum_lab.app' in name])"
    )
    result = process("run", "stand", *SHORT, "--json", program=("-c", code))
    assert (result.returncode, result.stderr) == (0, "")
    assert result.stdout.splitlines()[1] == "[]"


def test_reader_that_leaves_early_causes_no_traceback() -> None:
    words = [sys.executable, "-m", "momentum_lab", "list", "gains"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as child:
        assert child.stdout is not None
        assert child.stderr is not None
        child.stdout.close()
        assert child.stderr.read() == ""
    assert child.returncode == 1
