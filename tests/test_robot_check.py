"""The command robot-check as a user types it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from momentum_lab.cli import main
from momentum_lab.robot.catalog import load_spec
from tests.robot.conftest import WriteBiped, write_biped
from tests.robot.proposal.test_proposal import with_feet
from tests.test_cli import refusal

__all__ = ["write_biped"]

Output = pytest.CaptureFixture[str]
FEET = "left_ankle_roll_link,right_ankle_roll_link"


def test_a_urdf_becomes_a_file_that_the_lab_reads_and_the_robot_stands(
    write_biped: WriteBiped, tmp_path: Path, capsys: Output
) -> None:
    urdf, out = write_biped(urdf=with_feet()).with_suffix(".urdf"), tmp_path / "mine.toml"
    assert main(["robot-check", str(urdf), "--soles", FEET, "--out", str(out)]) == 0
    shown = capsys.readouterr().out
    assert "what to look at" in shown
    assert shown.count("stands still") == 5
    assert load_spec(str(out)).feet["left"].frame == "left_ankle_roll_link_sole"
    assert "\n# doubtful: the left frame is 50 mm above the sole: left_ankle_roll_link_sole is added\n" in (
        out.read_text()
    )


@pytest.mark.parametrize("form", ["table", "json"])
def test_a_robot_that_cannot_stand_is_explained(write_biped: WriteBiped, capsys: Output, form: str) -> None:
    path = write_biped(spec=(("foot_distance = 0.2", "foot_distance = 2.5"),))
    assert main(["robot-check", str(path), *(["--json"] if form == "json" else [])]) == 1
    said = capsys.readouterr().out
    if form == "json":
        report = json.loads(said)
        assert (report["passed"], report["trials"], report["robot"]["name"]) == (False, [], "biped")
        said = f"Biped cannot stand: {report['fault']}"
    assert said.startswith("Biped cannot stand: standing posture of biped: left sole ")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("robot-check", r"robot: got nothing; allowed: a .urdf, a robot's .toml, or one of g1, "),
        ("robot-check nope", "robot: got nope; allowed: one of g1, "),
        ("robot-check nope.urdf --soles a,b", "robot: got nope.urdf; allowed: a .urdf that exists"),
        (
            "robot-check {urdf}",
            "soles: got nothing; allowed: LEFT,RIGHT: two frames of the URDF; at the ends",
        ),
        ("robot-check {urdf} --soles head", "--soles: got head; allowed: LEFT,RIGHT: two frames of the URDF"),
        ("robot-check {urdf} --soles head,head", "--soles: got head,head; allowed: LEFT,RIGHT: two frames"),
        (
            "robot-check {urdf} --soles heel,toe",
            "--soles: got heel, toe; allowed: LEFT,RIGHT: two frames of the URDF; at the ends of its tree: ",
        ),
        ("robot-check {urdf} --soles base,head", "--soles: got base,head; allowed: frames of two feet"),
        ("robot-check {toml} --soles a,b", "--soles: got a,b; allowed: together with a .urdf"),
        ("robot-check talos --out a.toml", "--out: got a.toml; allowed: together with a .urdf"),
        ("robot-check {noise} --soles a,b", "urdf: got {noise}; allowed: a URDF file in XML ("),
        (
            "robot-check {urdf} --soles base,head --out /nowhere/a.toml",
            "--out: got /nowhere/a.toml; allowed: ",
        ),
    ],
)
def test_bad_input_is_one_line(
    write_biped: WriteBiped, tmp_path: Path, capsys: Output, words: str, message: str
) -> None:
    toml = write_biped()
    noise = tmp_path / "noise.urdf"
    noise.write_text("no robot")
    places = {"toml": str(toml), "urdf": str(toml.with_suffix(".urdf")), "noise": str(noise)}
    said = refusal(capsys, *words.format(**places).split())
    assert said.startswith(message.format(**places))


def test_a_refused_robot_leaves_no_file(write_biped: WriteBiped, tmp_path: Path, capsys: Output) -> None:
    out = tmp_path / "out.toml"
    urdf = str(write_biped().with_suffix(".urdf"))
    refusal(capsys, "robot-check", urdf, "--soles", "heel,toe", "--out", str(out))
    assert not out.exists()
