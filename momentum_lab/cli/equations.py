"""momentum-lab equations: the chapter's numbered equations, and how exactly they hold on a robot."""

from __future__ import annotations

from argparse import Namespace
from typing import Any

import msgspec
from rich.console import Console
from rich.table import Table
from rich.text import Text

from momentum_lab.experiments.equations import Measurement, measured
from momentum_lab.robot.model import RobotModel

_WIDTH, _LONGEST = 100, 82
_BROKEN = 1


def equations(args: Namespace) -> int:
    """Measure every equation on a robot and print them as a table or as a JSON array.

    Returns:
        0 when all hold, 1 when a residual is above its tolerance.

    Raises:
        InputError: the robot is unknown or cannot be read.
    """
    robot = RobotModel.named(args.robot)
    found = list(measured(robot))
    if args.json:
        print(msgspec.json.encode([as_record(each) for each in found]).decode())
    else:
        show(found, robot.spec.title)
    return 0 if all(each.holds for each in found) else _BROKEN


def as_record(measurement: Measurement) -> dict[str, Any]:
    """A measured equation as plain values by name."""
    equation = measurement.equation
    return {
        "number": equation.number,
        "statement": equation.statement,
        "function": equation.function,
        "test": equation.test,
        "erratum": equation.erratum,
        "residual": measurement.residual,
        "tolerance": equation.tolerance,
        "unit": equation.unit,
        "holds": measurement.holds,
    }


def show(found: list[Measurement], title: str) -> None:
    """The equations for people, on stdout: what is said, where, tested by what, and the residual."""
    table = Table(box=None, pad_edge=False, title=f"Equations 1 to 62 on {title}", title_justify="left")
    table.add_column("Eq.", justify="right")
    table.add_column("statement, function, test, erratum", overflow="fold")
    table.add_column("residual", justify="right", no_wrap=True)
    for each in found:
        table.add_row(str(each.equation.number), _text(each), _figure(each), end_section=True)
    kept = sum(each.holds for each in found)
    console = Console(markup=False, highlight=False)
    console.width = _WIDTH if not console.is_terminal else min(console.width, _WIDTH)
    console.print(table)
    console.print(f"{kept} of {len(found)} hold within their tolerance")


def _text(measurement: Measurement) -> Text:
    equation = measurement.equation
    lines = [equation.statement, equation.function, *_lines(equation.test)]
    if equation.erratum is not None:
        lines.append(f"erratum: {equation.erratum}")
    return Text("\n".join(lines))


def _lines(test: str) -> list[str]:
    """A node id on one line, or broken behind its file where it is too long for the table."""
    file, colons, name = test.partition("::")
    return [test] if len(test) <= _LONGEST else [file + colons, name]


def _figure(measurement: Measurement) -> Text:
    equation = measurement.equation
    verdict = f"< {equation.tolerance:.0e}" if measurement.holds else f"ABOVE {equation.tolerance:.0e}"
    return Text(f"{measurement.residual:.1e}\n{verdict}\n{equation.unit}")
