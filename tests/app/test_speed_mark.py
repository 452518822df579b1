"""The speed that is chosen, in words and among its buttons."""

from __future__ import annotations

import pytest

from momentum_lab.app.speed_mark import speed_cell, speed_words

SPEEDS = (0.125, 0.25, 0.5, 1.0)


@pytest.mark.parametrize(
    ("speed", "words"),
    [
        (1.0, ""),
        (0.5, " · at 1/2"),
        (0.125, " · at 1/8"),
        (0.3, " · at 0.3"),
        (2.0, " · at 2"),
    ],
)
def test_the_words_are_those_of_the_button(speed, words):
    assert speed_words(speed) == words


@pytest.mark.parametrize(("place", "speed"), list(enumerate(SPEEDS, start=1)))
def test_one_button_is_filled(place, speed):
    assert speed_cell(SPEEDS, speed).count("button:nth-of-type(") == 1
    assert f"button:nth-of-type({place})" in speed_cell(SPEEDS, speed)


def test_a_speed_without_a_button_fills_none():
    assert "nth-of-type" not in speed_cell(SPEEDS, 0.3)
