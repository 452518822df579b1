"""Cholesky factors of small matrices, in place and by rows: L with L L^T = P, L lower triangular."""

from __future__ import annotations

import math

import numpy as np

from momentum_lab.compiled import compiled

_MATRIX, _VECTOR = "f8[:, ::1]", "f8[::1]"


@compiled(f"boolean({_MATRIX})")
def factorize(matrix: np.ndarray) -> bool:
    """Turn a symmetric matrix P (n, n) into its factor L, in place; only the lower triangle is read and written.

    Returns:
        Whether the matrix is positive definite.
    """
    for column in range(len(matrix)):
        for row in range(column, len(matrix)):
            known = 0.0
            for k in range(column):
                known += matrix[row, k] * matrix[column, k]
            matrix[row, column] -= known
        pivot = matrix[column, column]
        if not pivot > 0.0:
            return False
        scale = 1.0 / math.sqrt(pivot)
        for row in range(column, len(matrix)):
            matrix[row, column] *= scale
    return True


@compiled(f"void({_MATRIX}, {_MATRIX})")
def forward_substitute(factor: np.ndarray, rows: np.ndarray) -> None:
    """Replace every row b of rows (k, n) by L^-1 b."""
    for i in range(len(factor)):
        scale = 1.0 / factor[i, i]
        for row in range(len(rows)):
            known = 0.0
            for k in range(i):
                known += factor[i, k] * rows[row, k]
            rows[row, i] = (rows[row, i] - known) * scale


@compiled(f"void({_MATRIX}, {_VECTOR})")
def backward_substitute(factor: np.ndarray, vector: np.ndarray) -> None:
    """Replace a vector (n,) by L^-T times itself."""
    for row in range(len(factor) - 1, -1, -1):
        vector[row] /= factor[row, row]
        for above in range(row):
            vector[above] -= factor[row, above] * vector[row]


@compiled(f"{_VECTOR}({_MATRIX}, {_VECTOR})")
def solved(factor: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """P^-1 times a vector (n,), from the factor L (n, n) of P."""
    answer = vector.copy()
    forward_substitute(factor, answer.reshape(1, -1))
    backward_substitute(factor, answer)
    return answer


@compiled(f"{_MATRIX}({_MATRIX})")
def gram(rows: np.ndarray) -> np.ndarray:
    """The products R R^T (k, k) of all pairs of rows of R (k, n)."""
    count, size = rows.shape
    products = np.empty((count, count))
    for i in range(count):
        for j in range(i + 1):
            product = 0.0
            for k in range(size):
                product += rows[i, k] * rows[j, k]
            products[i, j] = products[j, i] = product
    return products
