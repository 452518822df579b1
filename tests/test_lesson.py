"""Lessons as data: their equations, their texts, and what is said about a script with an error in it."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

from momentum_lab.cli import main
from momentum_lab.errors import GainError, InputError, LessonError, ScenarioError
from momentum_lab.events import SetGain, SetPriority
from momentum_lab.lesson.equation import Equation, Symbol, mathml, numbers, residual, sides
from momentum_lab.lesson.loader import find_lesson, headline, lesson_files, load_lesson
from momentum_lab.lesson.parts import Measure, Run
from momentum_lab.lesson.playing import play_lesson
from momentum_lab.lesson.text import check_words, spoken
from momentum_lab.paths import LESSONS
from momentum_lab.robot.model import RobotModel

MATH = "{http://www.w3.org/1998/Math/MathML}"
Output = pytest.CaptureFixture[str]


def example() -> str:
    """The lesson that the README writes out."""
    return (LESSONS / "README.md").read_text().partition("```python\n")[2].partition("```")[0]


def written(folder: Path, *changes: tuple[str, str]) -> Path:
    """The README's lesson with some words replaced, as a file."""
    source = example()
    for old, new in changes:
        assert old in source
        source = source.replace(old, new)
    path = folder / "01_leaning_in.py"
    path.write_text(source)
    return path


def line_of(path: Path, words: str) -> int:
    lines = path.read_text().splitlines()
    return next(number for number, line in enumerate(lines, 1) if words in line)


# equations


def made_up(**columns: Any) -> Any:
    """Something with the little of a session that equations ask for."""
    count = len(next(iter(columns.values())))
    table = {"time": 0.001 * np.arange(count), "fallen": np.zeros(count), **columns}
    return SimpleNamespace(
        recording=SimpleNamespace(column=lambda name: table[name]), scenario=SimpleNamespace(timestep=0.001)
    )


def symbol(name: str, spec: str = ".1f") -> Symbol:
    return Symbol(lambda session: session.recording.column(name), "N", name, spec)


def test_equation_is_evaluated_as_it_is_written() -> None:
    rng = np.random.default_rng(3)
    a, b, c = rng.uniform(1.0, 2.0, (3, 50))
    session = made_up(a=a, b=b, c=c)
    symbols = {"a": symbol("a"), "b": symbol("b"), "c": symbol("c")}
    right = "(a - b) - (c - a) * 2 / b ** 2 + sqrt(c) * exp(-a) - abs(-b)"
    exact = (a - b) - (c - a) * 2.0 / b**2 + np.sqrt(c) * np.exp(-a) - np.abs(-b)
    expected = float(np.abs(a - exact).max())
    assert residual(Equation(f"a = {right}", symbols, 1.0, "N"), session) == pytest.approx(expected)


def test_residual_counts_the_share_the_time_and_the_upright_ticks_only() -> None:
    apart = np.zeros(100)
    apart[:10], apart[50], apart[90:] = 9.0, 5.0, 7.0
    fallen = np.arange(100) >= 90
    session = made_up(a=apart, b=np.zeros(100), fallen=fallen.astype(float))
    equation = Equation("a = b", {"a": symbol("a"), "b": symbol("b")}, 1.0, "N", since=0.0095)
    assert residual(equation, session) == 5.0
    assert residual(replace(equation, share=0.9), session) == 0.0
    assert np.isnan(residual(replace(equation, since=10.0), session))


def test_differences_over_a_tick_may_stand_beside_what_they_come_from() -> None:
    way = np.linspace(0.0, 1.0, 11) ** 2
    symbols = {
        "dx": Symbol(lambda session: np.diff(session.recording.column("x")), "m", "step"),
        "x": symbol("x"),
        "c": Symbol(lambda session: 0.0, "m", "nothing"),
    }
    session = made_up(x=way)
    assert residual(Equation("dx = c * x", symbols, 1.0, "m"), session) == pytest.approx(0.19)
    assert numbers(Equation("dx = c * x", symbols, 1.0, "m"), session, 99.0)["x"] == pytest.approx(0.81)


def test_mathml_is_well_formed_and_carries_numbers_and_units() -> None:
    names = ("dk_y", "f_z", "s_x", "Gamma_21", "ddr_x")
    equation = Equation(
        "dk_y = f_z * (s_x - Gamma_21) / sqrt(ddr_x ** 2)", {name: symbol(name) for name in names}, 1.0, "N"
    )
    tree = ElementTree.fromstring(mathml(equation, dict(zip(names, (1.26, 2.0, 3.0, 4.0, 5.0), strict=True))))
    assert tree.tag == f"{MATH}math"
    labels = [label.text for label in tree.iter(f"{MATH}mtext")]
    assert labels == ["1.3 N", "2.0 N", "3.0 N", "4.0 N", "5.0 N"]
    plain = "".join(tree.itertext())
    assert plain.startswith("k˙y1.3 N=")
    assert "Γ21" in plain
    rate = Equation("dxi_x = delta", {"dxi_x": symbol("x"), "delta": symbol("d")}, 1.0, "N")
    assert "".join(ElementTree.fromstring(mathml(rate, {})).itertext()) == "ξ˙x=δ"
    assert "r¨x" in plain
    for kind in ("mfrac", "msqrt", "msup", "munder", "mover", "msub"):
        assert tree.find(f".//{MATH}{kind}") is not None


def test_mathml_escapes_what_a_unit_may_hold() -> None:
    equation = Equation("a = 1", {"a": Symbol(lambda session: 1.0, "<&>", "odd")}, 1.0, "")
    tree = ElementTree.fromstring(mathml(equation, {"a": 1.0}))
    assert next(tree.iter(f"{MATH}mtext")).text == "1 <&>"


@pytest.mark.parametrize(
    ("text", "brackets"), [("a = a - (b - c)", 1), ("a = (a - b) - c", 0), ("a = a * (b + c)", 1)]
)
def test_brackets_stand_where_they_are_needed(text: str, brackets: int) -> None:
    equation = Equation(text, {name: symbol(name) for name in "abc"}, 1.0, "N")
    assert mathml(equation, {}).count("<mo>(</mo>") == brackets


@pytest.mark.parametrize(
    "text", ["a", "a = b = c", "a = f(b)", "a = b if c else a", "a = 'x'", "a = b.c", "a = ", "a = b @ c"]
)
def test_text_that_is_no_equation_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="one '=' between names"):
        sides(text)


def test_symbol_that_nothing_measures_is_refused() -> None:
    with pytest.raises(InputError, match=r"^symbol: got b; allowed: one of a$"):
        Equation("a = b", {"a": symbol("a")}, 1.0, "N")


# texts


def test_text_speaks_with_value_and_unit() -> None:
    measures = {"force": Measure(lambda runs: 0.0, "N"), "end": Measure(lambda runs: "")}
    values = {"force": 216.6, "end": "stands"}
    text = "Pushed by {force}, priority 0, it {end} (Eqs. 21 and 22, Fig. 7, Gamma_21)."
    check_words(text, measures)
    assert spoken(text, measures, values).startswith("Pushed by 217 N, priority 0, it stands")


@pytest.mark.parametrize(
    ("text", "given"),
    [("It weighs {wait}.", "{wait}"), ("It weighs 90 kg.", "90"), ("Moves 0.24 m/s (Eq. 2)", "0.24")],
)
def test_number_that_nothing_has_measured_is_refused(text: str, given: str) -> None:
    with pytest.raises(InputError) as caught:
        check_words(text, {"weight": Measure(lambda runs: 0.0, "N")})
    assert caught.value.given == given


# runs


def test_run_is_checked_where_it_is_written() -> None:
    with pytest.raises(ScenarioError, match="scenario: got fig77"):
        Run("fig77")
    with pytest.raises(ScenarioError, match="prioritty"):
        Run("fig7", {"prioritty": 1.0})
    with pytest.raises(GainError, match="linear_dampng"):
        Run("fig7", {"gains": {"linear_dampng": 1.0}})
    with pytest.raises(GainError, match="com_weight"):
        Run("fig7", events=((0.1, SetGain("com_weight", 1.0)),))


def test_run_takes_the_robots_own_scenario() -> None:
    assert Run("fig9").for_robot("g1").com_outside == 0.01
    assert Run("fig7").for_robot("g1").robot == "g1"


# scripts


def test_lesson_is_found_by_number_file_and_title(tmp_path: Path) -> None:
    path = written(tmp_path)
    (tmp_path / "notes.py").write_text("no lesson")
    assert lesson_files(tmp_path) == [path]
    for name in ("1", "01", "01_leaning_in", "leaning_in", "leaning-in", "Leaning in"):
        assert find_lesson(name, tmp_path) == path
    (tmp_path / "00_broken.py").write_text("STEPS = = (")  # it comes first, and hides nobody
    assert find_lesson("Leaning in", tmp_path) == path
    assert headline(path) == ("Leaning in", "You push a robot from behind. Where does it stop?")
    with pytest.raises(InputError, match="lesson: got 2; allowed: 00_broken, 01_leaning_in"):
        find_lesson("2", tmp_path)
    with pytest.raises(InputError, match="lesson: got nothing"):
        find_lesson("", tmp_path)


CLAIMED = '    lab.Stands("push"),\n    lab.Bound("the CoM comes back", "end", low=-1.0, high=1.0),\n'
BROKEN = [
    ("syntax", ("STEPS = (", "STEPS = = ("), "STEPS = = (", r"Python \("),
    ("missing claim", ("CLAIMS = (", "CLAIMED = ("), '"""Leaning in', r"got no CLAIMS; allowed: CLAIMS = a tuple"),
    ("empty claims", (CLAIMED, ""), "CLAIMS =", r"got CLAIMS = \(\)"),
    ("claim of another kind", ('    lab.Stands("push"),', '    "it stands",'), "CLAIMS =", "got 'it stands'"),
    ("unknown gain", ('"seconds": 2.0', '"gains": {"linear_dampng": 8.0}'), "RUNS =", "got gain linear_dampng"),
    ("gain out of range", ('"seconds": 2.0', '"gains": {"linear_damping": 800.0}'), "RUNS =", "from 0 to 60 1/s"),
    ("unknown scenario", ('"stand"', '"stnd"'), "RUNS =", "got scenario stnd"),
    ("unknown control", ('"linear_stiffness"', '"linear_stifness"'), '"linear_stifness"', "got linear_stifness"),
    ("unknown run", ('Stands("push")', 'Stands("pusch")'), '"pusch"', "got pusch; allowed: one of push"),
    ("beside itself", ('fness")', 'fness"), beside="push"'), "RUNS =", "got push; allowed: one of another run"),
    ("unknown view", ('fness")', 'fness"), view="Top"'), '"Top"', "got Top; allowed: one of Whole robot, Feet"),
    ("unknown measure", ('"end", low', '"ent", low'), '"ent"', "got ent; allowed: one of push, way, end"),
    ("field without a measure", ("{way} and", "{weg} and"), "{weg}", "got {weg}; allowed: a measure: push, way, end"),
    ("number in the prose", ("harder and harder", "with 90 N"), "90 N", "got 90; allowed: numbers from the runs"),
    ("unknown symbol", ("dl_x = f_x", "dl_x = f_y"), "equation=lab", "got symbol f_y"),
    ("return outside", ("RUNS =", "return\nRUNS ="), "return", r"Python \('return' outside function"),
    ("leaves", ("RUNS =", "exit()\nRUNS ="), "exit()", "got SystemExit"),
    ("unknown robot", ("RUNS =", 'ROBOTS = ("tallos",)\nRUNS ='), "ROBOTS", "a tuple of g1, human, icub"),
    ("wrong import", ("import com_moved", "import com_mooved"), "import com_mooved", "got ImportError"),
    ("no question", ("\n\nYou push a robot from behind. Where does it stop?\n", ""), "Leaning in", "got no question"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("change", "place", "words"), [case[1:] for case in BROKEN], ids=[case[0] for case in BROKEN]
)
def test_script_with_an_error_is_told_by_file_and_line(
    tmp_path: Path, capsys: Output, change: tuple[str, str], place: str, words: str
) -> None:
    path = written(tmp_path, change)
    assert main(["lesson", "1", "--headless", "--lessons", str(tmp_path)]) == 2
    answer = capsys.readouterr()
    assert answer.out == ""
    assert answer.err.count("\n") == 1
    assert answer.err.startswith(f"momentum-lab: {path}:{line_of(path, place)}: got ")
    assert re.search(words, answer.err)


def test_script_that_is_no_text_is_told(tmp_path: Path) -> None:
    path = tmp_path / "03_bytes.py"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(LessonError, match=r"03_bytes\.py:1: "):
        load_lesson(path)


def test_measure_with_an_error_is_told_when_it_is_played(tmp_path: Path, g1: RobotModel) -> None:
    path = written(tmp_path, ('com_moved(runs["push"])[-1, 0]', 'com_moved(runs["pusch"])[-1, 0]'))
    lesson = replace(load_lesson(path), runs={"push": Run("fig7", {"seconds": 0.01})})
    with pytest.raises(
        LessonError, match=rf"01_leaning_in\.py:{line_of(path, 'pusch')}: got KeyError: 'pusch'"
    ):
        play_lesson(lesson, g1)


@pytest.mark.parametrize(
    ("change", "place", "words"),
    [
        (('[-1, 0], "mm"', '[-1, 0:], "mm"'), '"end": lab', "got TypeError"),
        (('[-1, 0], "mm", ".1f"', '[-1, 0], "mm", ".1q"'), '"end": lab', "got ValueError"),
        (
            ('"f_x": q.FORCE_X', '"f_x": lab.Symbol(q.recorded("fore"), "N", "")'),
            "The force",
            "got KeyError: 'fore'",
        ),
        (('m["end"] <= 0.5', 'm["ent"] <= 0.5'), 'm["ent"]', "got KeyError: 'ent'"),
    ],
)
def test_error_that_shows_when_it_is_played_is_told_like_every_other(
    tmp_path: Path, g1: RobotModel, change: tuple[str, str], place: str, words: str
) -> None:
    path = written(tmp_path, change)
    lesson = replace(load_lesson(path), runs={"push": Run("fig7", {"seconds": 0.01})})
    with pytest.raises(LessonError, match=re.escape(f"{path.name}:{line_of(path, place)}: {words}")):
        play_lesson(lesson, g1)


def test_events_happen_at_their_time(tmp_path: Path, g1: RobotModel) -> None:
    run = Run("stand", {"seconds": 0.02}, events=((0.01, SetPriority(1.0)), (0.005, SetPriority(0.5))))
    lesson = replace(load_lesson(written(tmp_path)), runs={"push": run}, steps=(), measures={}, claims=())
    priority = play_lesson(lesson, g1).runs["push"].recording.column("priority")
    np.testing.assert_array_equal(priority, np.repeat([0.0, 0.5, 1.0], [5, 5, 10]))


# the command


def test_the_readmes_lesson_is_whole(tmp_path: Path, capsys: Output) -> None:
    written(tmp_path)
    words = ["--lessons", str(tmp_path)]
    assert main(["lesson", "leaning in", "--json", "--robot", "g1", *words]) == 0
    record = json.loads(capsys.readouterr().out)
    assert (record["number"], record["title"], record["robot"]) == (1, "Leaning in", "g1")
    assert [step["kind"] for step in record["steps"]] == ["choice", "play", "compare", "explain"]
    assert record["steps"][0]["right"] == [1]
    assert record["steps"][0]["text"] == "After a push of 60 N, where does the CoM come to rest?"
    assert ElementTree.fromstring(record["steps"][3]["mathml"]).tag == f"{MATH}math"
    assert record["holds"]
    assert main(["list", "lessons", "--json", *words]) == 0
    assert json.loads(capsys.readouterr().out)[0]["number"] == 1


def test_claim_that_fails_ends_with_exit_code_1(tmp_path: Path, capsys: Output) -> None:
    written(tmp_path, ("high=1.0", "high=-0.9"))
    assert main(["lesson", "1", "--headless", "--robot", "g1", "--lessons", str(tmp_path)]) == 1
    out = capsys.readouterr().out
    assert "Where does it stop?" in out
    assert " -> Where it was before" in out
    assert re.search(r"dl_x = -?\d+ N", out)
    assert out.count("FAILS") == 1


def test_folder_that_is_none_is_refused(tmp_path: Path, capsys: Output) -> None:
    assert main(["lesson", "1", "--headless", "--lessons", str(tmp_path / "none")]) == 2
    assert capsys.readouterr().err.startswith("momentum-lab: --lessons: got ")


@pytest.mark.parametrize("name", ["-1", "1.0", "", "99"])
def test_a_number_that_is_no_lesson_is_refused(name: str) -> None:
    with pytest.raises(InputError, match="lesson"):
        find_lesson(name)
