"""Cholesky factors of small matrices, in place and by rows: U with U^T U = P, U upper triangular."""

from __future__ import annotations

import math

import numpy as np

from momentum_lab.compiled import compiled

_MATRIX, _VECTOR = "f8[:, ::1]", "f8[::1]"


@compiled(f"boolean({_MATRIX})")
def factorize(matrix: np.ndarray) -> bool:
    """Turn a symmetric matrix (n, n) into its Cholesky factor U with U^T U = P, in place, by rows.

    Only the upper triangle is read and written.

    Returns:
        Whether the matrix is positive definite.
    """
    size = len(matrix)
    for row in range(size):
        pivot = matrix[row, row]
        if not pivot > 0.0:
            return False
        scale = 1.0 / math.sqrt(pivot)
        for column in range(row, size):
            matrix[row, column] *= scale
        for below in range(row + 1, size):
            factor = matrix[row, below]
            for column in range(below, size):
                matrix[below, column] -= factor * matrix[row, column]
    return True


@compiled(f"void({_MATRIX}, {_MATRIX})")
def forward_substitute(factor: np.ndarray, rows: np.ndarray) -> None:
    """Replace the columns of `rows` (n, k) by U^-T times themselves."""
    for row in range(len(factor)):
        scale = 1.0 / factor[row, row]
        for column in range(rows.shape[1]):
            rows[row, column] *= scale
        for below in range(row + 1, len(factor)):
            part = factor[row, below]
            for column in range(rows.shape[1]):
                rows[below, column] -= part * rows[row, column]


@compiled(f"void({_MATRIX}, {_VECTOR})")
def backward_substitute(factor: np.ndarray, vector: np.ndarray) -> None:
    """Replace a vector (n,) by U^-1 times itself."""
    for row in range(len(factor) - 1, -1, -1):
        known = 0.0
        for column in range(row + 1, len(factor)):
            known += factor[row, column] * vector[column]
        vector[row] = (vector[row] - known) / factor[row, row]


@compiled(f"{_MATRIX}({_MATRIX}, {_MATRIX})")
def solved(factor: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """P^-1 times the columns (n, k), from the factor U (n, n) of P."""
    answer = columns.copy()
    forward_substitute(factor, answer)
    for column in range(columns.shape[1]):
        vector = answer[:, column].copy()
        backward_substitute(factor, vector)
        answer[:, column] = vector
    return answer
