"""What happened, tick by tick: a sample is one row of numbers with names, a recording is a ring of rows."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from momentum_lab.control.controller import SLACKS
from momentum_lab.errors import InputError
from momentum_lab.robot.model import RobotModel


@dataclass(frozen=True)
class Layout:
    """Which quantity stands where in a row.

    Attributes:
        shapes: name -> shape of the quantity in one sample.
        joint_names: the actuated joints, in the order of torques.
        foot_names: the feet, in the order of per-foot quantities.
    """

    shapes: dict[str, tuple[int, ...]]
    joint_names: tuple[str, ...]
    foot_names: tuple[str, ...]

    @classmethod
    def of(cls, robot: RobotModel) -> Layout:
        """The layout for a robot: F feet, linear before angular, world axes, SI.

        Wrenches of feet are about the sole frame's origin, ground on robot; the push and all other contacts
        about the world origin; momentum and its rates about the CoM; the pose of the plate under each foot is
        that of its middle. Slacks are those of `SLACKS`,
        0 where a law has none; the torque ratio is the largest torque that a controller asks for, as a part of
        its motor's limit.
        """
        feet = len(robot.soles)
        shapes: dict[str, tuple[int, ...]] = {
            "time": (),
            "q": (robot.nq,),
            "v": (robot.nv,),
            "torque": (robot.na,),
            "joint_stop_torque": (robot.na,),
            "com": (3,),
            "com_velocity": (3,),
            "momentum": (6,),
            "momentum_rate_desired": (6,),
            "momentum_rate_admissible": (6,),
            "momentum_rate_measured": (6,),
            "foot_wrench_measured": (feet, 6),
            "foot_wrench_admissible": (feet, 6),
            "sole_pose": (feet, 7),
            "ground_pose": (feet, 7),
            "cop_measured": (2,),
            "cop_admissible": (2,),
            "cop_desired": (2,),
            "cmp": (2,),
            "capture_point": (2,),
            "foot_cop_measured": (feet, 2),
            "push_wrench": (6,),
            "other_contact_wrench": (6,),
            "slack": (len(SLACKS),),
            "torque_ratio": (),
            "priority": (),
            "equation_residual": (),
            "contact_residual": (),
            "solver_failed": (),
            "fallen": (),
        }
        return cls(shapes, robot.joint_names, robot.foot_names)

    @property
    def slices(self) -> dict[str, slice]:
        """Name -> its part of a row."""
        ends = np.cumsum([math.prod(shape) for shape in self.shapes.values()]).tolist()
        return {name: slice(a, b) for name, a, b in zip(self.shapes, [0, *ends[:-1]], ends, strict=True)}

    @property
    def width(self) -> int:
        """Numbers in a row."""
        return sum(math.prod(shape) for shape in self.shapes.values())


class Sample:
    """One tick: the state at its time, and the torques and wrenches applied from there to the next."""

    __slots__ = ("_layout", "_slices", "row")

    def __init__(self, layout: Layout, slices: dict[str, slice], row: np.ndarray) -> None:
        self._layout = layout
        self._slices = slices
        self.row = row

    @classmethod
    def of(cls, layout: Layout, row: np.ndarray) -> Sample:
        """A row (width,) read with a layout."""
        return cls(layout, layout.slices, row)

    def __getitem__(self, name: str) -> np.ndarray:
        return self.row[self._slices[name]].reshape(self._layout.shapes[name])

    def number(self, name: str) -> float:
        """A quantity that is a single number."""
        return float(self.row[self._slices[name].start])


class Recording:
    """The last samples of a run.

    Args:
        layout: what a sample holds.
        capacity: how many samples are kept; the oldest give way.
    """

    def __init__(self, layout: Layout, capacity: int) -> None:
        self.layout = layout
        self.capacity = capacity
        self.slices = layout.slices
        # Rows that are never written cost no memory.
        self._rows = np.empty((capacity, layout.width))
        self._count = self._oldest = self._reserved = 0

    def __len__(self) -> int:
        return self._count - self._first

    @property
    def _first(self) -> int:
        """Number of the oldest sample that is kept."""
        return max(self._oldest, self._count - self.capacity)

    def reserve(self, samples: int) -> None:
        """Touch the memory of so many more samples now: a page that a tick touches first makes that tick late."""
        start = max(self._reserved, self._count)
        self._rows[start : start + samples].fill(np.nan)
        self._reserved = start + samples

    def next_row(self) -> np.ndarray:
        """Room for one more sample (width,), to be filled at once."""
        row = self._rows[self._count % self.capacity]
        self._count += 1
        return row

    def rows(self, every: int = 1) -> np.ndarray:
        """All rows that are kept, oldest first (n, width); of `every` rows only the first."""
        if not len(self):
            return self._rows[:0]
        start, end = self._first % self.capacity, (self._count - 1) % self.capacity + 1
        if start < end:
            return self._rows[start:end:every]
        return np.concatenate([self._rows[start:], self._rows[:end]])[::every]

    def column(self, name: str, every: int = 1) -> np.ndarray:
        """One quantity over time, oldest first (n, *shape)."""
        rows = self.rows(every)
        return rows[:, self.slices[name]].reshape(len(rows), *self.layout.shapes[name])

    @property
    def latest(self) -> Sample:
        """The last sample."""
        if not self._count:
            raise InputError("recording", "no samples", "a recording of at least one tick")
        return self.before_end(0)

    def before_end(self, samples: int) -> Sample:
        """The sample so many before the last one.

        Raises:
            InputError: so many are not kept.
        """
        if not 0 <= samples < len(self):
            raise InputError("recording", f"the sample {samples} before the last", f"one of {len(self)}")
        return Sample(self.layout, self.slices, self._rows[(self._count - 1 - samples) % self.capacity])

    def forget_last(self, samples: int) -> None:
        """Forget so many samples at the end; those that have given way to them do not come back."""
        self._oldest = self._first
        self._count = max(self._oldest, self._count - samples)

    def clear(self) -> None:
        """Forget all samples."""
        self._count = self._oldest = 0
