"""Quadratic programs: the answer, its certificate, and what is said when there is none."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.control import qp
from momentum_lab.control.qp import QuadraticProgram, certify, solve, solve_reference
from momentum_lab.errors import SolverError
from tests.conftest import assert_close


def random_program(rng, size=8, rows=10, equal=3) -> QuadraticProgram:
    """Strictly convex, with bounds that are active at the minimum, equalities, and a point within all of them."""
    root = rng.normal(size=(size, size))
    inside, matrix = rng.normal(size=size), rng.normal(size=(rows, size))
    values = np.concatenate([inside, matrix @ inside])
    lower, upper = values - rng.uniform(0.01, 0.5, size + rows), values + rng.uniform(0.01, 0.5, size + rows)
    lower[-equal:] = upper[-equal:] = values[-equal:]
    lower[rng.random(size + rows) < 0.2] = -np.inf
    lower[-equal:] = values[-equal:]
    return QuadraticProgram(root.T @ root + np.eye(size), 10 * rng.normal(size=size), matrix, lower, upper)


def test_random_programs_agree_with_the_interior_point_method(rng):
    for _ in range(30):
        problem = random_program(rng)
        solution = solve(problem)
        assert_close(solution.x, solve_reference(problem), 1e-5)
        assert solution.certificate.primal < 1e-9
        assert solution.certificate.dual < 1e-9


def test_the_minimum_without_bounds_is_that_of_the_parabola(rng):
    root = rng.normal(size=(5, 5))
    hessian, gradient = root.T @ root + np.eye(5), rng.normal(size=5)
    free = np.full(5, np.inf)
    solution = solve(QuadraticProgram(hessian, gradient, np.zeros((0, 5)), -free, free))
    assert_close(solution.x, -np.linalg.solve(hessian, gradient), 1e-9)
    assert_close(solution.multipliers, np.zeros(5), 0.0)


def test_multipliers_press_against_their_bounds(rng):
    """Positive at upper bounds, negative at lower ones, zero at bounds that are not reached."""
    for _ in range(10):
        problem = random_program(rng)
        solution = solve(problem)
        values = problem.values(solution.x)
        free = problem.lower < problem.upper
        assert (solution.multipliers[free & (values < problem.upper - 1e-6)] <= 1e-9).all()
        assert (solution.multipliers[free & (values > problem.lower + 1e-6)] >= -1e-9).all()


def test_a_known_minimum_on_an_edge():
    """min (x - 3)^2 + (y - 1)^2 with x + y <= 2, x >= 0: (2, 0), multiplier 2 of the sum."""
    problem = QuadraticProgram(
        2 * np.eye(2),
        np.array([-6.0, -2.0]),
        np.ones((1, 2)),
        np.array([0.0, -np.inf, -np.inf]),
        np.array([np.inf, np.inf, 2.0]),
    )
    solution = solve(problem)
    assert_close(solution.x, [2.0, 0.0], 1e-12)
    assert_close(solution.multipliers, [0.0, 0.0, 2.0], 1e-9)


def test_a_tampered_answer_has_a_telling_certificate(rng):
    problem = random_program(rng)
    solution = solve(problem)
    moved = certify(problem, solution.x + 1e-3, solution.multipliers)
    assert max(moved.primal, moved.dual) > 1e-5
    unpressed = certify(problem, solution.x, np.zeros_like(solution.multipliers))
    assert unpressed.primal < 1e-9
    assert unpressed.dual > 1e-2


@pytest.mark.parametrize(
    "tamper",
    [
        pytest.param(lambda x, lam: (x + 1e-3, lam), id="moved"),
        pytest.param(lambda x, lam: (x, 0.5 * lam), id="wrong multipliers"),
        pytest.param(lambda x, lam: (np.full_like(x, np.nan), lam), id="not a number"),
        pytest.param(lambda x, lam: (x, np.full_like(lam, np.nan)), id="multipliers not a number"),
    ],
)
def test_an_answer_is_judged_by_its_residuals_and_not_by_the_solvers_word(tamper, rng, monkeypatch):
    problem, honest = random_program(rng), qp.daqp.solve

    def lying(*arguments):
        x, value, flag, info = honest(*arguments)
        x, multipliers = tamper(np.array(x), np.array(info["lam"]))
        return x, value, flag, {**info, "lam": multipliers}

    monkeypatch.setattr(qp.daqp, "solve", lying)
    with pytest.raises(SolverError, match="misses optimality"):
        solve(problem)


def test_a_wrong_sign_of_a_multiplier_is_no_optimum(monkeypatch):
    """min x^2 with 1 <= x <= 3 and the pretended minimum x = 3, held there by its lower bound: stationary only."""
    problem = QuadraticProgram(2 * np.eye(1), np.zeros(1), np.zeros((0, 1)), np.array([1.0]), np.array([3.0]))
    monkeypatch.setattr(qp.daqp, "solve", lambda *_: (np.array([3.0]), 9.0, 1, {"lam": np.array([-6.0])}))
    with pytest.raises(SolverError, match="misses optimality"):
        solve(problem)


def test_the_bound_that_stands_in_the_way_is_named():
    """Two that agree against one that asks for more: the one is short by two thirds of the difference."""
    problem = QuadraticProgram(
        np.eye(1),
        np.zeros(1),
        np.ones((3, 1)),
        np.array([-np.inf, -np.inf, -np.inf, 3.0]),
        np.array([np.inf, 0.0, 0.0, np.inf]),
        ((1, "the unknown"), (2, "the lid"), (1, "the floor")),
    )
    with pytest.raises(SolverError, match=r"cannot be met: the floor \(short by 2\)"):
        solve(problem)


def test_a_bound_without_a_label_is_named_by_its_number():
    problem = QuadraticProgram(np.eye(1), np.zeros(1), np.zeros((0, 1)), np.zeros(1), np.ones(1), ((1, "x"),))
    assert problem.label(0) == "x"
    assert problem.label(1) == "bound 0"


@pytest.mark.filterwarnings("ignore:Clarabel.rs terminated")
def test_the_reference_says_when_it_finds_nothing():
    problem = QuadraticProgram(
        np.eye(1), np.zeros(1), np.ones((1, 1)), np.array([2.0, -np.inf]), np.array([np.inf, 1.0])
    )
    with pytest.raises(SolverError, match="Clarabel finds no minimiser"):
        solve_reference(problem)
