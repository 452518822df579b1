"""A scenario: everything that is decided before a run, as plain data that goes to TOML, JSON and back."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Annotated, Any, get_args

import msgspec

from momentum_lab.beside import Beside
from momentum_lab.control.ground_sense import GROUND_SENSES, GroundSense
from momentum_lab.control.motion import ANGULAR_GOALS, AngularGoal
from momentum_lab.control.registry import planner_above
from momentum_lab.errors import InputError, ScenarioError
from momentum_lab.momentum.directions import directions
from momentum_lab.paths import ASSETS
from momentum_lab.physics.engines import Engine
from momentum_lab.physics.ground import check_motion
from momentum_lab.physics.mismatch import Mismatch
from momentum_lab.physics.plate import AXES, Course, Friction, FrictionChange, Plate, PlateMotion
from momentum_lab.physics.push import Push, Shape

SCENARIO_FOLDER = ASSETS / "scenarios"
MIN_SECONDS = 1e-3
MAX_SECONDS = 3600.0
MAX_SEED = 2**32 - 1
MAX_DISTANCE = 1000.0
MAX_LEAN = 0.1
# In the air for 0.78 s: a loop of the legs in less asks for more than the motors of TALOS have.
MAX_DROP = 3.0
ENGINES = get_args(Engine)

_CHOICES = {
    "engine": ENGINES,
    "angular_goal": ANGULAR_GOALS,
    "ground_sense": GROUND_SENSES,
    "shape": get_args(Shape),
    "axis": AXES,
    "course": get_args(Course),
}
_PARTS: dict[str, type[msgspec.Struct]] = {
    "beside": Beside,
    "pushes": Push,
    "ground": Plate,
    "motions": PlateMotion,
    "changes": FrictionChange,
    "mismatch": Mismatch,
}
_WORDS = {
    "float": "number",
    "int": "whole number",
    "str": "text",
    "array": "list",
    "object": "table",
    "null": "nothing",
}

Coordinate = Annotated[float, msgspec.Meta(ge=-MAX_DISTANCE, le=MAX_DISTANCE)]


class Scenario(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One experiment.

    Attributes:
        name: the name on the command line.
        title: what it shows, in a few words.
        robot: a robot of the catalog, or the path of a robot's TOML file.
        controller: a controller of the registry.
        controlled: the directions of momentum that are asked for, such as `all` or `linear+kz`.
        planner: what makes the momentum rates that are asked for, a row of Table 1.
        motion: what the robot does besides standing; empty: nothing.
        angular_goal: the angular momentum that is asked for: zero, or that of the motion by kinematics alone.
        stance: the feet the robot stands on; empty: all of them.
        com_outside: how far outside the outer edge of its only stance foot the CoM starts, m; None: the robot
            starts where it is to stand.
        drop_height: how far above the ground the soles start, m.
        priority: 0 keeps linear momentum, 1 keeps angular momentum.
        gains: values that differ from the controller's defaults.
        pushes: the pushes, in simulated time.
        seconds: how long a run lasts, s.
        friction: Coulomb coefficient of the ground; None: the robot's own.
        ground: plates under the feet that are tilted, moving, higher or more slippery than the floor.
        ground_sense: whether the robot is told how the ground moves, or feels it through its soles.
        position: where on the ground the robot starts (x, y), m.
        heading_deg: where it faces, degrees about the vertical.
        engine: which physics answers.
        mismatch: how the simulated robot differs from the one its controller believes in.
        seed: seed of everything random in the run: the noise of sensors.
        timestep: length of a tick of control and physics, s.
        beside: what a second robot beside the first does differently; None: there is none.
    """

    name: str
    title: str = ""
    robot: str = "talos"
    controller: str = "computed-torque"
    controlled: str = "all"
    planner: str = "momentum"
    motion: str = ""
    angular_goal: AngularGoal = "zero"
    stance: tuple[str, ...] = ()
    com_outside: Annotated[float, msgspec.Meta(ge=-MAX_LEAN, le=MAX_LEAN)] | None = None
    drop_height: Annotated[float, msgspec.Meta(ge=0.0, le=MAX_DROP)] = 0.0
    priority: Annotated[float, msgspec.Meta(ge=0.0, le=1.0)] = 0.0
    gains: dict[str, float] = {}
    pushes: tuple[Push, ...] = ()
    seconds: Annotated[float, msgspec.Meta(ge=MIN_SECONDS, le=MAX_SECONDS)] = 4.0
    friction: Friction | None = None
    ground: tuple[Plate, ...] = ()
    ground_sense: GroundSense = "told"
    position: tuple[Coordinate, Coordinate] = (0.0, 0.0)
    heading_deg: Annotated[float, msgspec.Meta(ge=-360.0, le=360.0)] = 0.0
    mismatch: Mismatch = Mismatch()
    engine: Engine = "pinocchio"
    seed: Annotated[int, msgspec.Meta(ge=0, le=MAX_SEED)] = 0
    timestep: Annotated[float, msgspec.Meta(ge=1e-4, le=2e-3)] = 1e-3
    beside: Beside | None = None


def scenario_names() -> list[str]:
    """Names of all scenarios in assets/scenarios, sorted."""
    return sorted(path.stem for path in SCENARIO_FOLDER.glob("*.toml"))


def load_scenario(name: str) -> Scenario:
    """The scenario of that name, or of the TOML file at that path.

    Raises:
        ScenarioError: there is none, or the file cannot be read or is no scenario.
    """
    path = Path(name) if name.endswith(".toml") else SCENARIO_FOLDER / f"{name}.toml"
    try:
        data = msgspec.toml.decode(path.read_bytes())
    except OSError as error:
        if name.endswith(".toml"):
            allowed = f"a .toml file that can be read ({error.strerror})"
        else:
            allowed = f"one of {', '.join(scenario_names())}, or the path of a .toml file"
        raise ScenarioError("scenario", name, allowed) from error
    except (ValueError, RecursionError) as error:
        raise ScenarioError("scenario", path, f"a TOML file that describes a scenario ({error})") from error
    return scenario_from(data, f" in {path}")


def changed(scenario: Scenario, **changes: Any) -> Scenario:
    """The same scenario with some fields changed, checked like one that is read from a file.

    Raises:
        ScenarioError: a value is not allowed; the message names the field.
    """
    return scenario_from({**msgspec.to_builtins(scenario), **msgspec.to_builtins(changes)})


def sides(scenario: Scenario) -> tuple[Scenario, ...]:
    """The scenario of every robot in it: the first one's, and that of the robot beside it if there is one.

    Both start at the same place, so that two robots without a difference move bit for bit alike.

    Raises:
        InputError: the robot beside has a controller that does not exist.
    """
    beside, first = scenario.beside, msgspec.structs.replace(scenario, beside=None)
    if beside is None:
        return (first,)
    same = beside.controller in (None, scenario.controller)
    changes: dict[str, Any] = {"gains": {**(scenario.gains if same else {}), **beside.gains}}
    if beside.controller is not None:
        changes["controller"] = beside.controller
        changes["planner"] = planner_above(beside.controller, scenario.planner)
    if beside.priority is not None:
        changes["priority"] = beside.priority
    return first, msgspec.structs.replace(first, **changes)


def checked(scenario: Scenario) -> Scenario:
    """The scenario, if every number in it is finite.

    Raises:
        ScenarioError: one is not.
    """
    check_finite(msgspec.to_builtins(scenario))
    return scenario


def scenario_from(data: dict[str, Any], where: str = "") -> Scenario:
    """Plain data as a scenario.

    Args:
        data: what a file or a code holds.
        where: what is said of the place of a mistake.

    Raises:
        ScenarioError: it is no scenario; the message names the field and the place.
    """
    check_finite(data, where)
    try:
        scenario = msgspec.convert(data, Scenario)
    except msgspec.ValidationError as error:
        rule, _, place = str(error).partition(" - at ")
        field = place.strip("`").removeprefix("$").removeprefix(".").removesuffix("[...]")
        given, allowed = _explained(rule, field, data)
        raise ScenarioError((field or "scenario") + where, given, allowed) from error
    _check_plates(scenario, where)
    try:
        directions(scenario.controlled)
    except InputError as error:
        raise ScenarioError("controlled" + where, scenario.controlled, error.allowed) from error
    return scenario


def _check_plates(scenario: Scenario, where: str) -> None:
    """Refuse a motion of the ground that is too fast or goes too far, with its place."""
    for i, plate in enumerate(scenario.ground):
        for j, motion in enumerate(plate.motions):
            _check_motion(motion, f"ground[{i}].motions[{j}].", where)


def _check_motion(motion: PlateMotion, place: str, where: str) -> None:
    try:
        check_motion(motion)
    except InputError as error:
        raise ScenarioError(place + error.argument + where, error.given, error.allowed) from error


def _explained(rule: str, field: str, data: Any) -> tuple[object, str]:
    """What was given where a rule was broken, and what is allowed there, in words."""
    given = data
    for key in re.findall(r"\w+", field):
        given = given[int(key)] if isinstance(given, list | tuple) else given[key]
    if "unknown field" in rule:
        inside = [word for word in re.findall(r"[a-z_]+", field) if word in _PARTS]
        fields = (_PARTS[inside[-1]] if inside else Scenario).__struct_fields__
        return rule.split("`")[1], f"the fields {', '.join(fields)}"
    if "missing required field" in rule:
        return "nothing", rule.removeprefix("Object missing required ").replace("`", "")
    if "enum value" in rule:
        return given, f"one of {', '.join(_CHOICES[field.rpartition('.')[2]])}"
    allowed = rule.removeprefix("Expected ").partition(", got")[0].replace("`", "")
    for plain, word in _WORDS.items():
        allowed = allowed.replace(plain, word)
    return given, allowed


def check_finite(data: Any, where: str = "") -> None:
    """Refuse plain data with a number in it that is not finite: comparisons with NaN let it pass every range.

    Raises:
        ScenarioError: there is one.
    """
    for field, value in _numbers(data):
        if not math.isfinite(value):
            raise ScenarioError(field + where, value, "a finite number")


def _numbers(value: Any, field: str = "") -> list[tuple[str, float]]:
    if isinstance(value, float):
        return [(field, value)]
    items: Any = ()
    if isinstance(value, dict):
        items = value.items()
    elif isinstance(value, list | tuple):
        items = enumerate(value)
    return [found for key, inner in items for found in _numbers(inner, f"{field}.{key}".strip("."))]
