from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import msgspec
import pytest

from momentum_lab.beside import Beside
from momentum_lab.choices import Choices
from momentum_lab.control.planner import PLANNERS
from momentum_lab.control.registry import CONTROLLERS
from momentum_lab.errors import ScenarioError
from momentum_lab.physics.push import Push
from momentum_lab.robot.catalog import robot_names
from momentum_lab.scenario import (
    MAX_SECONDS,
    Scenario,
    changed,
    checked,
    load_scenario,
    scenario_names,
    sides,
)

BUSY = Scenario(
    name="busy",
    robot="g1",
    stance=("left",),
    priority=0.25,
    gains={"linear_damping": 9.5},
    pushes=(Push(force=20.0, direction_deg=45.0, height=0.8), Push(velocity_change=0.1, shape="half-sine")),
    seconds=2.5,
    friction=0.5,
    position=(100.0, -3.0),
    heading_deg=137.0,
    seed=7,
)

BUSY_AS_TOML = """
name = "busy"
robot = "g1"
stance = ["left"]
priority = 0.25
seconds = 2.5
friction = 0.5
position = [100, -3]
heading_deg = 137.0
seed = 7

[gains]
linear_damping = 9.5

[[pushes]]
force = 20.0
direction_deg = 45.0
height = 0.8

[[pushes]]
velocity_change = 0.1
shape = "half-sine"
"""


def test_the_promised_scenarios_ship() -> None:
    assert {"stand", "push-forward", "push-lateral", "push-backward", "one-leg"} <= set(scenario_names())


@pytest.mark.parametrize("name", scenario_names())
def test_shipped_scenario_names_what_exists(name: str) -> None:
    scenario = load_scenario(name)
    assert scenario.name == name
    assert scenario.title
    assert scenario.robot in robot_names()
    assert scenario.controller in CONTROLLERS


@pytest.mark.parametrize(
    ("name", "direction"), [("push-forward", (1, 0)), ("push-lateral", (0, 1)), ("push-backward", (-1, 0))]
)
def test_push_scenarios_push_where_they_say(name: str, direction: tuple[int, int]) -> None:
    (push,) = load_scenario(name).pushes
    assert tuple(push.direction[:2]) == pytest.approx(direction, abs=1e-12)


@pytest.mark.parametrize("scenario", [BUSY, *map(load_scenario, scenario_names())], ids=lambda s: s.name)
def test_round_trip_through_json_keeps_every_bit(scenario: Scenario) -> None:
    assert msgspec.json.decode(msgspec.json.encode(scenario), type=Scenario) == scenario


def test_every_field_can_be_written_in_a_file(tmp_path: Path) -> None:
    path = tmp_path / "busy.toml"
    path.write_text(BUSY_AS_TOML)
    assert load_scenario(str(path)) == BUSY


def test_a_file_is_a_scenario_too(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text('name = "mine"\nseconds = 1\n[[pushes]]\nforce = 12.5\n')
    assert load_scenario(str(path)) == Scenario("mine", seconds=1.0, pushes=(Push(force=12.5),))


def test_changed_changes_only_what_it_is_told() -> None:
    other = changed(BUSY, seconds=1.0, pushes=())
    assert (other.seconds, other.pushes) == (1.0, ())
    assert changed(other, seconds=BUSY.seconds, pushes=BUSY.pushes) == BUSY


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"seconds": -1.0}, "seconds: got -1.0; allowed: number >= 0.001"),
        ({"seconds": 1e-13}, "seconds: got 1e-13; allowed: number >= 0.001"),
        ({"seconds": MAX_SECONDS + 1}, "seconds: got 3601.0; allowed: number <= 3600.0"),
        ({"seconds": "4 s"}, "seconds: got 4 s; allowed: number"),
        ({"seconds": math.nan}, "seconds: got nan; allowed: a finite number"),
        ({"priority": math.inf}, "priority: got inf; allowed: a finite number"),
        ({"priority": 1.5}, "priority: got 1.5; allowed: number <= 1.0"),
        ({"engine": "bullet"}, "engine: got bullet; allowed: one of pinocchio, mujoco"),
        ({"seed": 1.5}, "seed: got 1.5; allowed: whole number"),
        ({"friction": 0.0}, "friction: got 0.0; allowed: number > 0.0"),
        ({"position": [1.0]}, "position: got [1.0]; allowed: list of length 2"),
        ({"position": [0.0, 1e9]}, "position[1]: got 1000000000.0; allowed: number <= 1000.0"),
        ({"gains": {"a": "b"}}, "gains: got {'a': 'b'}; allowed: number"),
        ({"pushes": [{"force": -3.0}]}, "pushes[0].force: got -3.0; allowed: number >= 0.0"),
        ({"pushes": [{"force": math.nan}]}, "pushes.0.force: got nan; allowed: a finite number"),
        ({"beside": 3}, "beside: got 3; allowed: table | nothing"),
        ({"beside": {"priority": 1.5}}, "beside.priority: got 1.5; allowed: number <= 1.0"),
        ({"beside": {"priority": math.nan}}, "beside.priority: got nan; allowed: a finite number"),
        ({"beside": {"speed": 1}}, "beside: got speed; allowed: the fields controller, priority, gains"),
        ({"pushes": [{"shape": "x"}]}, "pushes[0].shape: got x; allowed: one of rectangle, half-sine"),
    ],
)
def test_value_out_of_range_is_named(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        changed(BUSY, **change)
    assert str(caught.value) == message


def test_unknown_field_lists_the_known_ones() -> None:
    with pytest.raises(
        ScenarioError, match=r"^scenario: got robbot; allowed: the fields name, title, robot, "
    ):
        changed(BUSY, robbot="g1")
    with pytest.raises(ScenarioError, match=r"^pushes\[0\]: got angle; allowed: the fields force, "):
        changed(BUSY, pushes=[{"angle": 3}])


def test_a_second_robot_differs_in_nothing_but_what_is_written() -> None:
    linear, angular = sides(load_scenario("fig7"))
    assert (linear.priority, angular.priority) == (0.0, 1.0)
    assert changed(angular, priority=linear.priority) == linear
    assert sides(BUSY) == (BUSY,)


def test_another_controller_beside_starts_with_its_own_gains() -> None:
    scenario = changed(BUSY, beside={"controller": "slack-qp", "gains": {"com_weight": 2.0}})
    first, second = sides(scenario)
    assert first == BUSY
    assert (second.controller, second.gains) == ("slack-qp", {"com_weight": 2.0})
    same = changed(BUSY, beside={"gains": {"angular_damping": 4.0}})
    assert sides(same)[1].gains == {"linear_damping": 9.5, "angular_damping": 4.0}


@pytest.mark.parametrize("planner", PLANNERS)
@pytest.mark.parametrize("controller", CONTROLLERS)
def test_a_second_robot_from_the_start_has_the_choices_of_one_that_comes_later(controller, planner) -> None:
    """Above a controller that takes no planner the second robot goes its own way, in a file as in the lab."""
    beside = Beside(controller, 0.25)
    scenario = Scenario("two", planner=planner, beside=beside)
    first, second = (Choices.of(side) for side in sides(scenario))
    assert first.planner == planner
    assert second == first.beside(beside)


def test_checked_refuses_nan_that_slipped_past_the_ranges() -> None:
    assert checked(BUSY) is BUSY
    with pytest.raises(ScenarioError, match=r"^gains\.linear_damping: got nan; allowed: a finite number$"):
        checked(msgspec.structs.replace(BUSY, gains={"linear_damping": math.nan}))


@pytest.mark.parametrize("name", ["nope", "", "../secret", "x" * 5000])
def test_unknown_name_lists_the_known_ones(name: str) -> None:
    with pytest.raises(
        ScenarioError, match=r"^scenario: got .*; allowed: one of arm-swing, board, boat, bus, "
    ):
        load_scenario(name)


@pytest.mark.parametrize("name", ["missing.toml", "/nowhere/at/all.toml"])
def test_a_missing_file_is_called_missing(name: str) -> None:
    allowed = r"a \.toml file that can be read \(No such file or directory\)$"
    with pytest.raises(ScenarioError, match=f"^scenario: got {name}; allowed: {allowed}"):
        load_scenario(name)


@pytest.mark.parametrize("content", [b"\xff\xfe", b"name = ", b"a = 1\na = 2", b"a = " + b"[" * 5000])
def test_file_that_is_no_toml(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    path.write_bytes(content)
    with pytest.raises(ScenarioError, match=r"bad\.toml; allowed: a TOML file that describes a scenario \("):
        load_scenario(str(path))


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", "scenario in {}: got nothing; allowed: field name"),
        ('name = "x"\nseconds = nan', "seconds in {}: got nan; allowed: a finite number"),
        ('name = "x"\npushes = 3', "pushes in {}: got 3; allowed: list"),
        (
            'name = "x"\n[[pushes]]\nforce = "217N"',
            "pushes[0].force in {}: got 217N; allowed: number | nothing",
        ),
    ],
)
def test_fault_in_a_file_is_named_with_the_file(content: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    path.write_text(content)
    with pytest.raises(ScenarioError) as caught:
        load_scenario(str(path))
    assert str(caught.value) == message.format(path)
