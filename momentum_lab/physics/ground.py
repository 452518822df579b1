"""The ground: a plane under each foot and a floor under everything else."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np


@dataclass(frozen=True, slots=True)
class Patch:
    """One plane of ground.

    Attributes:
        friction: Coulomb coefficient between the plane and what stands on it.
        origin: a point of the plane in the world (3,), m.
        rotation: axes of the plane in the world (3, 3); the third column is its normal.
    """

    friction: float
    origin: np.ndarray = field(default_factory=lambda: np.zeros(3))
    rotation: np.ndarray = field(default_factory=lambda: np.eye(3))

    def gap(self, points: np.ndarray) -> np.ndarray:
        """Signed distance of points (..., 3) above the plane (...,), m."""
        return (points - self.origin) @ self.rotation[:, 2]


@dataclass(frozen=True, slots=True)
class Ground:
    """Everything the robot can touch.

    Attributes:
        under_feet: the plane under each foot, in the robot's order of feet.
        floor: the plane under every other body.
    """

    under_feet: tuple[Patch, ...]
    floor: Patch

    @property
    def height(self) -> float:
        """Height of the plane that the net CoP is measured on, m."""
        return float(self.floor.origin[2])

    @classmethod
    def level(cls, feet: int, friction: float, height: float = 0.0) -> Ground:
        """One level plane at a height (m) under everything."""
        plane = Patch(friction, origin=np.array([0.0, 0.0, height]))
        return cls(under_feet=(plane,) * feet, floor=plane)
