"""Optimality against the KKT system solved as one, and residuals against plain numpy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize

from momentum_lab.control.optimality import judged_minimum, minimum_on_equalities, residuals
from tests.conftest import assert_close

N, EQUAL, OPEN = 7, 3, 4


@pytest.fixture
def program(rng):
    """A strictly convex program: some rows are equalities, the others have a wide range."""
    root = rng.standard_normal((N, N))
    hessian, gradient = root @ root.T + np.eye(N), rng.standard_normal(N)
    matrix = rng.standard_normal((EQUAL + OPEN, N))
    target = rng.standard_normal(EQUAL)
    lower = np.concatenate([np.full(N, -50.0), target, np.full(OPEN, -100.0)])
    upper = np.concatenate([np.full(N, 50.0), target, np.full(OPEN, 100.0)])
    return hessian, gradient, matrix, lower, upper


def test_the_minimum_solves_the_kkt_system(program):
    hessian, gradient, matrix, lower, _ = program
    rows = matrix[:EQUAL]
    kkt = np.block([[hessian, rows.T], [rows, np.zeros((EQUAL, EQUAL))]])
    expected = np.linalg.solve(kkt, np.concatenate([-gradient, lower[N : N + EQUAL]]))
    x, multipliers = minimum_on_equalities(*program)
    assert_close(x, expected[:N], 1e-9)
    assert_close(multipliers[N : N + EQUAL], expected[N:], 1e-9)
    assert not multipliers[:N].any()
    assert not multipliers[N + EQUAL :].any()


def test_it_is_where_scipy_stops(program):
    hessian, gradient, matrix, lower, _ = program
    rows, target = matrix[:EQUAL], lower[N : N + EQUAL]
    found = minimize(
        lambda x: 0.5 * x @ hessian @ x + gradient @ x,
        np.zeros(N),
        jac=lambda x: hessian @ x + gradient,
        constraints={"type": "eq", "fun": lambda x: rows @ x - target, "jac": lambda _: rows},
        options={"ftol": 1e-14, "maxiter": 500},
    )
    assert_close(minimum_on_equalities(*program)[0], found.x, 1e-5)


def test_residuals_are_what_numpy_says_of_any_answer(program, rng):
    hessian, gradient, matrix, lower, upper = program
    x = 30.0 * rng.standard_normal(N)
    multipliers = rng.standard_normal(lower.size)
    value = np.concatenate([x, matrix @ x])
    primal = max(0.0, (value - upper).max(), (lower - value).max())
    curvature = hessian @ x
    scale = 1.0 + max(np.abs(curvature).max(), np.abs(gradient).max())
    force = multipliers[:N] + matrix.T @ multipliers[N:]
    dual = np.abs(curvature + gradient + force).max() / scale
    room = np.where(multipliers > 0.0, upper - value, value - lower).clip(0.0)
    gap = np.where(lower < upper, np.abs(multipliers) * room, 0.0).sum()
    gap /= scale * (1.0 + np.abs(x).max())
    found = residuals(*program, np.zeros(0, dtype=bool), x, multipliers)
    assert_close(np.array(found), np.array([primal, dual, gap]), 1e-9)


def test_a_soft_bound_that_presses_may_be_broken(program):
    hessian, gradient, matrix, lower, upper = program
    x, multipliers = np.zeros(N), np.zeros(lower.size)
    lower, upper = lower.copy(), upper.copy()
    lower[N : N + EQUAL] = upper[N : N + EQUAL] = 0.0
    upper[0], multipliers[0] = -2.0, 3.0
    soft = np.zeros(lower.size, dtype=bool)
    hard = residuals(hessian, gradient, matrix, lower, upper, soft, x, multipliers)
    soft[0] = True
    yielding = residuals(hessian, gradient, matrix, lower, upper, soft, x, multipliers)
    assert hard[0] == pytest.approx(2.0)
    assert yielding[0] == 0.0
    assert yielding[1] == hard[1]


def test_the_judged_minimum_is_optimal_where_nothing_presses(program):
    x, multipliers, *found = judged_minimum(*program, np.zeros(0, dtype=bool))
    assert_close(x, minimum_on_equalities(*program)[0], 0.0)
    assert_close(np.array(found), np.zeros(3), 1e-9)
    assert np.count_nonzero(multipliers) == EQUAL


def test_rows_that_contradict_each_other_are_never_judged_met(program, rng):
    """The same row with two targets: whatever comes out breaks one of them by half their distance or more."""
    hessian, gradient, matrix, lower, upper = program
    for _ in range(20):
        matrix = matrix.copy()
        matrix[0] = matrix[1] = rng.standard_normal(N)
        primal = judged_minimum(hessian, gradient, matrix, lower, upper, np.zeros(0, dtype=bool))[2]
        assert not primal < 0.49 * abs(lower[N] - lower[N + 1])


def test_a_program_without_curvature_has_no_minimum(program):
    hessian, gradient, matrix, lower, upper = program
    flat = hessian - 2.0 * np.eye(N) * np.linalg.eigvalsh(hessian).max()
    assert np.isnan(minimum_on_equalities(flat, gradient, matrix, lower, upper)[0]).all()
