"""A scenario: everything that is decided before a run, as plain data that goes to TOML, JSON and back."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec

from momentum_lab.errors import ScenarioError
from momentum_lab.paths import ASSETS
from momentum_lab.physics.push import Push

SCENARIO_FOLDER = ASSETS / "scenarios"
MAX_SECONDS = 3600.0
ENGINES = ("pinocchio",)


class Scenario(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One experiment.

    Attributes:
        name: the name on the command line.
        title: what it shows, in a few words.
        robot: a robot of the catalog, or the path of a robot's TOML file.
        controller: a controller of the registry.
        stance: the feet the robot stands on; empty: all of them.
        priority: 0 keeps linear momentum, 1 keeps angular momentum.
        gains: values that differ from the controller's defaults.
        pushes: the pushes, in simulated time.
        seconds: how long a run lasts, s.
        friction: Coulomb coefficient of the ground; None: the robot's own.
        position: where on the ground the robot starts (x, y), m.
        heading_deg: where it faces, degrees about the vertical.
        engine: which physics answers.
        seed: seed of everything random in the run.
        timestep: length of a tick of control and physics, s.
    """

    name: str
    title: str = ""
    robot: str = "talos"
    controller: str = "computed-torque"
    stance: tuple[str, ...] = ()
    priority: Annotated[float, msgspec.Meta(ge=0.0, le=1.0)] = 0.0
    gains: dict[str, float] = {}
    pushes: tuple[Push, ...] = ()
    seconds: Annotated[float, msgspec.Meta(gt=0.0, le=MAX_SECONDS)] = 4.0
    friction: Annotated[float, msgspec.Meta(gt=0.0, le=2.0)] | None = None
    position: tuple[float, float] = (0.0, 0.0)
    heading_deg: Annotated[float, msgspec.Meta(ge=-360.0, le=360.0)] = 0.0
    engine: Literal["pinocchio"] = "pinocchio"
    seed: Annotated[int, msgspec.Meta(ge=0)] = 0
    timestep: Annotated[float, msgspec.Meta(ge=1e-4, le=2e-3)] = 1e-3


def scenario_names() -> list[str]:
    """Names of all scenarios in assets/scenarios, sorted."""
    return sorted(path.stem for path in SCENARIO_FOLDER.glob("*.toml"))


def load_scenario(name: str) -> Scenario:
    """The scenario of that name, or of the TOML file at that path.

    Raises:
        ScenarioError: there is none, or the file cannot be read or is no scenario.
    """
    path = Path(name) if name.endswith(".toml") else SCENARIO_FOLDER / f"{name}.toml"
    if not path.is_file():
        raise ScenarioError(
            "scenario", name, f"one of {', '.join(scenario_names())}, or the path of a .toml file"
        )
    try:
        return checked(msgspec.toml.decode(path.read_bytes(), type=Scenario))
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise ScenarioError("scenario", path, f"a TOML file that describes a scenario ({error})") from error


def changed(scenario: Scenario, **changes: Any) -> Scenario:
    """The same scenario with some fields changed, checked like one that is read from a file.

    Raises:
        ScenarioError: a value is not allowed; the message names the field.
    """
    data = {**msgspec.to_builtins(scenario), **msgspec.to_builtins(changes)}
    try:
        return checked(msgspec.convert(data, Scenario))
    except msgspec.ValidationError as error:
        message, _, where = str(error).partition(" - at ")
        field = where.strip("`").removeprefix("$.") or "scenario"
        given = data.get(field.split(".")[0].split("[")[0], data)
        raise ScenarioError(field, given, message) from error


def checked(scenario: Scenario) -> Scenario:
    """The scenario, if every number in it is finite.

    Raises:
        ScenarioError: one is not (comparisons with NaN let it pass every range).
    """
    for field, value in _numbers(msgspec.to_builtins(scenario)):
        if not math.isfinite(value):
            raise ScenarioError(field, value, "a finite number")
    return scenario


def _numbers(value: Any, field: str = "") -> list[tuple[str, float]]:
    if isinstance(value, float):
        return [(field, value)]
    items: Any = ()
    if isinstance(value, dict):
        items = value.items()
    elif isinstance(value, list | tuple):
        items = enumerate(value)
    return [found for key, inner in items for found in _numbers(inner, f"{field}.{key}".strip("."))]
