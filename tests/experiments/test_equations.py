"""The chapter's 62 equations: all there, all computed somewhere, all tested, all true on the robots."""

from __future__ import annotations

import ast
import dataclasses
import importlib
import inspect
import json
import re
import sys
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest

from momentum_lab.cli import equations as command
from momentum_lab.cli import main
from momentum_lab.control import desired, slack_qp
from momentum_lab.errors import SolverError
from momentum_lab.experiments import equations as catalog
from momentum_lab.experiments.equations import (
    EQUATIONS,
    SEED,
    Measurement,
    balance,
    cop,
    measured,
    momentum,
    motion,
)
from momentum_lab.experiments.equations.scenes import flying, standing
from momentum_lab.robot.catalog import robot_names

ROOT = Path(__file__).resolve().parents[2]
NUMBERS = [each.number for each in EQUATIONS]
COMPLETE = ("talos", "g1")

# What is wrong, incomplete or said wrongly around a numbered equation: a word each that its erratum has to say.
ERRATA = {
    1: "push",
    2: "push",
    13: "Fig. 3",
    15: "world axes",
    20: "without gravity",
    29: "Eqs. 1 and 2",
    34: "squared",
    36: "th*",
    37: "command",
    38: "command",
    40: "r_Gx",
    41: "9.81",
    42: "y_d'",
    46: "J_c^T f_c",
    47: "tau_g",
    48: "z up",
    49: "z up",
    50: "gyroscopic",
    51: "gyroscopic",
    52: "f_z > 0",
    53: "element",
    54: "link with mass",
    55: "inner product",
}


@lru_cache(maxsize=8)
def residuals(robot, seed: int) -> dict[int, float]:
    return {each.equation.number: each.residual for each in measured(robot, seed)}


def found(dotted: str) -> object:
    """What a dotted path below the package leads to."""
    parts = dotted.split(".")
    for length in range(len(parts), 0, -1):
        try:
            thing = importlib.import_module(".".join(["momentum_lab", *parts[:length]]))
        except ModuleNotFoundError:
            continue
        for name in parts[length:]:
            thing = getattr(thing, name)
        return thing
    raise ModuleNotFoundError(dotted)


def owner_of(dotted: str) -> tuple[object, str]:
    """The module or class that holds a function, and the function's name in it."""
    owner, _, name = dotted.rpartition(".")
    return found(owner), name


def modules_with(name: str, thing: object) -> list[object]:
    """All loaded modules of the package that know a function by its name."""
    ours = (module for key, module in sorted(sys.modules.items()) if key.startswith("momentum_lab."))
    return [module for module in ours if vars(module).get(name) is thing]


def enlarged(value: object, fields: tuple[str, ...] | None = None) -> object:
    """Every number in an answer times 1.001; of a dataclass only some fields, where given."""
    if isinstance(value, tuple):
        return tuple(enlarged(each) for each in value)
    if dataclasses.is_dataclass(value):
        names = fields or tuple(field.name for field in dataclasses.fields(value))
        return dataclasses.replace(value, **{name: enlarged(getattr(value, name)) for name in names})
    return 1.001 * value if isinstance(value, float | np.ndarray) else value


def names_of_tests(path: Path) -> set[str]:
    """Tests of a file as pytest names them: functions, and methods with their class."""
    names = set()
    for node in ast.parse(path.read_text()).body:
        if isinstance(node, ast.FunctionDef):
            names.add(node.name)
        elif isinstance(node, ast.ClassDef):
            methods = (each for each in node.body if isinstance(each, ast.FunctionDef))
            names |= {f"{node.name}::{each.name}" for each in methods}
    return {name for name in names if name.rpartition("::")[2].startswith("test_")}


class TestCatalog:
    def test_numbers_are_1_to_62(self):
        assert list(range(1, 63)) == NUMBERS

    @pytest.mark.parametrize("equation", EQUATIONS, ids=NUMBERS)
    def test_there_is_a_function_that_says_what_it_does(self, equation):
        function = found(equation.function)
        assert callable(function)
        assert not equation.function.rpartition(".")[2].startswith("_")
        assert inspect.getdoc(function)

    @pytest.mark.parametrize("equation", EQUATIONS, ids=NUMBERS)
    def test_there_is_a_test(self, equation):
        file, _, name = equation.test.partition("::")
        assert name in names_of_tests(ROOT / file)

    def test_what_is_not_there_is_not_found(self):
        with pytest.raises(AttributeError):
            found("momentum.ground.no_such_function")
        assert "test_no_such_test" not in names_of_tests(ROOT / "tests/momentum/test_ground.py")

    @pytest.mark.parametrize("equation", EQUATIONS, ids=NUMBERS)
    def test_texts_are_lines(self, equation):
        for text in (equation.statement, equation.unit, equation.erratum or "none"):
            assert text
            assert text.isprintable()

    def test_errata_of_numbered_equations_are_told(self):
        assert {each.number for each in EQUATIONS if each.erratum} == ERRATA.keys()
        for each in EQUATIONS:
            assert each.number not in ERRATA or ERRATA[each.number] in (each.erratum or "")


class TestResiduals:
    @pytest.mark.parametrize("seed", [SEED, 1, 2])
    @pytest.mark.parametrize("number", NUMBERS)
    def test_every_equation_holds(self, robot, number, seed):
        equation = EQUATIONS[number - 1]
        assert residuals(robot, seed)[number] <= equation.tolerance

    def test_residuals_are_measured_and_not_written_down(self, robot):
        """Other states, other rounding: next to no residual stays the same."""
        here, there = residuals(robot, SEED), residuals(robot, 1)
        changing = [number for number in NUMBERS if here[number] > 0.0 and here[number] != there[number]]
        assert len(changing) > 55

    def test_the_same_seed_gives_the_same_bits(self, robot):
        assert list(measured(robot, 3)) == list(measured(robot, 3))

    def test_states_are_in_motion_and_differ(self, robot):
        for scene in (flying, standing):
            one, other = scene(robot, 1), scene(robot, 2)
            assert np.abs(one.state.v).max() > 0.01
            assert np.abs(one.state.q - other.state.q).max() > 1e-3

    def test_standing_feet_stand_still(self, robot):
        for stance in ((0, 1), (0,)):
            dynamics = standing(robot, 1, stance).dynamics
            assert np.abs(dynamics.sole_jacobian[list(stance)] @ dynamics.state.v).max() < 1e-12


class TestWrongFunctionsAreNoticed:
    """A residual that a mistake in the function does not raise would prove nothing."""

    def residual(self, robot, number: int) -> float:
        return EQUATIONS[number - 1].residual(robot, SEED) / EQUATIONS[number - 1].tolerance

    @pytest.mark.parametrize("equation", EQUATIONS, ids=NUMBERS)
    def test_a_thousandth_too_much_in_every_answer(self, talos, equation, monkeypatch):
        """Whatever the function says, times 1.001."""
        owner, name = owner_of(equation.function)
        right = getattr(owner, name)

        def too_much(*args, **kwargs):
            # Only what these equations are about: with another state or other axes nothing could be posed.
            fields = ("centroidal_map", "sole_jacobian", "com_in_world") if name == "at" else None
            return enlarged(right(*args, **kwargs), fields)

        assert self.residual(talos, equation.number) <= 1.0
        for module in modules_with(name, right) if inspect.ismodule(owner) else [owner]:
            monkeypatch.setattr(module, name, too_much)
        assert self.residual(talos, equation.number) > 1.0

    @pytest.mark.parametrize("number", [20, 32])
    def test_a_momentum_rate_without_bias(self, talos, number, monkeypatch):
        for module in (momentum, motion):
            monkeypatch.setattr(module, "momentum_rate", lambda dynamics, a: dynamics.centroidal_map @ a)
        assert self.residual(talos, number) > 1e3

    def test_a_cop_without_gyroscopic_moments(self, talos, monkeypatch):
        right = cop.link_moments

        def printed(links, angular):
            return right(dataclasses.replace(links, spin=0.0 * links.spin), angular)

        monkeypatch.setattr(cop, "link_moments", printed)
        assert self.residual(talos, 50) > 1e3
        assert self.residual(talos, 51) > 1e3

    def test_a_law_with_the_gains_exchanged(self, talos, monkeypatch):
        right = desired.desired_linear_rate
        monkeypatch.setattr(balance, "desired_linear_rate", lambda m, d, r, a, b: right(m, d, r, b, a))
        assert self.residual(talos, 38) > 1e3

    def test_a_program_with_other_weights(self, talos, monkeypatch):
        right = slack_qp.com_output
        monkeypatch.setattr(slack_qp, "com_output", lambda *args: right(*args[:-1], 0.5 * args[-1]))
        assert self.residual(talos, 62) > 1e3


class TestCommand:
    def test_the_table_has_every_number_and_fits(self, capsys):
        assert main(["equations", "--robot", "g1"]) == 0
        lines = capsys.readouterr().out.splitlines()
        assert max(len(line) for line in lines) <= 100
        assert [int(line[:3]) for line in lines if re.match(r" *\d+  ", line)] == NUMBERS
        middle = "".join(line[5:88].strip() for line in lines)
        assert all(each.test in middle and each.function in middle for each in EQUATIONS)
        assert lines[-1] == "62 of 62 hold within their tolerance"

    def test_json_is_an_array_of_objects(self, capsys):
        assert main(["equations", "--json"]) == 0
        records = json.loads(capsys.readouterr().out)
        assert [each["number"] for each in records] == NUMBERS
        assert all(each["holds"] is (each["residual"] <= each["tolerance"]) for each in records)
        assert records[39]["erratum"].startswith("the first term is r_Gx")
        assert records[2]["erratum"] is None

    @pytest.mark.parametrize("residual", [1.0, float("nan")])
    def test_an_equation_that_does_not_hold_is_exit_code_1(self, residual, capsys, monkeypatch):
        broken = dataclasses.replace(EQUATIONS[0], residual=lambda robot, seed: residual)
        monkeypatch.setattr(catalog, "EQUATIONS", (broken, *EQUATIONS[1:]))
        assert main(["equations"]) == 1
        output = capsys.readouterr().out
        assert "ABOVE 1e-09" in output
        assert output.endswith("61 of 62 hold within their tolerance\n")

    def test_a_robot_that_is_not_there_is_one_line(self, capsys):
        assert main(["equations", "--robot", "nobody"]) == 2
        output = capsys.readouterr()
        assert output.out == ""
        assert output.err.startswith("momentum-lab: --robot: got nobody; allowed: one of g1, ")
        assert output.err.count("\n") == 1

    def test_a_controller_without_an_answer_is_one_line(self, capsys, monkeypatch):
        """Exit code 1: a solver that finds nothing is no bad input."""

        def no_answer(problem):
            raise SolverError("no minimum")

        monkeypatch.setattr(slack_qp, "solve", no_answer)
        assert main(["equations"]) == 1
        output = capsys.readouterr()
        assert output.out == ""
        assert output.err.startswith("momentum-lab: Eqs. 47, 61 and 62 on TALOS: no minimum")
        assert output.err.count("\n") == 1

    def test_a_record_says_everything(self):
        record = command.as_record(Measurement(EQUATIONS[39], 2.0))
        assert record.keys() == {field.name for field in dataclasses.fields(EQUATIONS[39])} | {"holds"}
        assert record["holds"] is False


def test_the_other_robots_too():
    for name in sorted(set(robot_names()) - set(COMPLETE)):
        robot = catalog.RobotModel.named(name)
        # Its motors of 8 to 30 N m against links of 1 kg m^2 are at their limits in the state of Eq. 62. Limits yield
        # by up to 1e-4 for the controller and are firm for the second solver, whose minimum is 5e-4 higher.
        failing = [62] if name == "simple_humanoid" else []
        assert [each.equation.number for each in measured(robot) if not each.holds] == failing
