from __future__ import annotations

from pathlib import Path

import pytest

from momentum_lab.errors import RobotError
from momentum_lab.robot.catalog import load_spec, robot_names
from tests.robot.conftest import CATALOG, WriteBiped


def test_the_catalog_has_exactly_these_robots() -> None:
    assert robot_names() == list(CATALOG)


@pytest.mark.parametrize("name", CATALOG)
def test_every_number_of_a_shipped_robot_has_a_source(name: str) -> None:
    spec = load_spec(name)
    assert spec.name == name
    needed = {"urdf", "soles", "home", "friction", "armature", "fall_points"}
    needed |= {name for name in ("motions", "limits") if getattr(spec, name)}
    # A trunk without a waist below it needs a reason.
    needed |= {"trunk"} if spec.trunk == spec.pelvis else set()
    assert set(spec.sources) == needed
    assert spec.trunk == spec.push_bodies["trunk"]
    assert {"pelvis", "trunk", "left_hand", "right_hand"} <= set(spec.push_bodies)
    assert ("head" in spec.push_bodies) == (name != "simple_humanoid"), "its neck ends at the shoulders"


@pytest.mark.parametrize("name", CATALOG)
def test_fall_points_are_few_and_on_both_sides(name: str) -> None:
    points = load_spec(name).fall_points
    assert all(1 <= len(of_link) <= 8 for of_link in points.values())
    assert 20 <= sum(len(of_link) for of_link in points.values()) <= 60


def test_a_file_beside_the_catalog_is_read_by_its_path(write_biped: WriteBiped) -> None:
    assert load_spec(str(write_biped())).title == "Biped"


def test_an_unknown_name_is_answered_with_the_known_ones() -> None:
    with pytest.raises(RobotError) as caught:
        load_spec("atlas")
    assert str(caught.value) == (
        "robot: got atlas; allowed: one of g1, human, icub, romeo, simple_humanoid, talos, "
        "or the path of a robot .toml"
    )


def test_a_path_to_nowhere_is_answered_like_an_unknown_name(tmp_path: Path) -> None:
    with pytest.raises(RobotError, match=r"nowhere\.toml; allowed: one of g1"):
        load_spec(str(tmp_path / "nowhere.toml"))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('name = "biped"', "name = biped", r"biped\.toml; allowed: a TOML file that describes a robot \("),
        ('trunk = "base"\nupper', 'torso = "base"\nupper', r"unknown field `torso`"),
        ('title = "Biped"\n', "", r"missing required field `title`"),
        ("foot_distance = 0.2", "foot_distance = -0.2", r"`float` > 0\.0 - at `\$\.home\.foot_distance`"),
        (
            "base_height = 0.8",
            'base_height = "tall"',
            r"Expected `float`, got `str` - at `\$\.home\.base_height`",
        ),
        ("x = [-0.08, 0.12]", "x = [0.12, -0.08]", r"x = \[lower, upper\] with lower < upper - at `\$\.feet"),
        ("y = [-0.04, 0.04]", "y = [0.04, 0.04]", r"y = \[lower, upper\] with lower < upper"),
        ("x = [-0.08, 0.12]", "x = [-0.08]", r"length 2"),
        ("[feet.right]", "[feet.left.more]", r"unknown field `more`"),
        (
            "base_height = 0.8",
            "base_height = inf",
            r"home\.base_height in .*: got inf; allowed: a finite number",
        ),
        (
            "[0.0, 0.0, -0.05]",
            "[0.0, 0.0, nan]",
            r"feet\.left\.offset in .*: got nan; allowed: a finite number",
        ),
        ("[push_bodies]", "[armature]\nneck = -1.0\n[push_bodies]", r"no armature may be negative"),
    ],
)
def test_what_is_wrong_with_a_file_is_said_in_one_line(
    write_biped: WriteBiped, old: str, new: str, message: str
) -> None:
    path = write_biped(spec=((old, new),))
    with pytest.raises(RobotError, match=message) as caught:
        load_spec(str(path))
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_robot_on_one_foot_is_no_humanoid(write_biped: WriteBiped) -> None:
    path = write_biped()
    text = path.read_text()
    path.write_text(text[: text.index("[feet.right]")] + text[text.index("[home]") :])
    with pytest.raises(RobotError, match="a humanoid has two feet, this one 1"):
        load_spec(str(path))


def test_bytes_that_are_no_text_are_no_robot(tmp_path: Path) -> None:
    path = tmp_path / "noise.toml"
    path.write_bytes(b"\xff\xfe\x00name")
    with pytest.raises(RobotError, match=r"noise\.toml; allowed: a TOML file that describes a robot"):
        load_spec(str(path))
