"""Figures of the app against their bounds, and the small sums behind them."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.app.figures import AppMeasurement, Figure, figures, growth, longest_gap


def measurement(**changes: object) -> AppMeasurement:
    """A run that reaches everything, with some of it changed."""
    good: dict[str, object] = {
        "seconds": 600.0,
        "real_time_factor": 1.0,
        "drawings_per_second": 40.0,
        "messages_per_second": 1300.0,
        "late_ticks_per_minute": 0.0,
        "stolen": 0.0,
        "server_cpu": 0.1,
        "push_delay": 0.02,
        "push_delay_longest": 0.04,
        "memory_growth": 0.0,
        "sent_while_paused": 0.0,
        "drawn_while_standing": 0.0,
        "first_picture": 0.5,
        "aged": 3600.0,
        "first_picture_aged": 0.5,
        "stall": 0.1,
    }
    return AppMeasurement(**{**good, **changes})


def missed(**changes: object) -> list[Figure]:
    return [figure for figure in figures(measurement(**changes)) if figure.reached is False]


def test_a_good_run_reaches_every_bound():
    reached = [figure.reached for figure in figures(measurement()) if figure.bound]
    assert reached == [True] * 9


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"real_time_factor": 0.985}, "real-time factor"),
        ({"real_time_factor": 1.015}, "real-time factor"),
        ({"drawings_per_second": 29.9}, "drawings per second"),
        ({"late_ticks_per_minute": 1.1}, "ticks over 5 ms late"),
        ({"server_cpu": 0.26}, "server CPU"),
        ({"memory_growth": 0.6}, "memory growth"),
        ({"memory_growth": float("nan")}, "memory growth"),
        ({"push_delay_longest": 0.061}, "push to drawing, longest"),
        ({"sent_while_paused": 0.5}, "paused"),
        ({"drawn_while_standing": 0.5}, "standing"),
        ({"stall": 0.21}, "stall when a tab opens after 60 min"),
    ],
)
def test_each_bound_can_be_missed(change, words):
    (figure,) = missed(**change)
    assert words in figure.name


def test_a_short_run_does_not_judge_the_memory():
    (figure,) = [f for f in figures(measurement(memory_growth=None)) if "memory" in f.name]
    assert (figure.value, figure.reached) == ("too short", None)


def test_growth_is_the_slope_of_a_line_and_noise_does_not_matter(rng):
    times = np.arange(60.0, 600.0, 1.5)
    sizes = 3.0 + 0.25 * times
    assert growth(list(times), list(sizes)) == pytest.approx(0.25, rel=1e-9)
    noisy = sizes + rng.normal(0.0, 1.0, len(times))
    assert growth(list(times), list(noisy)) == pytest.approx(np.polyfit(times, noisy, 1)[0], rel=1e-9)


def test_the_longest_gap_may_lie_at_either_end():
    assert longest_gap([0.5, 1.0, 1.2, 1.5, 9.0], 1.0, 2.0) == pytest.approx(0.5)
    assert longest_gap([1.1, 1.6, 1.9], 1.0, 2.0) == pytest.approx(0.5)
    assert longest_gap([1.8, 1.9], 1.0, 2.0) == pytest.approx(0.8)
    assert longest_gap([], 1.0, 4.0) == pytest.approx(3.0)
