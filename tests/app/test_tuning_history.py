"""Steps back and forth, and what counts as one step."""

from __future__ import annotations

from dataclasses import dataclass, replace

import pytest

from momentum_lab.app.tuning_history import TuningHistory
from momentum_lab.choices import Choices
from momentum_lab.control.gains import gain
from momentum_lab.events import SetGain, SetGains, SetMismatch, SetPriority
from momentum_lab.momentum.directions import ALL
from momentum_lab.physics.mismatch import EXACT, Mismatch


class Clock:
    now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


@dataclass(frozen=True)
class Gains:
    """Two gains with short names."""

    d: float = gain(1.0, "1/s", 0.0, 10.0, "Damper.")
    k: float = gain(1.0, "1/s^2", 0.0, 10.0, "Spring.")


def chosen(priority: float = 0.0, controller: str = "computed-torque", **gains: float) -> Choices:
    return Choices(controller, Gains(**gains), priority, ALL, "momentum", "", "zero", "told", EXACT)


def noted(history: TuningHistory, clock: Clock, *values: Choices, pause: float = 2.0) -> None:
    for value in values:
        clock.now += pause
        history.note(value)


def test_back_and_forth(clock):
    history = TuningHistory(chosen(), clock)
    noted(history, clock, chosen(d=2.0), chosen(d=2.0, k=3.0), chosen(0.5, d=2.0, k=3.0))
    assert history.steps == (3, 0)
    assert history.back() == [SetPriority(0.0)]
    assert history.back() == [SetGain("k", 1.0)]
    assert history.back() == [SetGain("d", 1.0)]
    assert history.back() == []
    assert history.forth() == [SetGain("d", 2.0)]
    assert history.forth() == [SetGain("k", 3.0)]
    assert history.forth() == [SetPriority(0.5)]
    assert history.forth() == []


def test_a_preset_is_taken_back_in_one_event(clock):
    history = TuningHistory(chosen(), clock)
    noted(history, clock, chosen(d=2.0, k=3.0))
    assert history.back() == [SetGains({"d": 1.0, "k": 1.0})]


def test_a_slider_on_its_way_is_one_step(clock):
    history = TuningHistory(chosen(), clock)
    noted(history, clock, *(chosen(d=1.0 + 0.1 * i) for i in range(1, 20)), pause=0.05)
    assert history.steps == (1, 0)
    assert history.back() == [SetGain("d", 1.0)]


def test_another_choice_or_a_pause_is_another_step(clock):
    history = TuningHistory(chosen(), clock)
    noted(history, clock, chosen(d=2.0), chosen(d=2.0, k=2.0), chosen(0.5, d=2.0, k=2.0), pause=0.1)
    noted(history, clock, chosen(0.7, d=2.0, k=2.0), pause=1.5)
    assert history.steps == (4, 0)


def test_model_errors_are_told_apart(clock):
    history = TuningHistory(chosen(), clock)
    heavy = replace(chosen(), mismatch=Mismatch(mass_error=0.1))
    late = replace(chosen(), mismatch=Mismatch(mass_error=0.1, torque_delay_ms=1.0))
    noted(history, clock, heavy, late, pause=0.1)
    assert history.back() == [SetMismatch("torque_delay_ms", 0.0)]
    assert history.back() == [SetMismatch("mass_error", 0.0)]


def test_what_is_late_after_a_step_back_is_no_step(clock):
    """Frames that were under way still show the values of before."""
    history = TuningHistory(chosen(), clock)
    noted(history, clock, chosen(d=2.0))
    history.back()
    noted(history, clock, chosen(d=2.0), chosen(d=2.0), chosen(), pause=0.1)
    assert history.steps == (0, 1)


def test_a_change_after_a_step_back_ends_the_way_forth(clock):
    history = TuningHistory(chosen(), clock)
    noted(history, clock, chosen(d=2.0))
    history.back()
    noted(history, clock, chosen(), chosen(d=5.0))
    assert history.steps == (1, 0)
    assert history.back() == [SetGain("d", 1.0)]
