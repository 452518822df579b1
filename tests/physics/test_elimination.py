"""Gauss's elimination against its own equations, on matrices that need exchanges of rows."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.physics.elimination import eliminate, substitute
from tests.conftest import assert_close


@pytest.mark.parametrize("size", [1, 2, 7, 33])
def test_what_is_solved_fulfils_the_equations(rng, size):
    for _ in range(20):
        matrix = rng.normal(size=(size, size))
        matrix[0, 0] = 0.0 if size > 1 else 2.0
        vector = rng.normal(size=size)
        factors, answer = matrix.copy(), vector.copy()
        substitute(factors, eliminate(factors), answer)
        assert_close(matrix @ answer, vector, 1e-13 * np.linalg.cond(matrix) * max(1.0, np.abs(vector).max()))


def test_a_singular_matrix_gives_no_numbers():
    factors, answer = np.ones((3, 3)), np.array([1.0, 2.0, 3.0])
    substitute(factors, eliminate(factors), answer)
    assert not np.isfinite(answer).all()
