"""The ground: a plate under each foot, still or moving, and a floor under everything else."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from msgspec.structs import replace

from momentum_lab.errors import InputError
from momentum_lab.momentum.foot_ground import FootGround
from momentum_lab.physics.plate import (
    MAX_FRICTION,
    MAX_PERIOD,
    MAX_SWING,
    MAX_TURN,
    MIN_PERIOD,
    FrictionChange,
    PlateMotion,
)
from momentum_lab.physics.plate_motion import course_row, moved_plates


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


class Ground:
    """Everything the robot can touch, at any time of a run.

    Args:
        under_feet: the plate under each foot before anything moves, in the robot's order of feet.
        floor: the plane under every other body.
        facing: axes in which motions are given (3, 3).
        motions: (foot, motion) for each motion of the plate under a foot.
        changes: (foot, change) for each change of its friction.
    """

    def __init__(
        self,
        under_feet: tuple[Patch, ...],
        floor: Patch,
        facing: np.ndarray | None = None,
        motions: tuple[tuple[int, PlateMotion], ...] = (),
        changes: tuple[tuple[int, FrictionChange], ...] = (),
    ) -> None:
        self.under_feet = under_feet
        self.floor = floor
        self.facing = np.eye(3) if facing is None else np.ascontiguousarray(facing)
        self.motions = tuple((foot, _checked(motion)) for foot, motion in motions)
        self.changes = tuple(sorted(changes, key=lambda change: change[1].start))
        self._rest = FootGround.still(
            np.array([patch.origin for patch in under_feet]),
            np.array([patch.rotation for patch in under_feet]),
        )
        self._courses = np.array([course_row(foot, motion) for foot, motion in self.motions])
        self._friction = np.array([patch.friction for patch in under_feet])

    @property
    def is_floor(self) -> bool:
        """Whether the ground under the feet is nothing but the floor."""
        return not (self.motions or self.changes) and all(
            patch.friction == self.floor.friction
            and patch.origin[2] == self.floor.origin[2]
            and bool(np.array_equal(patch.rotation[:, 2], self.floor.rotation[:, 2]))
            for patch in self.under_feet
        )

    def at(self, time: float) -> FootGround:
        """The plates at a time of the run, s."""
        if not self.motions:
            return self._rest
        rest = self._rest
        moved = moved_plates(rest.position, rest.rotation, self.facing, self._courses, time)
        return FootGround(*moved, height=float(moved[0][:, 2].mean()))

    def friction(self, time: float) -> np.ndarray:
        """Coulomb coefficient under each foot at a time of the run, s (F,)."""
        if not self.changes:
            return self._friction
        friction = self._friction.copy()
        for foot, change in self.changes:
            if change.start <= time:
                friction[foot] = change.friction
        return friction

    def moving_too(self, feet: tuple[int, ...], motion: PlateMotion) -> Ground:
        """The same ground with one more motion of the plates under some feet."""
        motions = (*self.motions, *((foot, motion) for foot in feet))
        return Ground(self.under_feet, self.floor, self.facing, motions, self.changes)

    def coming_to_rest(self, time: float) -> Ground:
        """The same ground whose plates come to rest within a period of theirs from a time of the run on, s."""
        motions = tuple(
            (foot, replace(motion, stop=min(motion.stop or math.inf, time + motion.period)))
            if motion.course == "sine"
            else (foot, motion)
            for foot, motion in self.motions
            if motion.start < time
        )
        return Ground(self.under_feet, self.floor, self.facing, motions, self.changes)

    def as_slippery_as(self, friction: float, feet: tuple[int, ...], time: float) -> Ground:
        """The same ground with another friction under some feet from a time of the run on, s."""
        kept = tuple((foot, change) for foot, change in self.changes if foot not in feet)
        changes = (*kept, *((foot, FrictionChange(friction, time)) for foot in feet))
        return Ground(self.under_feet, self.floor, self.facing, self.motions, changes)

    @classmethod
    def level(cls, feet: int, friction: float, height: float = 0.0) -> Ground:
        """One level plane at a height (m) under everything."""
        plane = Patch(friction, origin=np.array([0.0, 0.0, height]))
        return cls(under_feet=(plane,) * feet, floor=plane)


def checked_friction(value: float) -> float:
    """The coefficient, if it is one.

    Raises:
        InputError: it is not above 0, or too large.
    """
    if not 0.0 < value <= MAX_FRICTION:
        raise InputError("friction", value, f"above 0 to {MAX_FRICTION:g}")
    return value


def _checked(motion: PlateMotion) -> PlateMotion:
    """The motion, if its amplitude is in range for its axis."""
    turning = motion.axis in ("roll", "pitch")
    largest, unit = (MAX_TURN, "degrees") if turning else (MAX_SWING, "m")
    if not MIN_PERIOD <= motion.period <= MAX_PERIOD:
        raise InputError("period", motion.period, f"from {MIN_PERIOD:g} to {MAX_PERIOD:g} s")
    if not abs(motion.amplitude) <= largest:
        raise InputError(
            "amplitude", motion.amplitude, f"from {-largest:g} to {largest:g} {unit} of {motion.axis}"
        )
    return motion
