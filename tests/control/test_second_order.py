"""Damping ratio and natural frequency: the roots of the law are where the theory says."""

from __future__ import annotations

import math

import numpy as np
import pytest

from momentum_lab.control.second_order import damping_ratio, gains_for, natural_frequency


@pytest.mark.parametrize(("d", "k"), [(8.0, 16.0), (3.0, 16.0), (20.0, 16.0), (0.0, 4.0)])
def test_the_roots_of_the_law(d, k):
    """s^2 + d s + k = 0 has the roots omega (-zeta +- sqrt(zeta^2 - 1))."""
    zeta, omega = damping_ratio(d, k), natural_frequency(k)
    spread = np.sqrt(complex(zeta**2 - 1.0))
    expected = [omega * (-zeta + spread), omega * (-zeta - spread)]
    assert np.sort_complex(np.roots([1.0, d, k])) == pytest.approx(
        np.sort_complex(np.array(expected)), abs=1e-6
    )


def test_there_and_back():
    d, k = gains_for(0.7, 4.0)
    assert (damping_ratio(d, k), natural_frequency(k)) == pytest.approx((0.7, 4.0))


def test_the_chapters_gains_are_critically_damped():
    assert damping_ratio(8.0, 16.0) == 1.0


def test_without_stiffness_nothing_comes_back():
    assert math.isinf(damping_ratio(8.0, 0.0))
