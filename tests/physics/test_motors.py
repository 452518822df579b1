"""Late motors: what was asked for comes out in its order, so many ticks later."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.physics.motors import delayed, ticks_late


def given(asked: list[float], late: list[int]) -> list[float]:
    line, out = (), []
    for torque, ticks in zip(asked, late, strict=True):
        now, line = delayed(line, np.array([torque]), ticks)
        out.append(float(now[0]))
        assert len(line) <= ticks
    return out


def test_the_delay_is_the_nearest_number_of_ticks():
    assert [ticks_late(ms, 1e-3) for ms in (0.0, 0.4, 0.6, 2.0, 5.0)] == [0, 0, 1, 2, 5]
    assert ticks_late(2.0, 5e-4) == 4


@pytest.mark.parametrize("late", [0, 1, 3])
def test_every_torque_comes_once_and_late(late):
    asked = [float(i) for i in range(10)]
    assert given(asked, [late] * 10) == [0.0] * late + asked[: 10 - late]


def test_a_longer_delay_holds_the_oldest_torque_and_a_shorter_one_skips():
    asked = [float(i) for i in range(8)]
    assert given(asked, [0, 0, 2, 2, 2, 1, 0, 0]) == [0.0, 1.0, 2.0, 2.0, 2.0, 4.0, 6.0, 7.0]


def test_a_line_is_never_changed_in_place():
    _, line = delayed((), np.array([1.0]), 2)
    before = line
    _, after = delayed(line, np.array([2.0]), 2)
    assert [float(t[0]) for t in before] == [1.0]
    assert [float(t[0]) for t in after] == [1.0, 2.0]
