"""The scale of plots after a fall."""

from __future__ import annotations

import numpy as np
from numpy.testing import assert_array_equal

from momentum_lab.app.fallen_curves import FALLING, is_down, within_standing

NAN = np.nan
STANDING, FALLEN = np.zeros(4, dtype=bool), np.array([False, False, True, True])


def test_a_robot_is_down_from_shortly_before_its_fall_is_told():
    times = 1.0 + FALLING * np.array([0.0, 0.5, 1.0, 1.5])
    assert_array_equal(is_down(times, times > 1.0 + 1.4 * FALLING), [False, False, True, True])
    assert_array_equal(is_down(times, FALLEN), [False, True, True, True])
    assert is_down(times, ~STANDING).all()
    assert not is_down(times, STANDING).any()


def test_a_robot_that_stands_is_shown_as_it_is():
    (curve,) = within_standing([np.array([0.0, 5000.0, -5000.0, NAN])], STANDING, least=10.0)
    assert_array_equal(curve, [0.0, 5000.0, -5000.0, NAN])


def test_after_a_fall_nothing_is_drawn_beyond_what_all_curves_of_the_plot_had_before():
    first, second = np.array([0.0, 120.0, 900.0, 110.0]), np.array([0.0, -40.0, -41.0, -39.0])
    shown = within_standing([first, second], FALLEN, least=10.0)
    assert_array_equal(shown[0], [0.0, 120.0, NAN, 110.0])
    assert_array_equal(shown[1], [0.0, -40.0, NAN, -39.0])


def test_a_plot_always_has_its_least_height():
    (curve,) = within_standing([np.array([0.0, 1.0, 9.0, 11.0])], FALLEN, least=10.0)
    assert_array_equal(curve, [0.0, 1.0, 9.0, NAN])
    (lying,) = within_standing([np.array([9.0, NAN, -10.5, 0.0])], ~STANDING, least=10.0)
    assert_array_equal(lying, [9.0, NAN, NAN, 0.0])


def test_what_has_no_number_while_it_stands_sets_no_scale():
    (curve,) = within_standing([np.array([NAN, NAN, 9.0, 11.0])], FALLEN, least=10.0)
    assert_array_equal(curve, [NAN, NAN, 9.0, NAN])
