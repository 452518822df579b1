"""The arithmetic of optimality: the minimum on a set of equalities, and how well an answer meets all conditions.

Both are about min 1/2 x^T P x + c^T x subject to lower <= [x; G x] <= upper, as in `QuadraticProgram`.
"""

from __future__ import annotations

import math

import numpy as np

from momentum_lab.cholesky import backward_substitute, factorize, forward_substitute, gram, solved
from momentum_lab.compiled import compiled

_MATRIX, _VECTOR = "f8[:, ::1]", "f8[::1]"


@compiled(f"UniTuple({_VECTOR}, 2)({_MATRIX}, {_VECTOR}, {_MATRIX}, {_VECTOR}, {_VECTOR})")
def minimum_on_equalities(
    hessian: np.ndarray, gradient: np.ndarray, matrix: np.ndarray, lower: np.ndarray, upper: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The minimiser where only rows with equal bounds count: P x + c + A^T nu = 0 and A x = b.

    With P = L L^T, y = L^-1 c and Y = A L^-T: (Y Y^T) nu = -(b + Y y) and x = -L^-T (y + Y^T nu).

    Args:
        hessian: P (n, n).
        gradient: c (n,).
        matrix: G (m, n).
        lower: bounds of the n variables, then of the m rows (n + m,).
        upper: likewise; rows of A and b are where both are equal.

    Returns:
        x (n,) and multipliers (n + m,); NaN if P or A P^-1 A^T is found not to be positive definite. Rounding can
        hide that rows of A depend on each other; the primal residual tells.
    """
    size = gradient.size
    x, multipliers = np.full(size, np.nan), np.zeros(lower.size)
    equal = np.flatnonzero(lower[size:] == upper[size:])
    count = equal.size
    factor = hessian.copy()
    if not factorize(factor):
        return x, multipliers
    rows = np.empty((count + 1, size))
    rows[:count], rows[count] = matrix[equal], gradient
    forward_substitute(factor, rows)
    products = gram(rows)
    schur, nu = products[:count, :count].copy(), -products[count, :count]
    for j in range(count):
        nu[j] -= lower[size + equal[j]]
    if not factorize(schur):
        return x, multipliers
    nu = solved(schur, nu)
    x[:] = -rows[count]
    for j in range(count):
        for i in range(size):
            x[i] -= rows[j, i] * nu[j]
    backward_substitute(factor, x)
    for j in range(count):
        multipliers[size + equal[j]] = nu[j]
    return x, multipliers


@compiled(
    f"UniTuple(f8, 3)({_MATRIX}, {_VECTOR}, {_MATRIX}, {_VECTOR}, {_VECTOR}, b1[::1], {_VECTOR}, {_VECTOR})"
)
def residuals(
    hessian: np.ndarray,
    gradient: np.ndarray,
    matrix: np.ndarray,
    lower: np.ndarray,
    upper: np.ndarray,
    soft: np.ndarray,
    x: np.ndarray,
    multipliers: np.ndarray,
) -> tuple[float, float, float]:
    """Primal, dual and complementarity residual of an answer: see `Certificate`.

    Args:
        hessian: P (n, n).
        gradient: c (n,).
        matrix: G (m, n).
        lower: bounds of the n variables, then of the m rows (n + m,).
        upper: likewise.
        soft: which bounds may yield when they press back (n + m,), or empty.
        x: the answer (n,).
        multipliers: one per bound (n + m,), positive at upper and negative at lower bounds.
    """
    size = x.size
    violation = gap = 0.0
    for i in range(lower.size):
        value = x[i] if i < size else 0.0
        if i >= size:
            for j in range(size):
                value += matrix[i - size, j] * x[j]
        above, below, pressure = value - upper[i], lower[i] - value, multipliers[i]
        if math.isnan(above) or math.isnan(below):
            return np.nan, np.nan, np.nan
        inequality = lower[i] < upper[i]
        if pressure != 0.0 and inequality:
            gap += abs(pressure) * max(-above if pressure > 0.0 else -below, 0.0)
        if not (pressure != 0.0 and inequality and soft.size > 0 and soft[i]):
            violation = max(violation, above, below)
    force = multipliers[:size].copy()
    for i in range(matrix.shape[0]):
        if multipliers[size + i] != 0.0:
            for j in range(size):
                force[j] += multipliers[size + i] * matrix[i, j]
    stationarity = largest = far = 0.0
    for i in range(size):
        curvature = 0.0
        for j in range(size):
            curvature += hessian[i, j] * x[j]
        left = abs(curvature + gradient[i] + force[i])
        if math.isnan(left):
            return left, left, left
        stationarity = max(stationarity, left)
        largest = max(largest, abs(curvature), abs(gradient[i]))
        far = max(far, abs(x[i]))
    scale = 1.0 + largest
    return violation, stationarity / scale, gap / (scale * (1.0 + far))


@compiled(
    f"Tuple(({_VECTOR}, {_VECTOR}, f8, f8, f8))({_MATRIX}, {_VECTOR}, {_MATRIX}, {_VECTOR}, {_VECTOR}, b1[::1])"
)
def judged_minimum(
    hessian: np.ndarray,
    gradient: np.ndarray,
    matrix: np.ndarray,
    lower: np.ndarray,
    upper: np.ndarray,
    soft: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, float, float, float]:
    """The minimiser on the equalities alone and its residuals on the whole program: two steps in one call.

    Shapes and units of the arguments are those of `residuals`.

    Returns:
        x (n,), multipliers (n + m,); primal, dual and complementarity residual, NaN without a unique minimiser.
    """
    x, multipliers = minimum_on_equalities(hessian, gradient, matrix, lower, upper)
    primal, dual, gap = residuals(hessian, gradient, matrix, lower, upper, soft, x, multipliers)
    return x, multipliers, primal, dual, gap
