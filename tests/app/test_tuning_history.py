"""Steps back and forth, and what counts as one step."""

from __future__ import annotations

import pytest

from momentum_lab.app.tuning_history import TuningHistory


class Clock:
    now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


def noted(history: TuningHistory, clock: Clock, *values: dict[str, float], pause: float = 2.0) -> None:
    for value in values:
        clock.now += pause
        history.note(value)


def test_back_and_forth(clock):
    history = TuningHistory({"d": 1.0, "k": 1.0}, clock)
    noted(history, clock, {"d": 2.0, "k": 1.0}, {"d": 2.0, "k": 3.0})
    assert history.steps == (2, 0)
    assert history.back() == {"k": 1.0}
    assert history.back() == {"d": 1.0}
    assert history.back() == {}
    assert history.forth() == {"d": 2.0}
    assert history.forth() == {"k": 3.0}
    assert history.forth() == {}


def test_a_slider_on_its_way_is_one_step(clock):
    history = TuningHistory({"d": 1.0}, clock)
    noted(history, clock, *({"d": 1.0 + 0.1 * i} for i in range(1, 20)), pause=0.05)
    assert history.steps == (1, 0)
    assert history.back() == {"d": 1.0}


def test_another_gain_or_a_pause_is_another_step(clock):
    history = TuningHistory({"d": 1.0, "k": 1.0}, clock)
    noted(history, clock, {"d": 2.0, "k": 1.0}, {"d": 2.0, "k": 2.0}, pause=0.1)
    noted(history, clock, {"d": 2.0, "k": 3.0}, pause=1.5)
    assert history.steps == (3, 0)


def test_what_is_late_after_a_step_back_is_no_step(clock):
    """Frames that were under way still show the values of before."""
    history = TuningHistory({"d": 1.0}, clock)
    noted(history, clock, {"d": 2.0})
    history.back()
    noted(history, clock, {"d": 2.0}, {"d": 2.0}, {"d": 1.0}, pause=0.1)
    assert history.steps == (0, 1)


def test_a_change_after_a_step_back_ends_the_way_forth(clock):
    history = TuningHistory({"d": 1.0}, clock)
    noted(history, clock, {"d": 2.0})
    history.back()
    noted(history, clock, {"d": 1.0}, {"d": 5.0})
    assert history.steps == (1, 0)
    assert history.back() == {"d": 1.0}
