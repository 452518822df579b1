"""One numbered equation: what it says, where it is, what holds it, and how exactly it holds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from momentum_lab.robot.model import RobotModel

Residual = Callable[[RobotModel, int], float]
"""The largest difference between an equation's two sides on a robot, at a state drawn from a seed."""


@dataclass(frozen=True, slots=True)
class Equation:
    """A numbered equation of the chapter.

    Attributes:
        number: the chapter's, from 1 to 62.
        statement: what it says, in symbols, z up and linear before angular.
        function: dotted path, below `momentum_lab`, of what computes it.
        test: node id of a test that holds it.
        residual: what the function says against a second derivation; see `Residual`.
        tolerance: the residual that is still rounding, finite differences or a solver's accuracy.
        unit: of residual and tolerance; SI where linear and angular rows have one each, m g for wrenches and
            torques in parts of the weight (moments: times 1 m).
        erratum: what is wrong or incomplete as printed, None when nothing is.
    """

    number: int
    statement: str
    function: str
    test: str
    residual: Residual
    tolerance: float
    unit: str
    erratum: str | None = None
