"""Numbers that change many times a second keep their width."""

from __future__ import annotations

import re

import pytest

from momentum_lab.app import html
from momentum_lab.app.steady import FIGURE_SPACE, steady


def text(content: str) -> str:
    return re.sub(r"<[^>]*>", "", content)


@pytest.mark.parametrize(("decimals", "whole"), [(0, 4), (1, 3), (2, 3)])
def test_all_numbers_that_fit_are_equally_wide(decimals, whole):
    sweep = [0.0, 0.994, 9.996, 9.4, 99.94, 10.0, 99.5, -1.0, -9.4, 100.0, 999.0]
    written = [steady(value, decimals, whole) for value in sweep]
    assert len({len(words) for words in written}) == 1
    assert [float(words.strip(FIGURE_SPACE)) for words in written] == [round(v, decimals) for v in sweep]


def test_a_number_that_is_too_large_is_written_out():
    assert steady(12345.6, 1, 3) == "12345.6"


@pytest.mark.parametrize("behind", [0.0, 1.0])
def test_the_line_of_time_does_not_jump(behind):
    times, factors = (0.0, 9.99, 10.0, 59.5, 99.999, 100.0, 640.0), (0.0, 0.5, 0.999, 1.0, 1.02)
    lines = {
        len(text(html.time_line(time, factor, 1.0, True, behind=behind * (1.0 + time / 12.0))))
        for time in times
        for factor in factors
    }
    assert len(lines) == 1
    assert ".lab.n{font-variant-numeric:tabular-nums}" in html.TITLE


def test_the_status_has_room_for_the_figures_of_a_loss():
    lines = [
        html.status_line("border", f"CoP on the toes: angular goal gives way by {size} N m", "orange")
        for size in (5, 88, 412)
    ]
    # The words are the same, and each number has a box of three figures of one width.
    assert [text(line).split()[-3] for line in lines] == ["5", "88", "412"]
    assert all("min-width:3ch" in line and 'class="n"' in line for line in lines)
    assert "min-width" not in html.status_line("fallen", "fallen at 1.32 s: left foot", "vermillion")
