"""The closed form of the wrench cone against forces at the four corners."""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import linprog

from momentum_lab.control.wrench_cone import ROWS, wrench_cone

X, Y, MU, LEAST = 0.1, 0.04, 0.6, 20.0
CORNERS = np.array([[X, Y], [-X, Y], [-X, -Y], [X, -Y]])


def corner_map() -> np.ndarray:
    """Wrench about the centre from edges of the corners' friction pyramids (6, 16)."""
    mu = MU / math.sqrt(2.0)
    columns = []
    for x, y in CORNERS:
        for a in (mu, -mu):
            for b in (mu, -mu):
                force = np.array([a, b, 1.0])
                columns.append([*force, *np.cross([x, y, 0.0], force)])
    return np.array(columns).T


def test_rows(rng):
    matrix, bound = wrench_cone(X, Y, MU, LEAST)
    assert matrix.shape == (ROWS, 6)
    assert bound.shape == (ROWS,)


def test_what_the_corners_can_push_is_inside(rng):
    matrix, bound = wrench_cone(X, Y, MU, LEAST)
    for _ in range(500):
        wrench = corner_map() @ (rng.exponential(size=16) * (rng.random(16) < 0.3))
        wrench *= 100.0 / max(wrench[2], 1e-3)
        assert (matrix @ wrench - bound).max() < 1e-9


def test_a_wrench_is_inside_exactly_when_the_corners_can_push_it(rng):
    """By linear programming: is there a combination of pyramid edges?"""
    matrix, bound = wrench_cone(X, Y, MU, LEAST)
    edges, answers = corner_map(), []
    for _ in range(300):
        wrench = np.array([30.0, 30.0, 0.0, 3.0, 8.0, 4.0]) * rng.normal(size=6) + [0, 0, 100.0, 0, 0, 0]
        excess = (matrix @ wrench - bound).max()
        if abs(excess) < 1e-6:
            continue
        found = linprog(np.zeros(16), A_eq=edges, b_eq=wrench, bounds=(0, None))
        assert (excess < 0.0) == (found.status == 0)
        answers.append(excess < 0.0)
    assert 0.1 < np.mean(answers) < 0.9
