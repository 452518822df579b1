"""The ground: a plate under each foot, still or moving, and a floor under everything else."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass, field

import numpy as np
from msgspec.structs import replace

from momentum_lab.errors import InputError
from momentum_lab.momentum.foot_ground import FootGround
from momentum_lab.physics.plate import (
    MAX_FRICTION,
    MAX_MOTIONS,
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


@dataclass(frozen=True, slots=True)
class FootMotion:
    """A motion of the plate under one foot.

    Attributes:
        foot: index of the foot.
        motion: the motion.
        pivot: the point that a turn leaves where it is (3,), m.
    """

    foot: int
    motion: PlateMotion
    pivot: np.ndarray


class Ground:
    """Everything the robot can touch, at any time of a run.

    Args:
        under_feet: the plate under each foot before anything moves, its origin where the foot is, in the robot's
            order of feet.
        floor: the plane under every other body; it gives way to plates that go lower.
        facing: axes in which motions are given (3, 3).
        motions: how the plates move.
        changes: (foot, change) for each change of friction.
        stance: the feet whose plates make the mean height; empty: all.

    Raises:
        InputError: plates would go too far, or there are too many motions.
    """

    def __init__(
        self,
        under_feet: tuple[Patch, ...],
        floor: Patch,
        facing: np.ndarray | None = None,
        motions: tuple[FootMotion, ...] = (),
        changes: tuple[tuple[int, FrictionChange], ...] = (),
        stance: tuple[int, ...] = (),
    ) -> None:
        self.under_feet = under_feet
        self.facing = np.eye(3) if facing is None else np.ascontiguousarray(facing)
        self.motions = tuple(sorted(motions, key=lambda moving: not moving.motion.turns))
        self.changes = tuple(sorted(changes, key=lambda change: change[1].start))
        self._stance = list(stance or range(len(under_feet)))
        _check(self.motions)
        self.floor = _lowered(floor, under_feet, self.motions)
        position = np.array([patch.origin for patch in under_feet])
        rest = FootGround.still(position, np.array([patch.rotation for patch in under_feet]))
        self._rest = dataclasses.replace(rest, height=self._height(position))
        self._courses = np.array([course_row(m.foot, m.motion, m.pivot) for m in self.motions])
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
        return FootGround(*moved, height=self._height(moved[0]))

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
        """The same ground with one more motion under some feet, as if they stood on one plate.

        Raises:
            InputError: the plates would go too far, or there are too many motions.
        """
        pivot = np.mean([self.under_feet[foot].origin for foot in feet], axis=0)
        return self._with(motions=(*self.motions, *(FootMotion(foot, motion, pivot) for foot in feet)))

    def coming_to_rest(self, time: float) -> Ground:
        """The same ground whose swaying plates come to rest within a period from a time of the run on, s."""
        return self._with(motions=tuple(_ending(m, time) for m in self.motions if not _is_to_come(m, time)))

    def as_slippery_as(self, friction: float, feet: tuple[int, ...], time: float) -> Ground:
        """The same ground with another friction under some feet from a time of the run on, s."""
        kept = tuple(
            (foot, change) for foot, change in self.changes if foot not in feet or change.start < time
        )
        return self._with(changes=(*kept, *((foot, FrictionChange(friction, time)) for foot in feet)))

    @classmethod
    def level(cls, feet: int, friction: float, height: float = 0.0) -> Ground:
        """One level plane at a height (m) under everything."""
        plane = Patch(friction, origin=np.array([0.0, 0.0, height]))
        return cls(under_feet=(plane,) * feet, floor=plane)

    def _height(self, position: np.ndarray) -> float:
        return float(position[self._stance, 2].mean())

    def _with(
        self,
        motions: tuple[FootMotion, ...] | None = None,
        changes: tuple[tuple[int, FrictionChange], ...] | None = None,
    ) -> Ground:
        return Ground(
            self.under_feet,
            self.floor,
            self.facing,
            self.motions if motions is None else motions,
            self.changes if changes is None else changes,
            tuple(self._stance),
        )


def checked_friction(value: float) -> float:
    """The coefficient, if it is one.

    Raises:
        InputError: it is not above 0, or too large.
    """
    if not 0.0 < value <= MAX_FRICTION:
        raise InputError("friction", value, f"above 0 to {MAX_FRICTION:g}")
    return value


def check_motion(motion: PlateMotion) -> None:
    """Refuse a motion that is too fast or goes too far.

    Raises:
        InputError: says which of its fields, and what is allowed.
    """
    if not MIN_PERIOD <= motion.period <= MAX_PERIOD:
        raise InputError("period", motion.period, f"from {MIN_PERIOD:g} to {MAX_PERIOD:g} s")
    largest, unit = _largest(motion)
    if not abs(motion.amplitude) <= largest:
        raise InputError(
            "amplitude", motion.amplitude, f"from {-largest:g} to {largest:g} {unit} of {motion.axis}"
        )


def _check(motions: tuple[FootMotion, ...]) -> None:
    """Refuse motions that are too many, or that together take a plate too far."""
    for moving in motions:
        check_motion(moving.motion)
        way = farthest(
            [m.motion for m in motions if m.foot == moving.foot and m.motion.axis == moving.motion.axis]
        )
        largest, unit = _largest(moving.motion)
        if way > largest * (1.0 + 1e-9):
            raise InputError(
                "ground", f"{way:g} {unit} of {moving.motion.axis} in all", f"at most {largest:g} {unit}"
            )
    if len(motions) > MAX_MOTIONS:
        raise InputError(
            "ground", f"{len(motions)} motions", f"at most {MAX_MOTIONS}: stand up again to begin anew"
        )


def farthest(motions: list[PlateMotion]) -> float:
    """How far motions along or about one axis can take a plate together, in the unit of their amplitude."""
    steps = sorted((m for m in motions if m.course == "step"), key=lambda motion: motion.start)
    reached = np.cumsum([0.0, *(step.amplitude for step in steps)])
    return float(np.abs(reached).max()) + sum(abs(m.amplitude) for m in motions if m.course == "sine")


def _largest(motion: PlateMotion) -> tuple[float, str]:
    return (MAX_TURN, "degrees") if motion.turns else (MAX_SWING, "m")


def _lowered(floor: Patch, under_feet: tuple[Patch, ...], motions: tuple[FootMotion, ...]) -> Patch:
    """The floor, as low as the lowest place under a foot ever gets."""
    lowest = float(floor.origin[2])
    for foot in {moving.foot for moving in motions}:
        mine = [moving for moving in motions if moving.foot == foot]
        origin, way = under_feet[foot].origin, farthest([m.motion for m in mine if m.motion.axis == "z"])
        for moving in mine:
            if moving.motion.turns:
                lever = float(np.linalg.norm(origin - moving.pivot))
                way += lever * math.sin(math.radians(abs(moving.motion.amplitude)))
        lowest = min(lowest, float(origin[2]) - way)
    if lowest == floor.origin[2]:
        return floor
    return dataclasses.replace(floor, origin=np.array([*floor.origin[:2], lowest]))


def _is_to_come(moving: FootMotion, time: float) -> bool:
    """Whether a sway has not begun yet."""
    return moving.motion.course == "sine" and moving.motion.start >= time


def _ending(moving: FootMotion, time: float) -> FootMotion:
    """The motion; a sway that goes on comes to rest within a period."""
    motion = moving.motion
    if motion.course == "step" or (motion.stop is not None and motion.stop <= time + motion.period):
        return moving
    return dataclasses.replace(moving, motion=replace(motion, stop=time + motion.period))
