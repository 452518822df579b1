"""Imports point down only, and each borrowed library has one place."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

import momentum_lab

PACKAGE = "momentum_lab"
RELATIVE = "by a relative path"

# From bottom to top; a room may import itself and everything on lower floors.
FLOORS: tuple[frozenset[str], ...] = (
    frozenset({"", "errors", "paths", "compiled", "cholesky", "palette", "plain"}),
    frozenset({"robot"}),
    frozenset({"momentum"}),
    frozenset({"control", "physics"}),
    frozenset(
        {
            "active_bounds",
            "beside",
            "changing",
            "choices",
            "choice_words",
            "patience",
            "effects",
            "fall",
            "scenario",
            "share_code",
            "run_file",
            "replay",
            "finished",
            "events",
            "observe",
            "recording",
            "session",
            "start",
            "steering",
            "terrain",
            "timeline",
            "trace",
            "status",
            "headless",
            "summary",
            "provenance",
            "bench",
        }
    ),
    frozenset({"experiments", "lesson"}),
    frozenset({"app"}),
    frozenset({"cli", "__main__"}),
)
# Rooms on one floor that must not know each other.
STRANGERS = ({"control", "physics"},)
# Library -> the modules, or packages with all that is in them, that may import it.
PLACES = {
    "viser": ("app",),
    "qpsolvers": ("control.qp",),
    "daqp": ("control.qp",),
    "clarabel": ("control.qp",),
    "placo": ("robot.posture", "control.placo_body", "control.placo_tasks", "bench.peer"),
    "matplotlib": ("experiments",),
    "mujoco": ("physics.mujoco_model", "bench"),
}


def test_package_obeys_every_rule() -> None:
    modules = sources()
    assert len(modules) > 30
    assert violations(modules) == []


@pytest.mark.parametrize(
    ("module", "source", "rule"),
    [
        (
            "robot.model",
            "from momentum_lab.momentum import ground",
            "robot.model must not import momentum.ground",
        ),
        ("momentum.ground", "import momentum_lab.control.qp", "momentum.ground must not import control.qp"),
        ("errors", "from momentum_lab.robot.state import State", "errors must not import robot.state"),
        (
            "control.qp",
            "from momentum_lab.physics.push import Push",
            "control.qp must not import physics.push",
        ),
        ("physics.push", "from momentum_lab.control import qp", "physics.push must not import control.qp"),
        ("physics.push", "from ..control import qp", "physics.push must not import by a relative path"),
        ("control.qp", "from momentum_lab import session", "control.qp must not import session"),
        (
            "session",
            "def f():\n    from momentum_lab.app import server",
            "session must not import app.server",
        ),
        (
            "session",
            "import momentum_lab.experiments.equations",
            "session must not import experiments.equations",
        ),
        ("headless", "import momentum_lab.cli", "headless must not import cli"),
        ("app.server", "from momentum_lab.cli import main", "app.server must not import cli"),
        ("session", "import viser.transforms", "session must not import viser"),
        ("cli", "import viser", "cli must not import viser"),
        ("control.priority", "from qpsolvers import solve_qp", "control.priority must not import qpsolvers"),
        ("control.qp_extra", "import daqp", "control.qp_extra must not import daqp"),
        ("momentum.support", "import clarabel", "momentum.support must not import clarabel"),
        ("bench.measure", "import placo", "bench.measure must not import placo"),
        ("physics.simulator", "import mujoco", "physics.simulator must not import mujoco"),
        ("garage", "import math", "garage has no floor"),
    ],
)
def test_made_up_violation_is_found(module: str, source: str, rule: str) -> None:
    assert violations({**BLAMELESS, module: source}) == [rule]


def test_blameless_imports_pass() -> None:
    assert violations(BLAMELESS) == []


def test_cycle_is_found() -> None:
    modules = {
        "session": "from momentum_lab.recording import Recording",
        "recording": "import momentum_lab.session",
    }
    assert violations({**BLAMELESS, **modules}) == ["cycle: recording, session"]


BLAMELESS = {
    "": "",
    "errors": "",
    "robot.state": "",
    "robot.posture": "import placo",
    "momentum": "",
    "momentum.ground": "from momentum_lab.robot.state import State",
    "control": "",
    "control.qp": "import qpsolvers, daqp, clarabel",
    "physics.push": "from momentum_lab.errors import InputError",
    "events": "from momentum_lab.physics.push import Push",
    "session": "from momentum_lab.control.qp import solve\nfrom momentum_lab import __version__",
    "bench.peer": "import placo",
    "app.server": "import viser\nfrom momentum_lab.session import Session",
    "cli": "from momentum_lab.app.server import serve",
}


def sources() -> dict[str, str]:
    """Module name without the package's own -> source."""
    root = Path(momentum_lab.__file__).parent
    found = {}
    for path in sorted(root.rglob("*.py")):
        parts = path.relative_to(root).with_suffix("").parts
        found[".".join(part for part in parts if part != "__init__")] = path.read_text()
    return found


def violations(modules: dict[str, str]) -> list[str]:
    """Every broken rule, in words."""
    found, graph = [], {}
    for module, source in modules.items():
        own, foreign = imports(source, modules)
        graph[module] = own - {module, ""}
        if floor(module) is None:
            found.append(f"{module} has no floor")
            continue
        found += [
            f"{module} must not import {other}" for other in sorted(own) if not may_import(module, other)
        ]
        found += [
            f"{module} must not import {name}" for name in sorted(foreign) if not may_borrow(module, name)
        ]
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        if not found:
            found.append(f"cycle: {', '.join(sorted(set(error.args[1])))}")
    return found


def imports(source: str, modules: dict[str, str]) -> tuple[set[str], set[str]]:
    """Modules of this package (without its name) and libraries that a source imports, anywhere in it."""
    own, foreign = set(), set()
    for name in dotted_names(ast.parse(source)):
        library, _, rest = name.partition(".")
        if library == PACKAGE:
            own.add(known(rest, modules))
        else:
            foreign.add(library)
    return own, foreign


def dotted_names(tree: ast.AST) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield from (f"{node.module}.{alias.name}" if not node.level else RELATIVE for alias in node.names)


def known(name: str, modules: dict[str, str]) -> str:
    """The module that a dotted name belongs to: the longest part of it that is one, or its room."""
    parts = name.split(".")
    for length in range(len(parts), 0, -1):
        if ".".join(parts[:length]) in modules:
            return ".".join(parts[:length])
    return "" if len(parts) == 1 and floor(name) is None else name


def floor(module: str) -> int | None:
    room = module.split(".")[0]
    return next((height for height, rooms in enumerate(FLOORS) if room in rooms), None)


def may_import(module: str, other: str) -> bool:
    rooms = {module.split(".")[0], other.split(".")[0]}
    lower, upper = floor(other), floor(module)
    return lower is not None and upper is not None and lower <= upper and rooms not in STRANGERS


def may_borrow(module: str, library: str) -> bool:
    if library == RELATIVE:
        return False
    return library not in PLACES or any(f"{module}.".startswith(f"{place}.") for place in PLACES[library])
