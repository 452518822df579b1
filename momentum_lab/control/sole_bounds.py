"""How much of each bound of a foot a wrench uses: of what a controller trusts in, and of what the ground bears.

The part that is used is 1 at the bound: |f_t| / (mu f_z) for a friction cone, x / X for a CoP in a rectangle.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from momentum_lab.control.computed_torque import YAW_LEVER
from momentum_lab.control.foot_forces import FACETS
from momentum_lab.control.wrench_cone import wrench_cone
from momentum_lab.momentum.support import inset_rectangle
from momentum_lab.momentum.wrench import shift_wrench
from momentum_lab.robot.model import Sole

TOES, HEEL, LEFT, RIGHT = (
    "CoP on the toes",
    "CoP on the heel",
    "CoP on the left edge",
    "CoP on the right edge",
)
FRICTION, TWIST, LEAST = "friction limit", "friction limit of a twist", "normal force at its least"

Used = dict[str, float]
Cone = Literal["corners", "square", "facets", "upright"]
_LEAST_LEVER = 1e-3
# Rows of `wrench_cone` from the first one against a twist on.
_TWISTS = 9


@dataclass(frozen=True, slots=True)
class Trust:
    """What a controller takes for granted of the ground under a foot.

    Attributes:
        border: how far inside the edge of the sole the CoP stays, m.
        friction: Coulomb coefficient.
        least_force: least normal force of a carrying foot, N; 0: there is none.
        cone: what bounds the tangential force and the twist: `corners` (`wrench_cone`), `square` (its pyramid
            alone), `facets` (eight of them, and a lever for the twist), `upright` (the cone about the vertical,
            and the lever: a single foot of computed torque carries the net force).
    """

    border: float
    friction: float
    least_force: float
    cone: Cone


def trust_of(controller: str, gains: Mapping[str, float], weight: float, carrying: int) -> Trust | None:
    """What a controller trusts the ground with; None for one that does not look at foot forces.

    Args:
        controller: its name.
        gains: its gains.
        weight: m g, N.
        carrying: how many feet it counts on.
    """
    if "friction" not in gains or "safe_border" not in gains:
        return None
    cone: Cone = "corners" if "least_foot_force" in gains else "square"
    if controller == "computed-torque":
        cone = "facets" if carrying > 1 else "upright"
    least = gains.get("least_foot_force", 0.0) * weight if cone in ("corners", "facets") else 0.0
    return Trust(gains["safe_border"], gains["friction"], least, cone)


def used_of_trust(wrench: np.ndarray, rotation: np.ndarray, sole: Sole, trust: Trust) -> Used:
    """How much of a controller's bounds a wrench uses.

    Args:
        wrench: [f; n] about the sole's origin, world axes (6,), N and N m; it presses on the sole.
        rotation: axes of the sole in the world (3, 3).
        sole: the sole.
        trust: what the controller trusts in.
    """
    lower, upper = inset_rectangle(sole.lower, sole.upper, trust.border)
    about = about_middle(wrench, rotation, sole)
    used = used_edges(about, (upper - lower) / 2.0)
    f, fz = about[:3], float(about[2])
    if trust.least_force:
        used[LEAST] = trust.least_force / fz
    if trust.cone in ("corners", "square"):
        used[FRICTION] = math.sqrt(2.0) * float(np.abs(f[:2]).max()) / (trust.friction * fz)
    if trust.cone == "corners":
        x_half, y_half = ((upper - lower) / 2.0).tolist()
        rows = wrench_cone(x_half, y_half, trust.friction, trust.least_force)[0][_TWISTS:].copy()
        limit = -rows[0, 2] * fz
        rows[:, 2] = 0.0
        used[TWIST] = float((rows @ about).max()) / limit
    if trust.cone == "facets":
        angle = 2.0 * math.pi * np.arange(FACETS) / FACETS
        across = np.cos(angle) * f[0] + np.sin(angle) * f[1]
        used[FRICTION] = float(across.max()) / (trust.friction * math.cos(math.pi / FACETS) * fz)
    if trust.cone == "upright":  # the controller's cone is upright, whatever the foot stands on
        used[FRICTION] = math.hypot(wrench[0], wrench[1]) / (trust.friction * float(wrench[2]))
    if trust.cone in ("facets", "upright"):
        used[TWIST] = abs(twist(about)) / (YAW_LEVER * trust.friction * fz)
    return used


def used_of_ground(wrench: np.ndarray, rotation: np.ndarray, sole: Sole, friction: float) -> Used:
    """How much a wrench uses of what the ground itself bears: the whole sole, and the whole cone.

    Force and twist share the friction: (|f_t| / (mu f_z))^2 + (|n| / (mu f_z r))^2 is 1 where a sole slides, turns,
    or does both, with n the moment about the normal through the CoP and r the mean distance of the corners from it.

    Args:
        wrench: [f; n] about the sole's origin, world axes (6,), N and N m; it presses on the sole.
        rotation: axes of the sole in the world (3, 3).
        sole: the sole.
        friction: Coulomb coefficient of the ground.
    """
    about, half = about_middle(wrench, rotation, sole), (sole.upper - sole.lower) / 2.0
    largest = friction * float(about[2])
    slides, turns = (
        math.hypot(about[0], about[1]) / largest,
        abs(twist(about)) / (largest * _lever(about, half)),
    )
    return {**used_edges(about, half), FRICTION: math.hypot(slides, turns)}


def used_edges(about: np.ndarray, half: np.ndarray) -> Used:
    """How far the CoP of a wrench (6,) about a rectangle's middle is to each edge; half of its sides (2,), m."""
    x, y = -about[4] / about[2], about[3] / about[2]
    return {TOES: x / half[0], HEEL: -x / half[0], LEFT: y / half[1], RIGHT: -y / half[1]}


def about_middle(wrench: np.ndarray, rotation: np.ndarray, sole: Sole) -> np.ndarray:
    """A wrench (6,) about a sole's origin, world axes, as one about the middle of its rectangle, sole axes."""
    middle = np.append((sole.lower + sole.upper) / 2.0, 0.0)
    local = (wrench.reshape(2, 3) @ rotation).ravel()
    return shift_wrench(local, np.zeros(3), middle)


def _lever(about: np.ndarray, half: np.ndarray) -> float:
    """Mean distance of a rectangle's corners from the CoP of a wrench (6,), weighed by the load of each, m.

    The corners at (+-X, +-Y) carry (1 +- x / X) (1 +- y / Y) / 4 of f_z, the simplest loads with that CoP. A foot
    on one corner has no lever left, but rounding.
    """
    cop = np.array([-about[4], about[3]]) / about[2]
    part = cop / half
    lever = sum(
        0.25
        * (1.0 + i * part[0])
        * (1.0 + j * part[1])
        * math.hypot(i * half[0] - cop[0], j * half[1] - cop[1])
        for i in (1, -1)
        for j in (1, -1)
    )
    return max(lever, _LEAST_LEVER)


def twist(about: np.ndarray) -> float:
    """Moment of a wrench (6,) about the normal through its CoP, N m."""
    x, y = -about[4] / about[2], about[3] / about[2]
    return float(about[5] - (x * about[1] - y * about[0]))
