"""A number that is predicted: what is typed counts, whatever is pressed after it."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from momentum_lab.app.learn_pages import Desk, NumberPage
from momentum_lab.app.walk import Walk
from momentum_lab.lesson.record import LessonRecord, StepRecord
from tests.app.fakes import FakeGui

STEP = StepRecord("number", "How far?", low=-200.0, high=200.0, unit="N", measured=-78.5)


class Learner:
    """Somebody in front of a page that asks for a number."""

    def __init__(self) -> None:
        self.gui, self.answers = FakeGui(), []
        record = LessonRecord("x.py", 1, "", "", "talos", {}, (STEP,), ())
        self.walk = Walk(record)
        NumberPage(Desk(self.gui, print, print, self.take, lambda: None), self.walk)

    def take(self, place: int, read: Callable[[], float]) -> None:
        self.answers.append((place, read()))


@pytest.mark.parametrize(("typed", "taken"), [(63.0, 63.0), (1e9, 200.0), (-1e9, -200.0)])
def test_what_is_typed_is_the_prediction_at_once(typed: float, taken: float) -> None:
    learner = Learner()
    learner.gui.widgets["I predict (N)"].set_by_person(typed)
    assert learner.answers == [(0, taken)]


def test_button_takes_the_middle() -> None:
    learner = Learner()
    learner.gui.widgets["That is my prediction"].set_by_person(True)
    assert learner.answers == [(0, 0.0)]


def test_nothing_that_is_no_number_becomes_one() -> None:
    learner = Learner()
    learner.gui.widgets["I predict (N)"].set_by_person(math.nan)
    assert math.isnan(learner.answers[0][1])
