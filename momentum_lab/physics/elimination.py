"""Gauss's elimination for small square matrices that are not symmetric, in place and by rows."""

from __future__ import annotations

import numpy as np

from momentum_lab.compiled import compiled

_MATRIX, _VECTOR = "f8[:, ::1]", "f8[::1]"


@compiled(f"i8[::1]({_MATRIX})")
def eliminate(matrix: np.ndarray) -> np.ndarray:
    """Turn a matrix P (n, n) into its triangular factors L and U, in place; a singular one into infinities.

    Returns:
        The row that each row was exchanged with before its column was eliminated (n,).
    """
    size = len(matrix)
    pivots = np.empty(size, dtype=np.int64)
    for column in range(size):
        pivot = column
        for row in range(column + 1, size):
            if abs(matrix[row, column]) > abs(matrix[pivot, column]):
                pivot = row
        pivots[column] = pivot
        if pivot != column:
            for k in range(size):
                matrix[column, k], matrix[pivot, k] = matrix[pivot, k], matrix[column, k]
        scale = 1.0 / matrix[column, column]
        for row in range(column + 1, size):
            part = matrix[row, column] * scale
            matrix[row, column] = part
            for k in range(column + 1, size):
                matrix[row, k] -= part * matrix[column, k]
    return pivots


@compiled(f"void({_MATRIX}, i8[::1], {_VECTOR})")
def substitute(factors: np.ndarray, pivots: np.ndarray, vector: np.ndarray) -> None:
    """Replace a vector (n,) by P^-1 times itself, from what `eliminate` has made of P (n, n)."""
    size = len(factors)
    for row in range(size):
        vector[row], vector[pivots[row]] = vector[pivots[row]], vector[row]
    for row in range(size):
        known = 0.0
        for k in range(row):
            known += factors[row, k] * vector[k]
        vector[row] -= known
    for row in range(size - 1, -1, -1):
        known = 0.0
        for k in range(row + 1, size):
            known += factors[row, k] * vector[k]
        vector[row] = (vector[row] - known) / factors[row, row]
