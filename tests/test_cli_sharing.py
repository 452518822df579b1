"""run --code, report, replay and --preset, as other programs use them."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from momentum_lab.cli import main
from momentum_lab.control.presets import preset_named
from momentum_lab.errors import InputError
from momentum_lab.events import ApplyPush, LoggedEvent, SetGains
from momentum_lab.physics.push import Push
from momentum_lab.replay import replayed
from momentum_lab.run_file import Run, encoded, run_of
from momentum_lab.scenario import Scenario
from momentum_lab.share_code import to_code
from momentum_lab.trace import load_trace
from tests.test_cli import Output, chosen, refusal


@pytest.fixture(scope="module")
def shared() -> Run:
    """What somebody has done, and how it ended."""
    events = (
        LoggedEvent(10, SetGains({"linear_damping": 11.0})),
        LoggedEvent(20, ApplyPush(Push(force=40.0))),
    )
    return run_of(replayed(Run(Scenario("theirs", robot="g1", seconds=9.0), events, ticks=80))[0])


def test_a_code_runs_again_and_says_whether_the_bits_agree(shared, tmp_path: Path, capsys: Output) -> None:
    trace = tmp_path / "t.npz"
    assert main(["run", "--code", to_code(shared), "--json", "--out", str(trace)]) == 0
    output = capsys.readouterr()
    summary = json.loads(output.out)
    assert summary["seconds"] == pytest.approx(0.08)
    assert summary["gains"]["linear_damping"] == 11.0
    assert summary["impulse"] == pytest.approx(40.0 * 0.06)
    assert output.err == "momentum-lab: the same bits: the sample at 0.079 s\n"
    assert main(["replay", str(trace)]) == 0
    assert re.search(r"the same bits: 80 samples of \d+ quantities", capsys.readouterr().out)


def test_options_change_a_coded_run(shared, capsys: Output) -> None:
    words = ["run", "--code", to_code(shared), "--set", "friction=0.5", "--seconds", "0.05", "--json"]
    assert main(words) == 0
    output = capsys.readouterr()
    summary = json.loads(output.out)
    assert (summary["seconds"], summary["gains"]["friction"]) == (pytest.approx(0.05), 0.5)
    assert output.err == ""  # nothing to compare any more


def test_a_run_file_is_replayed(shared, tmp_path: Path, capsys: Output) -> None:
    path = tmp_path / "run.json"
    path.write_bytes(encoded(shared))
    assert main(["replay", str(path), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["agrees"], told["ticks"], told["robot"]) == (True, 80, "g1")
    data = json.loads(path.read_text())
    path.write_text(json.dumps({**data, "end": "000000000000"}))
    assert main(["replay", str(path)]) == 1
    assert "other bits: the sample at 0.079 s" in capsys.readouterr().out
    path.write_text(json.dumps({name: value for name, value in data.items() if name != "end"}))
    assert main(["replay", str(path)]) == 0
    assert "nothing to compare" in capsys.readouterr().out


def test_a_replay_says_what_was_done(shared, tmp_path: Path, capsys: Output) -> None:
    pushed = Run(
        Scenario("mine", robot="g1", pushes=(Push(force=9.0, start=0.0),)), shared.events[:1], ticks=20
    )
    for name, run in (("theirs.json", shared), ("mine.json", pushed)):
        (tmp_path / name).write_bytes(encoded(run))
        assert main(["replay", str(tmp_path / name)]) == 0
    output = capsys.readouterr().out
    assert "theirs, g1: 80 ticks, 0 pushes in its scenario, 2 events\n" in output
    assert "mine, g1: 20 ticks, 1 push in its scenario, 1 event\n" in output


def test_a_trace_that_was_changed_is_found_out(tmp_path: Path, capsys: Output) -> None:
    path = tmp_path / "t.npz"
    assert main(["run", "stand", "--robot", "g1", "--seconds", "0.02", "--json", "--out", str(path)]) == 0
    with np.load(path) as file:
        arrays = dict(file)
    arrays["torque"][12, 3] += 1e-12
    meta = json.loads(str(arrays["meta"]))
    arrays["meta"] = np.array(json.dumps({**meta, "versions": {**meta["versions"], "pin": "1.0"}}))
    np.savez(path, **arrays)
    capsys.readouterr()
    assert main(["replay", str(path)]) == 1
    output = capsys.readouterr().out
    assert "torque at 0.012 s is the first of them" in output
    assert re.search(r"recorded with pin 1\.0, replayed with 3\.", output)
    assert len(load_trace(path).columns["time"]) == 20


def test_a_report_is_written_whole(tmp_path: Path, capsys: Output) -> None:
    path = tmp_path / "report.html"
    assert main(["report", "push-forward", "--robot", "g1", "--seconds", "0.6", "--out", str(path)]) == 0
    assert capsys.readouterr().out == f"report: {path}\n"
    assert [entry.name for entry in tmp_path.iterdir()] == ["report.html"]
    assert path.read_text().rstrip().endswith("</html>")


def test_a_report_of_two_shows_both(tmp_path: Path, capsys: Output) -> None:
    path = tmp_path / "report.html"
    assert main(["report", "fig7", "--robot", "g1", "--seconds", "0.25", "--out", str(path)]) == 0
    assert capsys.readouterr().err == ""
    assert "<th>priority 0</th><th>priority 1</th>" in path.read_text()


@pytest.mark.parametrize("ending", [".html", ".viser", ".HTML"])
def test_a_recording_is_written_whole(ending: str, tmp_path: Path, capsys: Output) -> None:
    path = tmp_path / f"r{ending}"
    assert main(["record", "push-forward", "--robot", "g1", "--seconds", "0.1", "--out", str(path)]) == 0
    assert capsys.readouterr().out == f"recording: {path}\n"
    assert [entry.name for entry in tmp_path.iterdir()] == [path.name]
    assert path.read_bytes().startswith(b"<!doctype html>") == (ending != ".viser")


def test_a_recording_that_cannot_be_made_leaves_nothing(tmp_path: Path, monkeypatch, capsys: Output) -> None:
    def full(*_: object) -> None:
        raise InputError("recording", "no samples", "a run of at least one tick")

    monkeypatch.setattr("momentum_lab.app.recorder.html_file", full)
    words = f"record stand --robot g1 --seconds 0.05 --out {tmp_path / 'r.html'}"
    assert refusal(capsys, *words.split()).startswith("recording: got no samples")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("record stand", "--out: got nothing; allowed: the path of a file that ends in .html"),
        ("record stand --out nowhere/r.html", "--out: got nowhere/r.html; allowed: a file in a folder"),
        ("record stand --out r.avi", "--out: got r.avi; allowed: a file that ends in .html"),
        ("record stand --out r.mp4", "--out: got r.mp4; allowed: a file that ends in .html (plays in any"),
        ("record --out r.viser", "scenario: got nothing"),
        ("report stand", "--out: got nothing; allowed: the path of an .html file"),
        ("report stand --out nowhere/r.html", "--out: got nowhere/r.html; allowed: a file in a folder"),
        ("replay", "file: got nothing; allowed: a file that ends in .json, .toml, .npz"),
        ("replay nowhere.json", "run file: got nowhere.json; allowed: a file that can be read"),
        ("replay nowhere.npz", "recording: got nowhere.npz; allowed: a .npz file"),
        ("replay README.md", "run file: got README.md; allowed: a file that ends in .json, .toml, .npz"),
        ("run --code lab2-abc", "--code: got version 2; allowed: version 1, which this lab writes"),
        ("run --code nonsense", "--code: got nonsense; allowed: a code that this lab has made"),
        ("run stand --code lab1-abc", "--code: got lab1-abc; allowed: either a code or a scenario"),
        ("app --code lab1-abc", "--code: got lab1-abc...; allowed: a whole code"),
        ("app --scenario stand --code lab1-abc", "--code: got lab1-abc; allowed: either a code or"),
        ("run stand --preset nope", "--preset: got nope; allowed: one of soft, chapter-like, stiff"),
        ("app --preset nope", "--preset: got nope; allowed: one of soft, chapter-like, stiff"),
        ("list presets --controller magic", "--controller: got magic; allowed: one of "),
    ],
)
def test_bad_input_is_one_line(words: str, message: str, capsys: Output) -> None:
    assert refusal(capsys, *words.split()).startswith(message)


def test_a_preset_takes_the_place_of_the_scenarios_gains(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text('name = "mine"\n[gains]\nsafe_border = 0.01\n')
    stiff = preset_named("stiff", "computed-torque").gains
    assert chosen(str(path), "--preset", "stiff").gains == stiff
    assert chosen(str(path), "--preset", "stiff", "--set", "friction=0.5").gains == {**stiff, "friction": 0.5}
    soft = chosen("stand", "--controller", "slack-qp", "--preset", "soft").gains
    assert soft == preset_named("soft", "slack-qp").gains


def test_presets_are_listed(capsys: Output) -> None:
    assert main(["list", "presets", "--controller", "placo-wbc", "--json"]) == 0
    things = json.loads(capsys.readouterr().out)
    assert [thing["name"] for thing in things[:3]] == ["soft", "chapter-like", "stiff"]
    assert things[0]["gains"]["com_stiffness"] == 7.0
    assert main(["list", "presets"]) == 0
    assert "linear_damping 12" in capsys.readouterr().out
