"""The one line about a run: what happened, counted from the latest push before it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from momentum_lab.experiments.outcome import outcome
from momentum_lab.experiments.window import Window
from momentum_lab.fall import Fall
from momentum_lab.finished import FinishedRun
from momentum_lab.headless import Timing
from momentum_lab.physics.push import Push
from momentum_lab.replay import replayed
from momentum_lab.run_file import Run
from momentum_lab.scenario import Scenario
from momentum_lab.summary import summarize
from tests.experiments.lasting import lasting

FIRST, SECOND, TO_COME = (Push(force=9.0, start=start) for start in (2.0, 4.0, 60.0))
ALL = (SECOND, FIRST, TO_COME)  # in whatever order they were given
FELL = Fall(3.25, "it fell")


@pytest.fixture(scope="module")
def short() -> FinishedRun:
    return FinishedRun.of(replayed(Run(Scenario("s", robot="g1"), (), ticks=2))[0])


@pytest.mark.parametrize(
    ("recorded", "moving", "pushes", "fall", "words"),
    [
        (Window(0.0, 28.7), Window(2.0, 3.6), (FIRST,), None, "Stands, at rest 1.60 s after the push"),
        (
            Window(0.0, 28.7),
            Window(2.0, 5.6),
            (SECOND, FIRST, TO_COME),
            None,
            "Stands, at rest 1.60 s after the latest push",
        ),
        (Window(0.0, 6.0), Window(2.0, 9.0), (FIRST,), None, "Stands and still moves 4.00 s after the push"),
        (Window(0.0, 6.0), Window(0.0, 1.5), (), None, "Stands, at rest 1.50 s after the start"),
        (Window(0.0, 6.0), Window(9.0, 9.0), (), None, "Stands, at rest in all that is recorded"),
        (Window(5.0, 6.0), Window(9.0, 9.0), (FIRST,), None, "Stands, at rest in all that is recorded"),
        (Window(0.0, 6.0), Window(2.0, 9.0), (FIRST, SECOND), FELL, "Fell 1.25 s after the push: it fell"),
        (Window(0.0, 6.0), Window(2.0, 9.0), (), FELL, "Fell 3.25 s after the start: it fell"),
    ],
)
def test_seconds_count_from_the_latest_push(short, recorded, moving, pushes, fall, words):
    run = lasting(short, recorded, moving, pushes=pushes, fall=fall)
    assert outcome(run, summarize(run, Timing(np.zeros(0), float("inf")))) == words


def test_a_fall_before_it_came_is_not_its_own(short):
    run = replace(lasting(short, Window(4.0, 6.0), pushes=(FIRST,), fall=FELL), since=4.0)
    assert (
        outcome(run, summarize(run, Timing(np.zeros(0), float("inf")))) == "Had fallen already when it came"
    )
