"""What the plots are given to draw."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.app.plots import Plots
from momentum_lab.app.series import WINDOW
from tests.app.fakes import FakeGui


class Desk:
    def __init__(self) -> None:
        self.gui = FakeGui()
        self.now = 0.0
        self.plots = Plots(self.gui, clock=lambda: self.now)

    @property
    def handles(self) -> list:
        return list(self.gui.widgets.values())


@pytest.fixture
def desk(talos, pushed) -> Desk:
    desk = Desk()
    desk.plots.begin(talos, pushed.recording.layout)
    return desk


def test_four_plots_with_units_in_their_titles(desk):
    titles = " ".join(handle.content for handle in desk.gui.html)
    for unit in ("(cm)", "(N)", "(N m)", "(N s)", "(kg m²/s)"):
        assert unit in titles
    assert len(desk.handles) == 4


def test_series_fit_the_data_at_all_times(desk, pushed):
    for handle in desk.handles:
        assert len(handle.series) == len(handle.data)
    desk.plots.add(pushed.recording.rows(20))
    for handle in desk.handles:
        assert len(handle.series) == len(handle.data)
        assert len({len(column) for column in handle.data}) == 1


def test_time_is_simulated_seconds_and_not_a_date(desk):
    assert all(handle.scales["x"] == {"time": False} for handle in desk.handles)


def test_the_time_axis_always_spans_the_window(desk, pushed):
    desk.plots.add(pushed.recording.rows(20)[:10])
    x = desk.handles[0].data[0]
    assert (x[0], x[-1]) == pytest.approx((0.0, WINDOW), abs=1e-3)
    assert (np.diff(x) >= 0.0).all()


def test_the_ends_of_the_time_axis_change_with_every_drawing(desk, pushed):
    ends = []
    for i in range(5):
        desk.now += 1.0
        desk.plots.add(pushed.recording.rows(20)[i : i + 1])
        ends.append(desk.handles[0].data[0][-1])
    assert len(set(ends)) == 5


def test_the_first_value_is_a_number(desk, pushed):
    # uPlot takes it for the smallest and largest so far; a NaN would stay.
    rows = pushed.recording.rows(20).copy()
    rows[0, pushed.recording.slices["cop_measured"]] = np.nan
    desk.plots.add(rows)
    assert all(np.isfinite(column[0]) for handle in desk.handles for column in handle.data)


def test_limits_have_no_gaps(desk, pushed):
    rows = pushed.recording.rows(20).copy()
    rows[5:8, pushed.recording.slices["foot_wrench_measured"]] = 0.0
    desk.plots.add(rows)
    for limit in desk.handles[0].data[5:7]:
        assert np.isfinite(limit).all()


def test_a_push_that_goes_on_is_not_drawn_into_the_future(desk, pushed):
    rows = pushed.recording.rows(20)
    during = pushed.recording.column("push_wrench", 20).any(axis=1)
    desk.plots.add(rows[: np.flatnonzero(during)[-1] + 1])
    for handle in desk.handles:
        column = handle.data[-1]
        assert column[-3:-1].tolist() == [1.0, 0.0]
        assert np.isnan(column[-1])


def test_ten_drawings_a_second(desk, pushed):
    rows = pushed.recording.rows(20)
    drawn = 0
    for i in range(40):
        desk.now = 0.025 * i
        before = desk.handles[0].data
        desk.plots.add(rows[i : i + 1])
        drawn += desk.handles[0].data is not before
    assert drawn == 10


def test_the_last_samples_before_a_pause_can_be_drawn_at_once(desk, pushed):
    rows = pushed.recording.rows(20)
    desk.plots.add(rows[:5])
    desk.plots.add(rows[5:9])
    assert len(desk.handles[0].data[0]) == 5 + 2
    desk.plots.draw()
    assert len(desk.handles[0].data[0]) == 9 + 2


def test_curves_follow_the_direction_of_the_push(desk, pushed):
    rows = pushed.recording.rows(20)
    desk.plots.add(rows)
    forward = np.nanmax(desk.handles[1].data[3])
    desk.now += 1.0
    desk.plots.along(np.array([0.0, 1.0]))
    desk.plots.add(rows[:0])
    assert np.nanmax(desk.handles[1].data[3]) < 0.1 * forward


def standing_still(pushed, seconds: float) -> np.ndarray:
    """The sample before the push, at the pace of the plots."""
    times = np.arange(0.0, seconds, 0.02)
    rows = np.tile(pushed.recording.rows()[0], (len(times), 1))
    rows[:, pushed.recording.slices["time"].start] = times
    return rows


def drawings(desk: Desk, rows: np.ndarray) -> int:
    """How often the plots are drawn while the samples come, 50 a second."""
    count = 0
    for row in rows:
        desk.now += 0.02
        before = desk.handles[0].data
        desk.plots.add(row[None])
        count += desk.handles[0].data is not before
    return count


def test_a_robot_at_rest_has_its_plots_drawn_once_a_second(desk, pushed):
    rows = standing_still(pushed, WINDOW + 5.0)
    filling = round(WINDOW / 0.02)
    assert drawings(desk, rows[:filling]) > 60
    assert drawings(desk, rows[filling:]) <= 6


@pytest.mark.parametrize(
    ("name", "change"), [("com", 0.002), ("momentum_rate_measured", 2.0), ("momentum", 0.2)]
)
def test_what_can_be_seen_in_a_plot_is_drawn_at_once(desk, pushed, name, change):
    rows = standing_still(pushed, WINDOW + 3.0)
    drawings(desk, rows[:-50])
    rows[-50:, pushed.recording.slices[name].start] += change
    assert drawings(desk, rows[-50:]) >= 8


def test_what_is_not_a_number_is_not_at_rest(desk, pushed):
    rows = standing_still(pushed, WINDOW + 3.0)
    drawings(desk, rows[:-50])
    rows[-50:, pushed.recording.slices["cop_measured"]] = np.nan
    assert drawings(desk, rows[-50:]) >= 8
