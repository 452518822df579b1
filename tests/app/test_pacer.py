"""Simulated time keeps just ahead of the clock, and never catches up in a burst."""

from __future__ import annotations

import pytest

from momentum_lab.app.pacer import LEAD, Pacer


def run(pacer: Pacer, start: float, seconds: float, every: float, most: int = 10**9) -> int:
    """Ticks done when the loop looks at the clock every so often and manages at most so many ticks a time."""
    total, now = 0, start
    for _ in range(round(seconds / every)):
        now += every
        ticks = min(pacer.due(now), most)
        for _ in range(ticks):
            pacer.begin(now)
        pacer.real_time_factor(now)
        total += ticks
    return total


@pytest.mark.parametrize(("speed", "ticks"), [(1.0, 2000), (0.5, 1000), (0.125, 250)])
def test_ticks_per_second(speed, ticks):
    pacer = Pacer(1e-3)
    pacer.start(100.0, speed)
    assert run(pacer, 100.0, 2.0, 0.004) == pytest.approx(ticks + speed * LEAD / 1e-3, abs=1)


@pytest.mark.parametrize("speed", [1.0, 0.25])
def test_simulated_time_keeps_ahead_of_the_clock_by_the_lead(speed):
    pacer = Pacer(1e-3)
    pacer.start(5.0, speed)
    ahead = pacer.due(5.0)
    assert ahead * 1e-3 == pytest.approx(speed * LEAD)
    for _ in range(ahead):
        pacer.begin(5.0)
    assert pacer.wait(5.0) == pytest.approx(1e-3 / speed)
    assert pacer.due(5.0 + 0.9 * pacer.wait(5.0)) == 0
    assert pacer.due(5.0 + pacer.wait(5.0)) == 1


def test_a_stall_no_longer_than_lead_and_bound_together_is_not_late():
    pacer = Pacer(1e-3)
    pacer.start(0.0, 1.0)
    for now in (0.0, 0.0095, 0.0190):
        for _ in range(pacer.due(now)):
            pacer.begin(now)
    assert pacer.late_ticks == 0
    assert pacer.due(0.0190) == 0


def test_a_short_stall_is_caught_up():
    pacer = Pacer(1e-3)
    pacer.start(0.0, 1.0)
    assert pacer.due(0.05) == 50 + round(LEAD / 1e-3)


def test_a_long_stall_is_not_caught_up():
    pacer = Pacer(1e-3)
    pacer.start(0.0, 1.0)
    due = pacer.due(3.0)
    assert due < 100
    for _ in range(due):
        pacer.begin(3.0)
    assert pacer.due(3.001) == 1


def test_a_machine_that_is_too_slow_slows_simulated_time():
    pacer = Pacer(1e-3)
    pacer.start(0.0, 1.0)
    assert run(pacer, 0.0, 4.0, 0.008, most=4) == 2000
    assert pacer.real_time_factor(4.008) == pytest.approx(0.5, abs=0.02)


def test_real_time_factor_follows_the_last_second():
    pacer = Pacer(1e-3)
    pacer.start(0.0, 1.0)
    run(pacer, 0.0, 3.0, 0.004, most=1)
    assert pacer.real_time_factor(3.004) == pytest.approx(0.25, abs=0.01)
    run(pacer, 3.0, 2.0, 0.004)
    assert pacer.real_time_factor(5.004) == pytest.approx(1.0, abs=0.06)


@pytest.mark.parametrize(("speed", "stall", "late"), [(1.0, 0.0045, 0), (1.0, 0.0125, 7), (0.5, 0.0125, 3)])
def test_ticks_that_begin_later_than_five_milliseconds_are_counted(speed, stall, late):
    # Tick k is due at k / (1000 speed) s; after a stall, those with stall - k / (1000 speed) > 5 ms begin late.
    pacer = Pacer(1e-3)
    pacer.start(7.0, speed)
    for _ in range(pacer.due(7.0 + stall)):
        pacer.begin(7.0 + stall)
    assert pacer.late_ticks == late


def test_ticks_that_are_given_up_after_a_long_stall_count_as_late():
    pacer = Pacer(1e-3)
    pacer.start(0.0, 1.0)
    for _ in range(pacer.due(3.0)):
        pacer.begin(3.0)
    assert pacer.late_ticks == pytest.approx(3000 - 5, abs=1)


def test_a_new_start_is_not_late():
    pacer = Pacer(1e-3)
    pacer.start(0.0, 1.0)
    pacer.start(60.0, 1.0)
    for _ in range(pacer.due(60.001)):
        pacer.begin(60.001)
    assert pacer.late_ticks == 0
