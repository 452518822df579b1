"""momentum-lab list: the names that other commands take."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
from rich.console import Console
from rich.table import Table

from momentum_lab.cli.arguments import KINDS
from momentum_lab.control.gains import declared_gains
from momentum_lab.control.motion import MOTIONS
from momentum_lab.control.planner import PLANNERS
from momentum_lab.control.presets import presets
from momentum_lab.control.registry import CONTROLLERS, controller_entry
from momentum_lab.errors import InputError, LabError
from momentum_lab.lesson.loader import lesson_files, lesson_folder
from momentum_lab.lesson.reading import read_lesson
from momentum_lab.paths import LESSONS
from momentum_lab.robot.catalog import load_spec, robot_names
from momentum_lab.scenario import load_scenario, scenario_names

_BAD_INPUT = 2
# Columns of a pipe have room; only a terminal has an edge.
_WIDE = 200

Things = list[dict[str, Any]]


def list_things(args: Namespace) -> int:
    """Print all things of one kind, as a table or as a JSON array of objects with a name each.

    A lesson with an error in it is not among them: its file and line go to stderr, and the exit code is 2.

    Raises:
        InputError: there is no such kind.
    """
    faults: list[LabError] = []
    if args.kind not in KINDS:
        raise InputError("list", args.kind, ", ".join(KINDS))
    if args.kind == "gains":
        things = gains(args.controller)
    elif args.kind == "presets":
        things = presets_of(args.controller)
    elif args.kind == "lessons":
        things, faults = lessons(LESSONS if args.lessons is None else lesson_folder(args.lessons))
    else:
        things = _LISTS[args.kind]()
    if args.json:
        print(msgspec.json.encode(things).decode())
    elif things:
        _show(things)
    for fault in faults:
        print(f"momentum-lab: {fault}", file=sys.stderr)
    return _BAD_INPUT if faults else 0


def robots() -> Things:
    """All robots of the catalog."""
    return [{"name": name, "title": load_spec(name).title} for name in robot_names()]


def controllers() -> Things:
    """All controllers of the registry."""
    return [
        {"name": name, "title": entry.title, "summary": entry.summary} for name, entry in CONTROLLERS.items()
    ]


def planners() -> Things:
    """All rows of Table 1 that can stand above a controller."""
    return [
        {"name": name, "title": planner.title, "summary": planner.summary}
        for name, planner in PLANNERS.items()
    ]


def motions() -> Things:
    """All motions; which joints they move stands in a robot's file."""
    return [{"name": name, "title": motion.title, "where": motion.where} for name, motion in MOTIONS.items()]


def scenarios() -> Things:
    """All scenarios that ship with the package."""
    return [{"name": name, "title": load_scenario(name).title} for name in scenario_names()]


def lessons(folder: Path) -> tuple[Things, list[LabError]]:
    """All lessons of a folder that can be opened, in their order, and what is wrong with the others."""
    found, faults = [], []
    for path in lesson_files(folder):
        try:
            lesson = read_lesson(path)
        except LabError as error:
            faults.append(error)
            continue
        words = {"title": lesson.title, "question": lesson.question}
        found.append({"name": path.stem, "number": lesson.number, **words})
    return found, faults


def figures() -> Things:
    """All figures that can be made, with the scenario of the same name that the app opens."""
    from momentum_lab.experiments.figures import FIGURES  # takes a second to load

    return [{"name": figure.name, "title": figure.title} for figure in FIGURES.values()]


def gains(controller: str) -> Things:
    """All gains of a controller, in the order of their declaration.

    Raises:
        InputError: there is no such controller.
    """
    return [
        {
            "name": gain.name,
            "default": gain.default,
            "unit": gain.unit,
            "range": [gain.low, gain.high],
            "help": gain.help,
        }
        for gain in declared_gains(controller_entry(controller).gains).values()
    ]


def presets_of(controller: str) -> Things:
    """All presets of a controller: shipped ones first, then one's own.

    Raises:
        InputError: there is no such controller.
    """
    return [
        {"name": name, "summary": preset.summary, "gains": preset.gains}
        for name, preset in presets(controller).items()
    ]


_LISTS: dict[str, Callable[[], Things]] = {
    "robots": robots,
    "controllers": controllers,
    "planners": planners,
    "motions": motions,
    "scenarios": scenarios,
    "figures": figures,
}


def _show(things: Things) -> None:
    table = Table(box=None, pad_edge=False)
    for column in things[0]:
        table.add_column(column)
    for thing in things:
        table.add_row(*(_text(value) for value in thing.values()))
    console = Console(markup=False)
    console.width = console.width if console.is_terminal else _WIDE
    console.print(table)


def _text(value: Any) -> str:
    if isinstance(value, list):
        return " to ".join(_text(end) for end in value)
    if isinstance(value, dict):
        return ", ".join(f"{key} {_text(inner)}" for key, inner in value.items())
    return f"{value:g}" if isinstance(value, float) else str(value)
