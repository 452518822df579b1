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
def forward_substitute(factor: np.ndarray, columns: np.ndarray) -> None:
    """Replace columns (n, k) by L^-1 times themselves."""
    for row in range(len(factor)):
        for above in range(row):
            part = factor[row, above]
            for column in range(columns.shape[1]):
                columns[row, column] -= part * columns[above, column]
        scale = 1.0 / factor[row, row]
        for column in range(columns.shape[1]):
            columns[row, column] *= scale


@compiled(f"void({_MATRIX}, {_VECTOR})")
def backward_substitute(factor: np.ndarray, vector: np.ndarray) -> None:
    """Replace a vector (n,) by L^-T times itself."""
    for row in range(len(factor) - 1, -1, -1):
        vector[row] /= factor[row, row]
        for above in range(row):
            vector[above] -= factor[row, above] * vector[row]


@compiled(f"{_MATRIX}({_MATRIX}, {_MATRIX})")
def solved(factor: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """P^-1 times the columns (n, k), from the factor L (n, n) of P."""
    answer = columns.copy()
    forward_substitute(factor, answer)
    for column in range(columns.shape[1]):
        vector = answer[:, column].copy()
        backward_substitute(factor, vector)
        answer[:, column] = vector
    return answer
