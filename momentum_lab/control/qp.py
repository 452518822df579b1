"""Quadratic programs: build, solve, certify. DAQP in the loop, Clarabel as the independent reference."""

from __future__ import annotations

import math
from dataclasses import dataclass

import daqp
import numpy as np
import qpsolvers
from scipy.sparse import csc_matrix

from momentum_lab.control.optimality import judged_minimum, residuals
from momentum_lab.errors import SolverError

_EQUALITY = 5
_SOFT = 8
# What DAQP answers when bounds contradict each other, and when equalities do.
_INFEASIBLE = (-1, -6)
_REASONS = {
    -2: "it went in circles",
    -3: "the problem is unbounded",
    -4: "too many iterations",
    -5: "not convex",
}
_UNBOUNDED = 1e30
_NOTHING = np.zeros(0, dtype=bool)
Numbers = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]
# An answer is accepted when every condition of optimality holds to this, relative to the problem's own size.
CERTIFIED = 1e-6
# Clarabel's own 1e-8 leaves flat directions of Eq. 34 wrong in the fifth digit.
_REFERENCE = 1e-11


@dataclass(frozen=True, slots=True)
class QuadraticProgram:
    """min 1/2 x^T P x + c^T x subject to lower <= [x; G x] <= upper; equal bounds are equalities.

    Attributes:
        hessian: P (n, n), symmetric positive definite.
        gradient: c (n,).
        matrix: G (m, n); may have no rows.
        lower: bounds of the n variables, then of the m rows (n + m,); -inf where there is none.
        upper: likewise.
        labels: what each bound means, for messages: (number of bounds, meaning) in their order.
        soft: which bounds yield, at a price, where not all can be met (n + m,); None: none.
    """

    hessian: np.ndarray
    gradient: np.ndarray
    matrix: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    labels: tuple[tuple[int, str], ...] = ()
    soft: np.ndarray | None = None

    def values(self, x: np.ndarray) -> np.ndarray:
        """The bounded quantities [x; G x] (n + m,)."""
        return np.concatenate([x, self.matrix @ x])

    def label(self, index: int) -> str:
        """What one bound means."""
        for count, meaning in self.labels:
            if index < count:
                return meaning
            index -= count
        return f"bound {index}"


@dataclass(frozen=True, slots=True)
class Certificate:
    """How well an answer meets the conditions of optimality (Karush, Kuhn, Tucker).

    Attributes:
        primal: largest violation of a bound, in its unit; a soft bound that presses back does not count.
        dual: largest entry of P x + c + multipliers, relative to the largest of its terms.
        gap: sum of multipliers times the distance to the bounds they press from, relative likewise.
    """

    primal: float
    dual: float
    gap: float

    @property
    def worst(self) -> float:
        """The largest of the three; NaN when there is any."""
        return (
            math.nan
            if math.isnan(self.primal + self.dual + self.gap)
            else max(self.primal, self.dual, self.gap)
        )


@dataclass(frozen=True, slots=True)
class Solution:
    """A certified minimiser.

    Attributes:
        x: the minimiser (n,).
        multipliers: one per bound, positive at upper and negative at lower bounds (n + m,).
        certificate: the residuals it was accepted with.
    """

    x: np.ndarray
    multipliers: np.ndarray
    certificate: Certificate


def solve(problem: QuadraticProgram) -> Solution:
    """The minimiser, judged by its residuals, not by a solver's word.

    A program of a quiet tick presses against no inequality, so the minimiser on the equalities alone comes
    first: if it lies within all bounds, it is the answer. Otherwise DAQP's dual active set finds one.

    Raises:
        SolverError: there is no point within all bounds (the message names the bound that stands in the way),
            or the residuals are too large.
    """
    for road in (_on_equalities, _active_set):
        solution = road(problem)
        if solution.certificate.worst <= CERTIFIED:
            return solution
    raise SolverError(f"the solver's answer misses optimality by {solution.certificate.worst:.1e}")


def certify(problem: QuadraticProgram, x: np.ndarray, multipliers: np.ndarray) -> Certificate:
    """Residuals of the optimality conditions at x (n,) with multipliers (n + m,)."""
    return Certificate(*residuals(*_numbers(problem), x, multipliers))


def _numbers(problem: QuadraticProgram) -> Numbers:
    """The program as compiled functions take it."""
    soft = _NOTHING if problem.soft is None else problem.soft
    return problem.hessian, problem.gradient, problem.matrix, problem.lower, problem.upper, soft


def _on_equalities(problem: QuadraticProgram) -> Solution:
    """Minimiser and multipliers as if there were no inequalities; NaN if it is not unique.

    Variables with equal bounds are left to the other road.
    """
    x, multipliers, primal, dual, gap = judged_minimum(*_numbers(problem))
    return Solution(x, multipliers, Certificate(primal, dual, gap))


def _active_set(problem: QuadraticProgram) -> Solution:
    """Minimiser and multipliers by DAQP.

    Raises:
        SolverError: there is no point within all bounds, or DAQP gives up.
    """
    lower = np.maximum(problem.lower, -_UNBOUNDED)
    upper = np.minimum(problem.upper, _UNBOUNDED)
    sense = np.where(problem.lower == problem.upper, _EQUALITY, 0).astype(np.int32)
    if problem.soft is not None:
        sense[problem.soft] = _SOFT
    x, _, exit_flag, info = daqp.solve(problem.hessian, problem.gradient, problem.matrix, upper, lower, sense)
    if exit_flag in _INFEASIBLE:
        raise SolverError(_what_stands_in_the_way(problem))
    if exit_flag < 1:
        raise SolverError(f"the solver stopped without an answer: {_REASONS.get(exit_flag, exit_flag)}")
    return Solution(x, info["lam"], certify(problem, x, info["lam"]))


def solve_reference(problem: QuadraticProgram) -> np.ndarray:
    """The minimiser (n,) by Clarabel's interior point method: slow, and independent of `solve`.

    Bounds that yield for `solve` are firm here.

    Raises:
        SolverError: Clarabel finds no minimiser.
    """
    solution = qpsolvers.solve_problem(
        _as_qpsolvers(problem), solver="clarabel", tol_gap_abs=_REFERENCE, tol_gap_rel=_REFERENCE
    )
    if not solution.found or solution.x is None:
        raise SolverError("Clarabel finds no minimiser")
    return solution.x


def _as_qpsolvers(problem: QuadraticProgram) -> qpsolvers.Problem:
    size = problem.gradient.size
    every = np.vstack([np.eye(size), problem.matrix])
    equal = problem.lower == problem.upper
    above, below = ~equal & np.isfinite(problem.upper), ~equal & np.isfinite(problem.lower)
    return qpsolvers.Problem(
        csc_matrix(problem.hessian),
        problem.gradient,
        G=csc_matrix(np.vstack([every[above], -every[below]])),
        h=np.concatenate([problem.upper[above], -problem.lower[below]]),
        A=csc_matrix(every[equal]) if equal.any() else None,
        b=problem.upper[equal] if equal.any() else None,
    )


def _what_stands_in_the_way(problem: QuadraticProgram) -> str:
    """The bound that the point nearest to all bounds violates most, in words; bounds that yield are no reason."""
    size = problem.gradient.size
    every = np.vstack([np.eye(size), problem.matrix])
    rows = len(every)
    price = np.ones(rows) if problem.soft is None else np.where(problem.soft, 1e-4, 1.0)
    relaxed = QuadraticProgram(
        hessian=np.diag(np.concatenate([np.full(size, 1e-8), price])),
        gradient=np.zeros(size + rows),
        matrix=np.hstack([every, np.eye(rows)]),
        lower=np.concatenate([np.full(size + rows, -np.inf), problem.lower]),
        upper=np.concatenate([np.full(size + rows, np.inf), problem.upper]),
    )
    violation = np.abs(solve_reference(relaxed)[size:])
    if problem.soft is not None:
        violation[problem.soft] = 0.0
    worst = int(violation.argmax())
    return f"cannot be met: {problem.label(worst)} (short by {violation[worst]:.3g})"
