"""A learner's way through a lesson."""

from __future__ import annotations

from dataclasses import replace

import msgspec

from momentum_lab.app.lesson_wire import LessonNews
from momentum_lab.app.walk import Walk
from momentum_lab.lesson.record import LessonRecord, StepRecord

CHOICE = StepRecord("choice", "Who?", options=("one", "other"), right=(1,))
NUMBER = StepRecord("number", "How much?", low=0.0, high=10.0, measured=4.0)
PLAY = StepRecord("play", "Watch.", run="b", beside="c")
COMPARE = StepRecord("compare", "So it was.", measures={"x": "4"})
RECORD = LessonRecord(
    "lesson.py", 1, "t", "q?", "g1", {"a": None, "b": None, "c": None}, (CHOICE, NUMBER, PLAY, COMPARE), ()
)


def test_prediction_comes_first() -> None:
    walk = Walk(RECORD)
    assert walk.waits
    walk.answers[0] = 1.0
    assert not walk.waits
    walk.place = 2
    assert not walk.waits


def test_a_step_plays_its_own_runs_and_those_that_no_other_plays() -> None:
    """The run beside another one is played with it, not after it."""
    assert Walk(RECORD, place=2).runs_to_play() == ("b", "a")
    two = msgspec.structs.replace(RECORD, steps=(PLAY, StepRecord("play", "And now.", run="a")))
    assert Walk(two).runs_to_play() == ("b",)
    assert Walk(two, place=1).runs_to_play() == ("a",)


def test_a_step_has_been_seen_with_all_that_it_shows() -> None:
    for seen, everything in ((("a", "b"), False), (("a", "b", "c"), True)):
        walk = Walk(RECORD, 2, news=LessonNews(seen=seen))
        assert walk.all_seen == everything
        walk.place = 3
        assert walk.measured_in_sight == everything


def test_a_later_prediction_is_open_until_its_own_run_is_seen() -> None:
    """Two questions, each with a run of its own: the first run says nothing about the second question."""
    first, second = StepRecord("play", "Watch.", run="a", beside="b"), StepRecord("play", "Watch.", run="c")
    steps = (CHOICE, first, COMPARE, NUMBER, second, COMPARE)
    walk = Walk(msgspec.structs.replace(RECORD, steps=steps), news=LessonNews(seen=("b",)))
    assert [walk.frozen for walk.place in (0, 3)] == [True, False]
    walk.news = LessonNews(seen=("a", "b", "c"))
    assert [walk.frozen for walk.place in (0, 3)] == [True, True]


def test_the_run_on_stage_is_the_last_that_was_played() -> None:
    again = msgspec.structs.replace(
        RECORD, steps=(CHOICE, PLAY, COMPARE, StepRecord("play", "Then.", run="a"))
    )
    assert [Walk(again, place).played for place in range(4)] == ["b", "b", "b", "a"]


def test_predictions_are_compared_once() -> None:
    again = msgspec.structs.replace(RECORD, steps=(CHOICE, PLAY, COMPARE, NUMBER, PLAY, COMPARE))
    assert Walk(again, 2, {0: 1.0}).to_compare() == [(CHOICE, 1.0)]
    assert Walk(again, 5, {0: 1.0}).to_compare() == [(NUMBER, None)]


def test_what_was_seen_counts_more_than_what_was_rehearsed() -> None:
    seen = msgspec.structs.replace(RECORD, title="seen")
    walk = Walk(RECORD)
    assert walk.record is RECORD
    assert not walk.frozen
    walk = replace(walk, news=LessonNews("lesson.py", ("a", "b", "c"), "a", seen))
    assert walk.record is seen
    assert walk.frozen
