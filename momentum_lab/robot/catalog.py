"""Named robots: the TOML files of assets/robots, read and checked."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import msgspec

from momentum_lab.errors import RobotError
from momentum_lab.paths import ASSETS

Positive = Annotated[float, msgspec.Meta(gt=0.0)]
Range = tuple[float, float]
Point = tuple[float, float, float]

ROBOT_FOLDER = ASSETS / "robots"


class FootSpec(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One foot: a sole frame and the rectangle of it that touches the ground.

    Attributes:
        frame: name of the sole frame, z along the sole's outward-up normal, x towards the toes.
        x: rear and front edge in the sole frame, m.
        y: right and left edge in the sole frame, m.
        joints: patterns (shell style) of the joints between pelvis and foot.
        parent: link the sole frame is added to when the URDF has none.
        offset: origin of the added frame in the parent link's frame, m.
        rpy: roll, pitch and yaw of the added frame in the parent link's frame, rad.
    """

    frame: str
    x: Range
    y: Range
    joints: tuple[str, ...]
    parent: str | None = None
    offset: Point = (0.0, 0.0, 0.0)
    rpy: Point = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        for axis, (lower, upper) in (("x", self.x), ("y", self.y)):
            if not lower < upper:
                raise ValueError(f"the sole rectangle needs {axis} = [lower, upper] with lower < upper")


class HomeSpec(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Where the inverse kinematics of the standing posture starts from and what it keeps.

    Attributes:
        foot_distance: lateral distance between the two sole origins, m.
        base_height: height of the pelvis above the ground to aim for, m.
        joints: patterns of joint names -> angle, rad; the later pattern wins.
    """

    foot_distance: Positive
    base_height: Positive
    joints: dict[str, float] = {}


class LimitSpec(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """What the lab takes instead of a limit that the URDF lacks or has wrong; None: the URDF's.

    Attributes:
        lower: smallest angle or position, rad or m.
        upper: largest angle or position, rad or m.
        effort: largest torque or force, N m or N.
    """

    lower: float | None = None
    upper: float | None = None
    effort: Positive | None = None


class RobotSpec(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A humanoid as the lab needs to know it; one TOML file.

    Attributes:
        name: the name on the command line.
        title: the name on the screen.
        urdf: path relative to the robot-data package, or absolute.
        pelvis: frame whose orientation is held by the pelvis term.
        trunk: link that is pushed unless another body is named.
        upper_body: patterns of the joints that follow the posture reference of Eq. 34.
        feet: the two feet, in the order of every per-foot array.
        home: the standing posture to solve for.
        push_bodies: names on the screen -> links that may be pushed.
        friction: Coulomb coefficient between sole and ground.
        armature: patterns of joint names -> rotor inertia seen at the joint, kg m^2; the later pattern wins.
        limits: patterns of joint names -> limits that replace the URDF's; the later pattern wins.
        motions: name of a motion -> patterns of joint names -> how far they go in it, rad.
        fall_points: link -> points in its frame that may hit the ground, m.
        sources: where each number comes from, in words.
    """

    name: str
    title: str
    urdf: str
    pelvis: str
    trunk: str
    upper_body: tuple[str, ...]
    feet: dict[str, FootSpec]
    home: HomeSpec
    push_bodies: dict[str, str]
    friction: Annotated[float, msgspec.Meta(gt=0.0, le=2.0)] = 0.7
    armature: dict[str, float] = {}
    limits: dict[str, LimitSpec] = {}
    motions: dict[str, dict[str, float]] = {}
    fall_points: dict[str, tuple[Point, ...]] = {}
    sources: dict[str, str] = {}

    def __post_init__(self) -> None:
        if len(self.feet) != 2:
            raise ValueError(f"a humanoid has two feet, this one {len(self.feet)}")
        if any(inertia < 0.0 for inertia in self.armature.values()):
            raise ValueError("no armature may be negative")


def robot_names() -> list[str]:
    """Names of all robots in assets/robots, sorted."""
    return sorted(path.stem for path in ROBOT_FOLDER.glob("*.toml"))


def load_spec(name: str) -> RobotSpec:
    """The specification of a robot in the catalog, or of the TOML file at a path.

    Args:
        name: a name of `robot_names()`, or a path that ends in .toml.

    Raises:
        RobotError: the name is not in the catalog, or the file cannot be read or is no robot.
    """
    path = Path(name) if name.endswith(".toml") else ROBOT_FOLDER / f"{name}.toml"
    if not path.is_file():
        raise RobotError("robot", name, f"one of {', '.join(robot_names())}, or the path of a robot .toml")
    try:
        spec = msgspec.toml.decode(path.read_bytes(), type=RobotSpec)
    except (msgspec.DecodeError, OSError, ValueError) as error:
        raise RobotError("robot", path, f"a TOML file that describes a robot ({error})") from error
    for key, number in _numbers(msgspec.to_builtins(spec)):
        if not math.isfinite(number):
            raise RobotError(f"{key} in {path}", number, "a finite number")
    return spec


def _numbers(tree: object, key: str = "") -> Iterator[tuple[str, float]]:
    """Every number in nested dicts and lists, with the dotted key that leads to it."""
    if isinstance(tree, float):
        yield key, tree
    elif isinstance(tree, dict):
        for name, branch in tree.items():
            yield from _numbers(branch, f"{key}.{name}" if key else str(name))
    elif isinstance(tree, (list, tuple)):
        for branch in tree:
            yield from _numbers(branch, key)
