"""Pictures and films show what happens around the pushes, and say so when nothing does."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.experiments.rest import com_speeds, rest_time
from momentum_lab.experiments.run_plots import over_time
from momentum_lab.experiments.window import Window, around_pushes, time_span, window
from momentum_lab.fall import Fall
from momentum_lab.finished import FinishedRun
from momentum_lab.physics.push import Push
from momentum_lab.replay import replayed
from momentum_lab.run_file import Run
from momentum_lab.scenario import Scenario
from momentum_lab.summary import SETTLED_SPEED
from tests.experiments.lasting import STEP, lasting

KEPT = Window(21.0, 81.0)
EARLY, FIRST, SECOND = (Push(force=217.0, start=start, duration=0.1) for start in (12.8, 40.0, 44.0))


@pytest.mark.parametrize(
    ("pushes", "fall", "rest", "expected"),
    [
        ((FIRST,), None, 41.6, Window(39.0, 46.6)),  # from 1 s before the push to 5 s after the rest
        ((FIRST, SECOND), None, 45.5, Window(39.0, 50.5)),
        ((SECOND, FIRST), None, 45.5, Window(39.0, 50.5)),  # in whatever order they were given
        ((EARLY, FIRST), None, 41.6, Window(39.0, 46.6)),  # what is not recorded does not count
        ((FIRST,), 40.7, None, Window(39.0, 45.7)),  # a fall is an end, too
        ((FIRST, SECOND), 40.7, None, Window(39.0, 49.1)),  # a push on a fallen robot is shown
        ((SECOND,), 41.0, None, Window(40.0, 49.1)),  # and so is a fall that no push has brought about
        ((FIRST,), 13.5, None, Window(39.0, 45.1)),  # but not one that is not recorded
        ((FIRST,), None, None, Window(39.0, 81.0)),  # it still moves
        ((FIRST,), None, 79.0, Window(39.0, 81.0)),  # no more than is recorded
        ((Push(force=9.0, start=20.95, duration=0.1),), None, 22.0, Window(21.0, 27.0)),
        ((EARLY,), None, 21.0, KEPT),
        ((Push(force=9.0, start=90.0),), None, 21.0, KEPT),  # it is still to come
        ((), 50.0, None, KEPT),
    ],
)
def test_it_reaches_from_before_the_first_push_to_after_the_end_of_the_last(pushes, fall, rest, expected):
    found = window(pushes, KEPT, fall, rest)
    assert (found.start, found.end) == pytest.approx((expected.start, expected.end))


def test_rest_is_when_the_last_movement_is_over():
    times, slow, fast = np.arange(6.0), 0.5 * SETTLED_SPEED, 2.0 * SETTLED_SPEED
    assert rest_time(times, np.array([fast, slow, fast, slow, slow, slow]), 0.5) == 3.0
    assert rest_time(times, np.array([fast, slow, slow, slow, slow, slow]), 0.5) == 0.5
    assert rest_time(times, np.array([slow, slow, slow, slow, slow, fast]), 0.5) is None
    assert rest_time(times, np.array([slow, slow, slow, slow, slow, np.nan]), 0.5) is None


@pytest.fixture(scope="module")
def short() -> FinishedRun:
    return FinishedRun.of(replayed(Run(Scenario("s", "Push", robot="g1"), (), ticks=2))[0])


def shown(run: FinishedRun) -> tuple[float, float]:
    part = time_span(run)
    return part.start, part.end


def test_a_run_keeps_the_samples_and_the_pushes_of_its_window(short):
    run = lasting(short, KEPT, Window(40.0, 41.6), pushes=(EARLY, FIRST))
    part = around_pushes(run)
    assert shown(part) == pytest.approx((39.0, 46.6), abs=1.5 * STEP)
    assert part.pushes == (FIRST,)
    assert (part.time, part.run) == (run.time, run.run)
    assert shown(run) == pytest.approx((21.0, 81.0))  # it is left as it was


def test_a_short_run_is_shown_whole(short):
    run = lasting(short, Window(0.0, 3.0), Window(0.5, 2.0), pushes=(Push(force=9.0, start=0.5),))
    assert around_pushes(run).recording is run.recording


def test_of_two_robots_the_slower_one_counts_and_both_are_cut_alike(short):
    fell = lasting(short, KEPT, Window(40.0, 81.1), pushes=(FIRST,), fall=Fall(43.0, "it fell"))
    run = lasting(short, KEPT, Window(40.0, 41.6), pushes=(FIRST,), beside=fell)
    part = around_pushes(run)
    assert part.beside is not None
    assert shown(part) == shown(part.beside) == pytest.approx((39.0, 48.0), abs=1.5 * STEP)


def test_a_robot_that_goes_with_its_ground_is_at_rest(short):
    run = lasting(short, Window(0.0, 1.0), Window(0.0, 1.1))
    time, place = (run.recording.slices[name] for name in ("time", "ground_pose"))
    for row in run.recording.rows():
        row[place] = row[place] + np.tile([0.3 * row[time][0], *np.zeros(6)], len(run.robot.soles))
    assert com_speeds(run) == pytest.approx(np.zeros(101), abs=1e-9)


@pytest.mark.parametrize(
    ("recorded", "pushes", "words", "span"),
    [
        (KEPT, (EARLY, FIRST), "217 N for 0.1 s", (39.0, 46.6)),
        (KEPT, (EARLY,), "the last 60 s hold no push", (21.0, 81.0)),
        (KEPT, (), "the last 60 s hold no push", (21.0, 81.0)),
        (Window(0.0, 2.0), (), "no push", (0.0, 2.0)),
    ],
)
def test_the_picture_shows_what_its_title_says(short, recorded, pushes, words, span):
    picture = over_time(lasting(short, recorded, Window(40.0, 41.6), pushes=pushes))
    assert picture.get_suptitle() == f"Push\n{short.robot.spec.title}, {words}"
    times = picture.axes[3].get_lines()[0].get_xdata()
    assert (times[0], times[-1]) == pytest.approx(span, abs=1.5 * STEP)
