from __future__ import annotations

import numpy as np

from momentum_lab.robot.proposal.sole_fit import largest_rectangle
from tests.conftest import assert_close


def test_the_largest_rectangle_of_a_rectangle_is_itself() -> None:
    points = np.array([[-0.1, -0.04], [0.12, -0.04], [0.12, 0.05], [-0.1, 0.05]])
    x, y = largest_rectangle(points)
    assert_close([*x, *y], [-0.1, 0.12, -0.04, 0.05], 1e-12)


def test_in_a_circle_it_is_the_square() -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, 400)
    x, y = largest_rectangle(np.column_stack([np.cos(angle), np.sin(angle)]))
    assert_close([*x, *y], np.sqrt(0.5) * np.array([-1.0, 1.0, -1.0, 1.0]), 0.03)


def test_in_a_triangle_it_covers_half() -> None:
    """Known: the largest rectangle on a side of a triangle has half its area."""
    (rear, front), (right, left) = largest_rectangle(np.array([[0.0, 0.0], [1.0, 0.0], [0.5, 1.0]]))
    assert_close((front - rear) * (left - right), 0.25, 0.01)
    assert_close(right, 0.0, 1e-12)
