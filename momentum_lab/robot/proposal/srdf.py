"""What an SRDF beside the URDF says: a half-sitting posture and the size of the feet."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass, field
from pathlib import Path

# Length, width, centre relative to the ankle (x, y), height of the ankle; m.
FootSize = tuple[float, float, tuple[float, float], float]


@dataclass(frozen=True, slots=True)
class Semantics:
    """The part of an SRDF that a standing robot needs.

    Attributes:
        file: name of the SRDF; empty if there is none.
        state: name of its posture; empty if there is none.
        angles: joint -> angle in that posture, rad.
        feet: sizes of the left and the right foot, where they are given.
    """

    file: str = ""
    state: str = ""
    angles: dict[str, float] = field(default_factory=dict)
    feet: tuple[FootSize | None, FootSize | None] = (None, None)


def read_semantics(urdf: Path) -> Semantics:
    """The SRDF in the folder `srdf` beside that of the URDF, of the same name or the beginning of it."""
    found = [path for path in (urdf.parent.parent / "srdf").glob("*.srdf") if urdf.stem.startswith(path.stem)]
    if not found:
        return Semantics()
    path = max(found, key=lambda each: len(each.stem))
    try:
        root = ET.parse(path).getroot()
        state = _state(root)
        angles = {} if state is None else _angles(state)
        feet = _foot(root, "left"), _foot(root, "right")
    except (ET.ParseError, OSError, ValueError):
        return Semantics()
    return Semantics(path.name, "" if state is None else state.get("name", ""), angles, feet)


def _state(root: ET.Element) -> ET.Element | None:
    states = {state.get("name", ""): state for state in root.findall("group_state")}
    return next(
        (states[name] for name in ("half_sitting", "standing", "home", "stand") if name in states), None
    )


def _angles(state: ET.Element) -> dict[str, float]:
    """Joints with one angle each; a base with seven numbers is left out."""
    values = {joint.get("name", ""): (joint.get("value") or "").split() for joint in state.findall("joint")}
    return {name: float(numbers[0]) for name, numbers in values.items() if len(numbers) == 1}


def _foot(root: ET.Element, side: str) -> FootSize | None:
    """The size along x is called width there, along y height."""
    size = root.find(f"specificities/feet/{side}/size")
    ankle = root.find(f"specificities/feet/{side}/anklePosition")
    if size is None or ankle is None:
        return None
    length, width = float(size.get("width", 0)), float(size.get("height", 0))
    x, y, z = (float(ankle.get(axis, 0)) for axis in "xyz")
    return (length, width, (-x, -y), z) if length > 0.0 and width > 0.0 and z > 0.0 else None
