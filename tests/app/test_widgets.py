"""A widget asks, then shows the truth, and never fights the hand that moves it."""

from __future__ import annotations

import math

import pytest

from momentum_lab.app.widgets import Bound, nice_step
from momentum_lab.control.computed_torque_gains import ComputedTorqueGains
from momentum_lab.control.gains import declared_gains
from momentum_lab.events import SetPriority
from tests.app.fakes import FakeHandle


class Hand:
    """A slider, the events it posts, and a clock."""

    def __init__(self) -> None:
        self.handle = FakeHandle(value=0.0)
        self.posted = []
        self.now = 100.0
        self.bound = Bound(self.handle, SetPriority, self.posted.append, clock=lambda: self.now)


@pytest.fixture
def hand() -> Hand:
    return Hand()


def test_moving_it_posts_an_event(hand):
    hand.handle.set_by_person(0.4)
    assert hand.posted == [SetPriority(0.4)]


def test_it_follows_the_truth_without_posting(hand):
    hand.bound.follow(0.8)
    assert hand.handle.value == 0.8
    for callback in hand.handle.callbacks:
        callback(type("Event", (), {"client": None, "target": hand.handle}))
    assert hand.posted == []


def test_it_does_not_jump_back_while_a_hand_moves_it(hand):
    for step in range(20):
        hand.now += 0.05
        hand.handle.set_by_person(0.01 * step)
        hand.bound.follow(0.0)
        assert hand.handle.value == 0.01 * step


def test_the_truth_wins_when_the_hand_has_gone(hand):
    hand.handle.set_by_person(5.0)  # refused by the session
    hand.bound.follow(0.2)
    assert hand.handle.value == 5.0
    hand.now += 1.0
    hand.bound.follow(0.2)
    assert hand.handle.value == 0.2


def test_a_move_that_has_not_been_reported_yet_is_not_lost(hand):
    # The value arrives first, its callback a moment later in another thread.
    hand.handle.value = 0.6
    hand.bound.follow(0.0)
    hand.handle.set_by_person(hand.handle.value)
    assert hand.posted == [SetPriority(0.6)]


def test_what_is_not_a_number_gives_way_to_the_truth_too(hand):
    hand.handle.set_by_person(math.nan)
    hand.now += 1.0
    hand.bound.follow(0.2)
    assert hand.handle.value == 0.2


@pytest.mark.parametrize("gain", declared_gains(ComputedTorqueGains()).values(), ids=lambda gain: gain.name)
def test_every_default_lies_on_a_step(gain):
    step = nice_step(gain.low, gain.high, gain.default)
    steps = (gain.default - gain.low) / step
    assert steps == pytest.approx(round(steps), abs=1e-6)
    assert 100 < (gain.high - gain.low) / step < 20_000


@pytest.mark.parametrize(
    ("low", "high", "default", "step"),
    [(0, 60, 8, 0.2), (0, 1, 0, 0.005), (0, 200, 50, 1), (0, 5, 1.25, 0.01)],
)
def test_steps_are_round_numbers(low, high, default, step):
    assert nice_step(low, high, default) == pytest.approx(step)
