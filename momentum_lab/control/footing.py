"""Where a robot's feet stand: what is left of their soles, seen from the CoM, and which soles are near the ground.

Every controller asks here first. What the ground then gives to these feet is another question; see
`momentum_lab.control.foot_forces`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from momentum_lab.control.foot_places import near_the_ground, placed_feet
from momentum_lab.momentum.foot_ground import FootGround
from momentum_lab.momentum.support import inset_rectangle
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics

# A sole this far above the ground, m, is no longer counted on; contact itself lifts less.
_IN_THE_AIR = 0.005


@dataclass(frozen=True, slots=True)
class SafeSoles:
    """The S stance soles without a border, and the ankles above them; the same in every tick.

    Attributes:
        names: how the feet are called.
        indices: which feet they are (S,).
        lower: rear right corners from the ankles, sole axes (S, 2), m.
        upper: front left corners likewise (S, 2), m.
        corners: corners in the sole frames, counter-clockwise (S, 4, 2), m.
        ankles: the ankles in the sole frames (S, 3), m.
    """

    names: tuple[str, ...]
    indices: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    corners: np.ndarray
    ankles: np.ndarray


@dataclass(frozen=True, slots=True)
class StanceFeet:
    """The S feet that carry the robot, as the controller sees them.

    Attributes:
        index: which feet.
        safe: their soles without a border, and their ankles.
        com_to_sole: from the CoM to the sole origins, world axes (S, 3), m.
        com_to_ankle: from the CoM to the ankles, world axes (S, 3), m.
        rotation: axes of the soles in the world (S, 3, 3).
        safe_polygon: support polygon of the safe rectangles, counter-clockwise (K, 2), m.
        height: mean height of the sole origins in the world, m.
    """

    index: tuple[int, ...]
    safe: SafeSoles
    com_to_sole: np.ndarray
    com_to_ankle: np.ndarray
    rotation: np.ndarray
    safe_polygon: np.ndarray
    height: float


class Footing:
    """The feet of a robot as places where the ground can push back.

    Args:
        robot: the robot.
    """

    def __init__(self, robot: RobotModel) -> None:
        self._soles = robot.soles
        self._ankles = np.array(
            [robot.model.frames[sole.frame].placement.inverse().translation for sole in robot.soles]
        )
        self._lower = np.array([sole.lower for sole in robot.soles])
        self._upper = np.array([sole.upper for sole in robot.soles])
        self._safe_soles = lru_cache(maxsize=16)(self._inset)

    def stance_feet(self, dynamics: Dynamics, stance: tuple[int, ...], border: float) -> StanceFeet:
        """The stance feet with what is left of their soles without a border (m)."""
        safe = self._safe_soles(stance, border)
        placed = placed_feet(
            safe.indices,
            dynamics.sole_position,
            dynamics.sole_rotation,
            dynamics.com_in_world,
            safe.ankles,
            safe.corners,
        )
        return StanceFeet(stance, safe, *placed)

    def on_the_ground(
        self, dynamics: Dynamics, stance: tuple[int, ...], ground: FootGround
    ) -> tuple[int, ...]:
        """The stance feet whose soles are near the ground: a foot in the air carries nothing.

        Args:
            dynamics: the state with everything computed.
            stance: the feet that are meant to carry, as indices.
            ground: the plates under the feet.
        """
        near = near_the_ground(
            dynamics.sole_position,
            dynamics.sole_rotation,
            self._lower,
            self._upper,
            ground.position,
            ground.rotation,
            _IN_THE_AIR,
        ).tolist()
        return tuple([foot for foot in stance if near[foot]])

    def _inset(self, stance: tuple[int, ...], border: float) -> SafeSoles:
        soles, ankles = [self._soles[foot] for foot in stance], self._ankles[list(stance)]
        rectangles = [inset_rectangle(sole.lower, sole.upper, border) for sole in soles]
        lower, upper = (np.array(corner) for corner in zip(*rectangles, strict=True))
        (rear, right), (front, left) = lower.T, upper.T
        corners = np.stack([(rear, right), (front, right), (front, left), (rear, left)]).transpose(2, 0, 1)
        return SafeSoles(
            names=tuple(sole.name for sole in soles),
            indices=np.array(stance),
            lower=lower - ankles[:, :2],
            upper=upper - ankles[:, :2],
            corners=corners.copy(),
            ankles=ankles,
        )
