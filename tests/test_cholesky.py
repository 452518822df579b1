"""Factors and solutions against numpy's."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.cholesky import backward_substitute, factorize, forward_substitute, gram, solved
from tests.conftest import assert_close


@pytest.fixture(params=[1, 2, 6, 38])
def matrix(request, rng) -> np.ndarray:
    """Positive definite, with eigenvalues from 1 to about 100."""
    columns = rng.normal(size=(request.param, request.param))
    return columns @ columns.T + np.eye(request.param)


def test_the_factor_is_numpys(matrix):
    factor = matrix.copy()
    assert factorize(factor)
    assert_close(np.tril(factor), np.linalg.cholesky(matrix), 1e-12 * np.abs(matrix).max())


def test_only_the_lower_triangle_is_read(matrix):
    lower = np.tril(matrix)
    assert factorize(lower)
    assert_close(lower, np.linalg.cholesky(matrix), 1e-12 * np.abs(matrix).max())


def test_substitutions_solve_triangular_systems(matrix, rng):
    factor = np.linalg.cholesky(matrix)
    rows, vector = rng.normal(size=(3, len(matrix))), rng.normal(size=len(matrix))
    forward, backward = rows.copy(), vector.copy()
    forward_substitute(factor, forward)
    backward_substitute(factor, backward)
    assert_close(forward @ factor.T, rows, 1e-10)
    assert_close(factor.T @ backward, vector, 1e-10)


def test_a_solution_fulfils_its_equation(matrix, rng):
    vector = rng.normal(size=len(matrix))
    factor = matrix.copy()
    factorize(factor)
    assert_close(matrix @ solved(factor, vector), vector, 1e-10)


def test_products_of_rows_are_numpys(rng):
    rows = rng.normal(size=(5, 38))
    assert_close(gram(rows), rows @ rows.T, 1e-12)


@pytest.mark.parametrize("bad", [-1.0, 0.0, np.nan])
def test_a_matrix_that_is_not_positive_definite_is_refused(bad):
    matrix = np.eye(3)
    matrix[2, 2] = bad
    assert not factorize(matrix)
