"""A robot's file as text: TOML with the reasons for looking at it again on top."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

import msgspec

from momentum_lab.robot.catalog import FootSpec, RobotSpec


def robot_toml(spec: RobotSpec, comments: Sequence[str] = ()) -> str:
    """A robot's specification as the text of its TOML file.

    Args:
        spec: the robot.
        comments: lines that are put on top.
    """
    lines = [f"# {comment}" for comment in comments]
    lines += [
        _line("name", spec.name),
        _line("title", spec.title),
        _line("urdf", spec.urdf),
        _line("pelvis", spec.pelvis),
        _line("trunk", spec.trunk),
        _line("upper_body", spec.upper_body),
        _line("friction", spec.friction),
    ]
    for name, foot in spec.feet.items():
        lines += _table(f"feet.{name}", _foot(foot))
    home = {"foot_distance": spec.home.foot_distance, "base_height": spec.home.base_height}
    lines += _table("home", home) + _table("home.joints", spec.home.joints)
    lines += _table("push_bodies", spec.push_bodies) + _table("armature", spec.armature)
    for joint, limit in spec.limits.items():
        lines += _table(f'limits."{joint}"', msgspec.to_builtins(limit))
    for motion, reach in spec.motions.items():
        lines += _table(f"motions.{motion}", reach)
    lines += _table("fall_points", spec.fall_points) + _table("sources", spec.sources)
    return "\n".join(lines) + "\n"


def _foot(foot: FootSpec) -> dict[str, object]:
    added: dict[str, object] = {}
    if foot.parent is not None:
        added = {"parent": foot.parent, "offset": foot.offset}
        if any(foot.rpy):
            added["rpy"] = foot.rpy
    return {"frame": foot.frame, **added, "x": foot.x, "y": foot.y, "joints": foot.joints}


def _table(name: str, content: Mapping[str, object]) -> list[str]:
    return ["", f"[{name}]", *(_line(key, value) for key, value in content.items())] if content else []


def _line(key: str, value: object) -> str:
    bare = key.replace("_", "").replace("-", "").isalnum() and key.isascii()
    return f"{key if bare else _text(key)} = {_value(value)}"


def _value(value: object) -> str:
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, float):
        return repr(value)
    if isinstance(value, Sequence):
        return f"[{', '.join(map(_value, value))}]"
    raise TypeError(f"no TOML for {value!r}")


def _text(text: str) -> str:
    """A basic string: JSON's escapes are TOML's, but for the delete character."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007F")
