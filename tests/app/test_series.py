"""Curves are the samples' quantities along the push, in the units the plots say."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.app.series import KEPT, WINDOW, History
from momentum_lab.app.support_now import extent
from tests.conftest import assert_close
from tests.runs import PUSH_END, PUSH_START

FORWARD, LEFT = np.array([1.0, 0.0]), np.array([0.0, 1.0])


@pytest.fixture
def history(pushed, talos) -> History:
    history = History(talos, pushed.recording.layout)
    history.add(pushed.recording.rows(20))
    return history


def test_times_and_pushes(history):
    curves = history.curves(FORWARD)
    assert_close(np.diff(curves.time), 0.02, 1e-9)
    during = (curves.time >= PUSH_START - 1e-9) & (curves.time < PUSH_END - 1e-9)
    assert curves.pushed.tolist() == during.astype(float).tolist()


def test_points_are_centimetres_from_the_middle_of_the_support(history, pushed):
    curves = history.curves(FORWARD)
    com = pushed.recording.column("com", 20)[:, 0]
    middle = 0.5 * (-0.100 + 0.091)
    assert_close(curves.points["com"], 100.0 * (com - middle), 0.1)
    assert curves.limits[0][0] == pytest.approx(-9.55, abs=0.1)
    assert curves.limits[1][0] == pytest.approx(9.55, abs=0.1)
    assert (curves.points["cop"] <= curves.limits[1] + 0.05).all()


def test_rates_along_and_about(history, pushed):
    rate = pushed.recording.column("momentum_rate_measured", 20)
    forward, left = history.curves(FORWARD), history.curves(LEFT)
    assert_close(forward.linear["measured"], rate[:, 0], 1e-9)
    assert_close(forward.angular["measured"], rate[:, 4], 1e-9)
    assert_close(left.linear["measured"], rate[:, 1], 1e-9)
    assert_close(left.angular["measured"], -rate[:, 3], 1e-9)


def test_momentum_is_the_integral_of_its_rate(history):
    curves = history.curves(FORWARD)
    rate = curves.linear["measured"]
    gained = 0.5 * ((rate[1:] + rate[:-1]) * np.diff(curves.time)).sum()
    assert gained == pytest.approx(curves.momentum[-1] - curves.momentum[0], abs=1.5)


def test_a_fall_forward_turns_about_the_axis_across(history):
    # While the CoP is stuck at the toes the body turns with the push.
    curves = history.curves(FORWARD)
    assert curves.angular_momentum[np.argmin(np.abs(curves.time - 0.4))] > 1.0


@pytest.fixture
def long_history(talos, pushed) -> History:
    """More than a minute of the same sample."""
    history = History(talos, pushed.recording.layout)
    for time in np.arange(0.0, 70.0, 0.02):
        history.add(_at(pushed, time))
    return history


def _at(pushed, time: float) -> np.ndarray:
    row = pushed.recording.rows()[0].copy()
    row[pushed.recording.slices["time"].start] = time
    return row[None]


def test_only_the_window_is_shown_and_a_minute_kept(long_history):
    times = long_history.curves(FORWARD).time
    assert times[-1] == pytest.approx(69.98)
    assert times[-1] - times[0] == pytest.approx(KEPT, WINDOW, abs=0.03)
    assert len(long_history) == pytest.approx(KEPT / 0.02, abs=2)
    long_history.clear()
    assert len(long_history) == 0


def test_looking_back_the_window_ends_there(long_history):
    times = long_history.curves(FORWARD, until=30.0).time
    assert times[-1] == pytest.approx(30.0)
    assert times[-1] - times[0] == pytest.approx(KEPT, WINDOW, abs=0.03)
    assert long_history.curves(FORWARD, until=1.0).time[-1] == pytest.approx(10.0, abs=0.03)  # the oldest


def test_a_branch_replaces_what_came_after_it(pushed, long_history):
    long_history.add(_at(pushed, 40.013))
    times = long_history.curves(FORWARD).time
    assert times[-2:] == pytest.approx([40.0, 40.013])


def test_extent_of_a_rectangle_along_its_diagonal():
    rectangle = np.array([[-3.0, -4.0], [3.0, -4.0], [3.0, 4.0], [-3.0, 4.0]])
    assert extent(rectangle, np.array([0.6, 0.8])) == pytest.approx((-5.0, 5.0))
    assert np.isnan(extent(rectangle[:2], FORWARD)).all()
