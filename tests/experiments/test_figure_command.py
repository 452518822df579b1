from __future__ import annotations

import json
import os
import signal
from pathlib import Path

import pytest

from momentum_lab.cli import main
from momentum_lab.experiments.figures import FIGURES
from tests.test_cli import breaking_after, broken, refusal

Output = pytest.CaptureFixture[str]


@pytest.mark.parametrize(
    ("words", "start"),
    [
        ("figure", "figure: got nothing; allowed: one of arm-swing, "),
        ("figure fig99 --out x", "figure: got fig99; allowed: one of arm-swing, "),
        ("figure fig8", "--out: got nothing; allowed: a folder for the three files"),
        ("figure fig8 --out", "--out: got nothing; allowed: a value after it"),
        ("figure fig8 --out /dev/null/x", "--out: got /dev/null/x; allowed: a folder that can be written ("),
        ("figure fig8 --out /proc/none", "--out: got /proc/none; allowed: a folder that can be written ("),
        (
            "figure fig8 --push 3",
            "argument: got --push; allowed: figure NAME --out DIR; options: --help, --robot",
        ),
    ],
)
def test_bad_input_is_one_line(words: str, start: str, capsys: Output) -> None:
    assert refusal(capsys, *words.split()).startswith(start)


def test_unknown_robot_is_one_line_and_leaves_no_folder(tmp_path: Path, capsys: Output) -> None:
    out = tmp_path / "out"
    message = refusal(capsys, "figure", "fig8", "--robot", "nope", "--out", str(out))
    assert message.startswith("--robot: got nope; allowed: one of g1, ")
    assert not out.exists()


def test_a_figure_is_written_with_its_claims(tmp_path: Path, capsys: Output) -> None:
    assert main(["figure", "fig4", "--robot", "g1", "--out", str(tmp_path)]) == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["fig4.csv", "fig4.json", "fig4.png"]
    report = json.loads((tmp_path / "fig4.json").read_text())
    assert (report["figure"], report["robot"], report["holds"]) == ("fig4", "g1", True)
    for claim in report["claims"]:
        assert set(claim) == {"text", "measured", "allowed", "holds"}
    assert capsys.readouterr().out.splitlines()[-1] == str(tmp_path / "fig4.json")


@pytest.mark.parametrize("name", FIGURES)
def test_a_simulation_that_breaks_down_is_a_claim_that_fails(
    name: str, tmp_path: Path, capsys: Output, monkeypatch: pytest.MonkeyPatch
) -> None:
    breaking_after(330, broken, monkeypatch)
    assert main(["figure", name, "--out", str(tmp_path)]) == 1
    report = json.loads((tmp_path / f"{name}.json").read_text())
    assert not report["holds"]
    assert report["claims"][0]["measured"] == "the state is not finite after 0.010 s"
    assert "FAILS" in capsys.readouterr().out


def test_ctrl_c_writes_nothing(tmp_path: Path, capsys: Output, monkeypatch: pytest.MonkeyPatch) -> None:
    breaking_after(10, lambda: os.kill(os.getpid(), signal.SIGINT), monkeypatch)
    assert main(["figure", "fig8", "--out", str(tmp_path)]) == 130
    assert list(tmp_path.iterdir()) == []
    assert capsys.readouterr().err == "momentum-lab: stopped\n"
