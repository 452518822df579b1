"""The chapter's 62 numbered equations: where each is computed, what tests it, and how exactly it holds."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from momentum_lab.experiments.equations import (
    balance,
    bounds,
    cop,
    ground,
    links,
    momentum,
    motion,
    outputs,
    resolved,
    slack,
    torque,
)
from momentum_lab.experiments.equations.equation import Equation
from momentum_lab.robot.model import RobotModel

_ROOMS = (links, momentum, ground, resolved, motion, torque, balance, outputs, cop, bounds, slack)

EQUATIONS: tuple[Equation, ...] = tuple(
    sorted((each for room in _ROOMS for each in room.EQUATIONS), key=lambda each: each.number)
)
"""All equations in the chapter's order."""

SEED = 20190517
"""Of the states in which residuals are measured."""


@dataclass(frozen=True, slots=True)
class Measurement:
    """An equation on one robot.

    Attributes:
        equation: which one.
        residual: largest difference of its two sides, in the equation's unit.
    """

    equation: Equation
    residual: float

    @property
    def holds(self) -> bool:
        """Whether the residual is a number within the tolerance."""
        return self.residual <= self.equation.tolerance


def measured(robot: RobotModel, seed: int = SEED) -> Iterator[Measurement]:
    """Every equation on a robot, in the chapter's order; the same seed gives the same numbers.

    Args:
        robot: the robot.
        seed: of the states in which the equations are measured.
    """
    for equation in EQUATIONS:
        yield Measurement(equation, equation.residual(robot, seed))
