"""The arithmetic of optimality: the minimum on a set of equalities, and how well an answer meets all conditions.

Both are about min 1/2 x^T P x + c^T x subject to lower <= [x; G x] <= upper, as in `QuadraticProgram`.
"""

from __future__ import annotations

import math

import numpy as np

from momentum_lab.cholesky import backward_substitute, factorize, forward_substitute
from momentum_lab.compiled import compiled

_MATRIX, _VECTOR = "f8[:, ::1]", "f8[::1]"


@compiled(f"UniTuple({_VECTOR}, 2)({_MATRIX}, {_VECTOR}, {_MATRIX}, {_VECTOR}, {_VECTOR})")
def minimum_on_equalities(
    hessian: np.ndarray, gradient: np.ndarray, matrix: np.ndarray, lower: np.ndarray, upper: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The minimiser where only rows with equal bounds count: P x + c + A^T nu = 0 and A x = b.

    With P = L L^T, y = L^-1 c and Y = L^-1 A^T: (Y^T Y) nu = -(b + Y^T y) and x = -L^-T (y + Y nu).

    Args:
        hessian: P (n, n).
        gradient: c (n,).
        matrix: G (m, n).
        lower: bounds of the n variables, then of the m rows (n + m,).
        upper: likewise; rows of A and b are where both are equal.

    Returns:
        x (n,) and multipliers (n + m,); NaN if P or A P^-1 A^T is singular.
    """
    size = gradient.size
    x, multipliers = np.full(size, np.nan), np.zeros(lower.size)
    equal = np.flatnonzero(lower[size:] == upper[size:])
    count = equal.size
    factor = hessian.copy()
    if not factorize(factor):
        return x, multipliers
    columns = np.empty((size, count + 1))
    for i in range(size):
        for j in range(count):
            columns[i, j] = matrix[equal[j], i]
        columns[i, count] = gradient[i]
    forward_substitute(factor, columns)
    schur, pressure = np.zeros((count, count)), np.zeros((count, 1))
    for i in range(size):
        for j in range(count):
            for k in range(j, count):
                schur[k, j] += columns[i, j] * columns[i, k]
            pressure[j, 0] -= columns[i, j] * columns[i, count]
    for j in range(count):
        pressure[j, 0] -= lower[size + equal[j]]
    if not factorize(schur):
        return x, multipliers
    forward_substitute(schur, pressure)
    nu = pressure[:, 0].copy()
    backward_substitute(schur, nu)
    for i in range(size):
        x[i] = -columns[i, count]
        for j in range(count):
            x[i] -= columns[i, j] * nu[j]
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
        inequality = lower[i] < upper[i]
        if pressure != 0.0 and inequality:
            gap += abs(pressure) * max(-above if pressure > 0.0 else -below, 0.0)
        if not (pressure != 0.0 and inequality and soft.size > 0 and soft[i]):
            worst = max(above, below)
            if not worst <= violation:
                violation = worst
    force = multipliers[:size].copy()
    for i in range(matrix.shape[0]):
        if multipliers[size + i] != 0.0:
            for j in range(size):
                force[j] += multipliers[size + i] * matrix[i, j]
    stationarity = curved = steep = far = 0.0
    for i in range(size):
        curvature = 0.0
        for j in range(size):
            curvature += hessian[i, j] * x[j]
        stationarity += (curvature + gradient[i] + force[i]) ** 2
        curved += curvature**2
        steep += gradient[i] ** 2
        far += x[i] ** 2
    scale = 1.0 + math.sqrt(max(curved, steep))
    return violation, math.sqrt(stationarity) / scale, gap / (scale * (1.0 + math.sqrt(far)))
