"""The ground under each foot: a plate that may be tilted, and that may move."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from momentum_lab.compiled import compiled
from momentum_lab.momentum.wrench import cross

_MATRIX, _VECTOR = "f8[:, ::1]", "f8[::1]"


@dataclass(frozen=True, slots=True)
class FootGround:
    """One plate under each of F feet, at one instant; plates are rigid and endless.

    Attributes:
        position: a point of each plate (F, 3), m.
        rotation: axes of each plate in the world, its normal last (F, 3, 3).
        velocity: of that point and of the plate, linear before angular (F, 6), m/s and rad/s.
        acceleration: likewise (F, 6), m/s^2 and rad/s^2.
        height: mean height of the points: the plane that net CoP, CMP and capture point are measured on, m.
    """

    position: np.ndarray
    rotation: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    height: float

    @classmethod
    def still(cls, position: np.ndarray, rotation: np.ndarray) -> FootGround:
        """Plates at rest, at points (F, 3), m, with axes (F, 3, 3)."""
        rest = np.zeros((len(position), 6))
        return cls(position, rotation, rest, rest, float(position[:, 2].mean()))

    @classmethod
    def level(cls, feet: int, height: float = 0.0) -> FootGround:
        """One level floor at a height (m) under so many feet."""
        position = np.zeros((feet, 3))
        position[:, 2] = height
        return cls.still(position, np.tile(np.eye(3), (feet, 1, 1)))


@compiled(f"f8({_VECTOR}, {_MATRIX}, {_VECTOR})")
def distance_above(position: np.ndarray, rotation: np.ndarray, point: np.ndarray) -> float:
    """How far a point (3,) is above a plate, along its normal: n . (p - o), m.

    Args:
        position: o (3,), m.
        rotation: axes of the plate, n last (3, 3).
        point: p (3,), m.
    """
    distance = 0.0
    for i in range(3):
        distance += rotation[i, 2] * (point[i] - position[i])
    return distance


@compiled(f"f8({_VECTOR}, {_MATRIX}, f8, f8)")
def height_below(position: np.ndarray, rotation: np.ndarray, x: float, y: float) -> float:
    """Height of a plate where a vertical line pierces it, m.

    z = o_z - (n_x (x - o_x) + n_y (y - o_y)) / n_z.

    Args:
        position: o (3,), m.
        rotation: axes of the plate, n last, not vertical (3, 3).
        x: of the line, m.
        y: of the line, m.
    """
    rise = rotation[0, 2] * (x - position[0]) + rotation[1, 2] * (y - position[1])
    return position[2] - rise / rotation[2, 2]


@compiled(f"{_VECTOR}({_VECTOR}, {_VECTOR}, {_VECTOR})")
def velocity_at(point: np.ndarray, position: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """Velocity (6,) of a frame that a plate carries along: v_p = v + omega x (p - o), and omega.

    Args:
        point: p, the frame's origin (3,), m.
        position: o, a point of the plate (3,), m.
        velocity: of o and of the plate, v and omega (6,).
    """
    moving = velocity.copy()
    moving[:3] += cross(velocity[3:], point - position)
    return moving


@compiled(f"{_VECTOR}({_VECTOR}, {_VECTOR}, {_VECTOR}, {_VECTOR})")
def acceleration_at(
    point: np.ndarray, position: np.ndarray, velocity: np.ndarray, acceleration: np.ndarray
) -> np.ndarray:
    """Acceleration (6,) of a frame that a plate carries along.

    a_p = a + alpha x d + omega x (omega x d) with d = p - o, and alpha.

    Args:
        point: p, the frame's origin (3,), m.
        position: o, a point of the plate (3,), m.
        velocity: of o and of the plate, v and omega (6,).
        acceleration: likewise, a and alpha (6,).
    """
    changing, arm = acceleration.copy(), point - position
    changing[:3] += cross(acceleration[3:], arm) + cross(velocity[3:], cross(velocity[3:], arm))
    return changing
