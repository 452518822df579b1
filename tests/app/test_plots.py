"""What the plots are given to draw."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.app.cursor import ABOVE, BELOW
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


def test_the_robot_beside_the_first_has_thin_curves_of_the_same_colour(desk, pushed, talos):
    rows = pushed.recording.rows(20)
    lines = [handle.series for handle in desk.handles]
    desk.plots.add(rows[:50])
    sent = sum(column.nbytes for handle in desk.handles for column in handle.data)
    leaning = rows.copy()
    leaning[:, pushed.recording.slices["com"].start] += 0.02
    desk.plots.add_beside(leaning[:50])
    desk.plots.draw()
    places = desk.handles[0]
    com, its_com = places.data[1][1:-1], places.data[-2][1:-1]
    # The CoM of the second robot is 2 cm further, seen from the same feet.
    np.testing.assert_allclose(its_com, com + 2.0, atol=1e-9)
    for handle, before in zip(desk.handles, lines, strict=True):
        assert len(handle.series) == len(handle.data)
        assert handle.series[: len(before)] == before
        strokes = [line["stroke"] for line in before[1:-1]]
        for thin in handle.series[len(before) :]:
            assert thin["stroke"] in strokes
            assert thin["width"] < before[1]["width"]
    desk.plots.alone()
    desk.plots.draw()
    assert [handle.series for handle in desk.handles] == lines
    assert (
        sum(column.nbytes for handle in desk.handles for column in handle.data) == sent
    )  # one robot costs no more


def test_a_robot_beside_one_at_rest_is_drawn_ten_times_a_second(desk, pushed):
    rows = pushed.recording.rows(20)
    still = np.repeat(rows[:1], 500, axis=0)
    still[:, 0] = 0.02 * np.arange(500)
    moving = still.copy()
    moving[:, pushed.recording.slices["com"].start] += 0.05 * np.sin(still[:, 0])
    desk.plots.add(still[:450])
    desk.plots.add_beside(moving[:450])
    drawn = 0
    for i in range(450, 500):
        desk.now += 0.02
        before = desk.handles[0].data
        desk.plots.add_beside(moving[i : i + 1])
        desk.plots.add(still[i : i + 1])
        drawn += desk.handles[0].data is not before
    assert 9 <= drawn <= 11


def test_the_curves_of_a_second_robot_end_with_its_fall(desk, pushed):
    rows = pushed.recording.rows(20)
    falling = rows.copy()
    falling[30:, pushed.recording.slices["fallen"]] = 1.0
    desk.plots.add(rows[:50])
    desk.plots.add_beside(falling[:50])
    desk.plots.draw()
    for handle in desk.handles:
        curve = handle.data[-1][1:-1]
        assert np.isfinite(curve[:30]).all()
        assert np.isnan(curve[30:]).all()


def test_lines_never_outnumber_columns(talos, pushed):
    """A line without data would end the plot in the browser."""

    class Watched(FakeGui):
        def add_uplot(self, data, series, **kw):
            handle = super().add_uplot(data, series, **kw)
            set_it = type(handle).__setattr__

            class Handle(type(handle)):
                def __setattr__(self, name, value):
                    set_it(self, name, value)
                    assert len(self.series) <= len(self.data)

            handle.__class__ = Handle
            return handle

    plots = Plots(Watched())
    plots.begin(talos, pushed.recording.layout)
    rows = pushed.recording.rows(20)
    plots.add(rows[:20])
    plots.add_beside(rows[:20])
    plots.draw()
    plots.alone()
    plots.add_beside(rows[:20])
    plots.begin(talos, pushed.recording.layout)
    plots.add(rows[:20])


def test_an_instant_that_is_looked_at_is_a_line_and_what_came_after_it_stays(desk, pushed):
    rows = pushed.recording.rows(20)
    desk.plots.add(rows)
    desk.plots.draw()
    whole = [handle.data for handle in desk.handles]
    assert all((data[-2][:-1] == BELOW).all() for data in whole)  # nobody looks back
    desk.plots.look_at(float(rows[20][0]))
    for handle, before in zip(desk.handles, whole, strict=True):
        assert len(handle.series) == len(handle.data)
        curves = zip(handle.data[1:-2], before[1:-2], strict=True)
        assert all(np.array_equal(now, then, equal_nan=True) for now, then in curves)
        time, line = handle.data[0][:-1], handle.data[-2][:-1]
        assert (line == np.where(time < rows[20][0], BELOW, ABOVE)).all()
        assert min(handle.scales["push"]["range"]) > BELOW
        assert max(handle.scales["push"]["range"]) < ABOVE
    desk.plots.look_at(np.inf)
    assert (desk.handles[0].data[-2][:-1] == BELOW).all()


def test_of_a_long_run_the_window_is_around_the_instant(desk, pushed):
    rows = standing_still(pushed, 30.0)
    desk.plots.add(rows)
    for instant in (0.0, 12.0, 29.9):
        desk.plots.look_at(instant)
        x = desk.handles[0].data[0]
        assert x[0] - 0.01 <= instant <= x[-1]
        assert x[-1] - x[0] == pytest.approx(WINDOW, abs=0.03)
        assert x[-1] == pytest.approx(min(30.0, max(WINDOW, instant + WINDOW / 2)), abs=0.03)
