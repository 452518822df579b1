"""What the numbers of a sample are called, one by one, with their units."""

from __future__ import annotations

from collections.abc import Sequence

from momentum_lab.control.controller import SLACKS
from momentum_lab.recording import Layout

_XYZ = ("x", "y", "z")
_METRES = tuple((axis, "m") for axis in _XYZ)
_POSE = (*_METRES, *((f"q{axis}", "") for axis in (*_XYZ, "w")))
_WRENCH = (*((f"f{axis}", "N") for axis in _XYZ), *((f"m{axis}", "N m") for axis in _XYZ))
_RATE = (*((f"l{axis}", "N") for axis in _XYZ), *((f"k{axis}", "N m") for axis in _XYZ))
Part = tuple[str, str]
"""Name of a number within its quantity, and its unit."""

_PARTS: dict[str, Sequence[Part]] = {
    "time": (("", "s"),),
    "com": _METRES,
    "com_velocity": tuple((axis, "m/s") for axis in _XYZ),
    "momentum": (*((f"l{axis}", "kg m/s") for axis in _XYZ), *((f"k{axis}", "kg m^2/s") for axis in _XYZ)),
    "momentum_rate_desired": _RATE,
    "momentum_rate_admissible": _RATE,
    "momentum_rate_measured": _RATE,
    "foot_wrench_measured": _WRENCH,
    "foot_wrench_admissible": _WRENCH,
    "push_wrench": _WRENCH,
    "other_contact_wrench": _WRENCH,
    "sole_pose": _POSE,
    "ground_pose": _POSE,
    "cop_measured": _METRES[:2],
    "cop_admissible": _METRES[:2],
    "cop_desired": _METRES[:2],
    "cmp": _METRES[:2],
    "capture_point": _METRES[:2],
    "foot_cop_measured": _METRES[:2],
    "slack": tuple(
        (name.replace(" ", "_"), "m/s^2" if name.startswith("com") else "rad/s^2") for name in SLACKS
    ),
    # The largest of several numbers, not all of one unit.
    "equation_residual": (("", "N or N m"),),
    "contact_residual": (("", "m/s or N s"),),
}
# The base, before the joints.
_BASE_PLACE = tuple((f"base_{name}", unit) for name, unit in _POSE)
_BASE_SPEED = (
    *((f"base_v{axis}", "m/s") for axis in _XYZ),
    *((f"base_w{axis}", "rad/s") for axis in _XYZ),
)


def column_names(layout: Layout) -> list[str]:
    """Every number of a row, in its order: `torque/left_knee_joint [N m]`, `foot_wrench_measured/left/fz [N]`."""
    return [
        f"{path} [{unit}]" if unit else path
        for quantity, shape in layout.shapes.items()
        for path, unit in _named(layout, quantity, len(shape))
    ]


def _named(layout: Layout, quantity: str, axes: int) -> list[Part]:
    parts = _parts(layout, quantity)
    holders = [f"{quantity}/{foot}" for foot in layout.foot_names] if axes == 2 else [quantity]
    return [(f"{holder}/{name}" if name else holder, unit) for holder in holders for name, unit in parts]


def _parts(layout: Layout, quantity: str) -> Sequence[Part]:
    match quantity:
        case "q":
            return (*_BASE_PLACE, *_joints(layout, "rad"))
        case "v":
            return (*_BASE_SPEED, *_joints(layout, "rad/s"))
        case "torque" | "joint_stop_torque":
            return _joints(layout, "N m")
    return _PARTS.get(quantity, (("", ""),))


def _joints(layout: Layout, unit: str) -> list[Part]:
    return [(name, unit) for name in layout.joint_names]
