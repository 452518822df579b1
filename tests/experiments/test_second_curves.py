"""Two robots in what is made of a run: the second is dashed in pictures, and has columns of its own in a table."""

from __future__ import annotations

import csv
import io
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.colors import to_hex

from momentum_lab.beside import Beside
from momentum_lab.experiments.run_plots import on_the_ground, over_time
from momentum_lab.experiments.run_report import report
from momentum_lab.experiments.run_table import table
from momentum_lab.fall import Fall
from momentum_lab.finished import FinishedRun
from momentum_lab.headless import Timing
from momentum_lab.physics.push import Push
from momentum_lab.recording import Recording
from momentum_lab.replay import replayed
from momentum_lab.run_file import Run
from momentum_lab.scenario import Scenario, sides
from momentum_lab.summary import summarize

LATE = 60
TICKS = 300


@pytest.fixture(scope="module")
def pair() -> FinishedRun:
    """Two robots, of which the second came 60 ticks later and stopped 40 ticks earlier."""
    scenario = Scenario(
        "pair", robot="g1", pushes=(Push(force=60.0, start=0.05),), beside=Beside(priority=1.0)
    )
    runs = [FinishedRun.of(replayed(Run(side, (), ticks=TICKS))[0]) for side in sides(scenario)]
    short = Recording(runs[1].recording.layout, TICKS)
    for row in runs[1].recording.rows()[LATE : TICKS - 40]:
        short.next_row()[:] = row
    return replace(runs[0], beside=replace(runs[1], recording=short))


def drawn(axes) -> list[np.ndarray]:
    """The values of all curves."""
    return [line.get_ydata() for line in axes.get_lines()]


def test_the_second_is_dashed_in_the_colours_of_the_first(pair):
    recording = pair.beside.recording
    places, linear, angular, momenta = over_time(pair).axes
    rate = recording.column("momentum_rate_measured")
    momentum = recording.column("momentum")
    expected = (
        (linear, rate[:, 0]),
        (angular, rate[:, 4]),
        (momenta, momentum[:, 0]),
        (momenta, momentum[:, 4]),
    )
    for axes, values in expected:
        assert any(np.array_equal(curve, values) for curve in drawn(axes))
    com, cop = (curve for curve in drawn(places) if len(curve) == len(recording))
    moved = 100.0 * recording.column("com")[:, 0]
    assert com - com[0] == pytest.approx(moved - moved[0], abs=1e-9)
    pressed = 100.0 * recording.column("cop_measured")[:, 0]
    assert com - cop == pytest.approx(moved - pressed, abs=1e-9)
    for axes in (places, linear, angular, momenta):
        seconds = [line for line in axes.get_lines() if line.get_label() == "_second"]
        firsts = {to_hex(line.get_color()) for line in axes.get_lines() if line not in seconds}
        assert seconds
        assert all(line.get_linestyle() == "--" for line in seconds)
        assert {to_hex(line.get_color()) for line in seconds} <= firsts


def test_pictures_say_which_curves_are_whose(pair):
    for axes in (over_time(pair).axes[0], on_the_ground(pair).axes[0]):
        said = {text.get_text(): line for text, line in zip(*named(axes), strict=True)}
        assert said["priority 0"].get_linestyle() == "-"
        assert said["priority 1"].get_linestyle() == "--"


def named(axes) -> tuple[list, list]:
    legend = axes.get_legend()
    return legend.get_texts(), legend.legend_handles


def test_a_second_that_falls_is_drawn_until_then_and_leaves_room_for_the_first(pair):
    rows = pair.beside.recording.rows().copy()
    slices = pair.beside.recording.slices
    rows[-20:, slices["fallen"]] = 1.0
    rows[-25:, slices["momentum_rate_measured"]] = 1e5
    tumbling = Recording(pair.recording.layout, TICKS)
    for row in rows:
        tumbling.next_row()[:] = row
    _, linear, _, _ = over_time(replace(pair, beside=replace(pair.beside, recording=tumbling))).axes
    curve = next(values for values in drawn(linear) if len(values) == len(rows))
    assert np.isnan(curve[-20:]).all()
    assert np.isfinite(curve[:-20]).all()
    assert linear.get_ylim()[1] < 1e3


def test_a_table_has_the_second_behind_the_first(pair):
    alone = list(csv.reader(io.StringIO(table(replace(pair, beside=None)).decode())))
    both = list(csv.reader(io.StringIO(table(pair).decode())))
    width = len(alone[0])
    assert [row[:width] for row in both] == alone
    assert both[0][width:] == [f"second/{name}" for name in alone[0]]
    values = np.array([row[width:] for row in both[1:]], dtype=float)
    there = values[LATE : TICKS - 40]
    assert there == pytest.approx(pair.beside.recording.rows(), rel=1e-8, abs=1e-12, nan_ok=True)
    assert np.isnan(values[:LATE]).all()
    assert np.isnan(values[TICKS - 40 :]).all()


def test_a_thinner_table_has_both_at_the_same_instants(pair):
    rows = list(csv.reader(io.StringIO(table(pair, most=100).decode())))
    times = [(row[0], row[len(row) // 2]) for row in rows[1:]]
    assert len(times) == 100
    assert all(first == second for first, second in times[20:86])


def test_a_report_has_both_side_by_side(pair):
    page = report(pair).decode()
    summaries = [summarize(run, Timing(np.zeros(0), np.inf)) for run in (pair, pair.beside)]
    momenta = "".join(f"<td>{each.peak_angular_momentum:.2f} kg m²/s</td>" for each in summaries)
    assert f"<td>angular momentum at most</td>{momenta}" in page
    assert "<th></th><th>priority 0</th><th>priority 1</th>" in page
    assert "<td>priority</td><td>0</td><td>1</td>" in page
    for words in ("priority 0: stands", "priority 1: stands"):
        assert f'<p class="result">{words}' in page
    for heading in ("What was checked: priority 0", "What was checked: priority 1"):
        assert f"<h2>{heading}</h2>" in page


def test_a_report_blames_nobody_for_lying_where_another_fell(pair):
    fallen = replace(pair.beside, fall=Fall(0.02, "x"), since=LATE * 1e-3)
    assert "priority 1: had fallen already when it came" in report(replace(pair, beside=fallen)).decode()
    own = replace(fallen, fall=Fall(0.2, "the CoM sank"))
    assert (
        "priority 1: fell 0.15 s after the push: the CoM sank" in report(replace(pair, beside=own)).decode()
    )
