"""The report, the plots and the table of a run: complete, self-contained, and numbers that are the run's."""

from __future__ import annotations

import base64
import csv
import dataclasses
import io
import re
from html.parser import HTMLParser

import msgspec
import numpy as np
import pytest
from PIL import Image

from momentum_lab.errors import InputError
from momentum_lab.events import LoggedEvent, SetFriction, SetGains
from momentum_lab.experiments.least_span import LEAST
from momentum_lab.experiments.run_plots import along, over_time, png
from momentum_lab.experiments.run_report import checks, report
from momentum_lab.experiments.run_table import header, table, thinned_words
from momentum_lab.finished import FinishedRun
from momentum_lab.headless import Timing
from momentum_lab.physics.push import Push
from momentum_lab.recording import Recording
from momentum_lab.replay import replayed
from momentum_lab.run_file import Run
from momentum_lab.scenario import Scenario
from momentum_lab.share_code import from_code
from momentum_lab.summary import summarize

SCENARIO = Scenario(
    "pushes", "Two <pushes>", "g1", pushes=(Push(force=60.0, start=0.05), Push(force=20.0, start=0.3))
)


@pytest.fixture(scope="module")
def run() -> FinishedRun:
    events = (LoggedEvent(20, SetGains({"linear_damping": 11.0})),)
    return FinishedRun.of(replayed(Run(SCENARIO, events, ticks=500))[0])


@pytest.fixture(scope="module")
def page(run: FinishedRun) -> str:
    return report(run).decode()


class Links(HTMLParser):
    """Everything a page would load, and whether its tags close."""

    def __init__(self) -> None:
        super().__init__()
        self.sources: list[str] = []
        self.open: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.sources += [value or "" for name, value in attrs if name in ("src", "href")]
        if tag not in ("meta", "img"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def test_it_needs_nothing_else_and_its_tags_close(page):
    links = Links()
    links.feed(page)
    assert links.open == []
    assert len(links.sources) == 2
    for source in links.sources:
        picture = Image.open(io.BytesIO(base64.b64decode(source.removeprefix("data:image/png;base64,"))))
        assert picture.size[0] > 600


def test_it_says_what_was_done_and_what_came_out(run, page):
    summary = summarize(run, Timing(np.zeros(0), float("inf")))
    assert f"{summary.impulse:.2f} N s" in page
    assert f"{1e3 * summary.peak_com_excursion:.1f} mm" in page
    assert "Stands" in page
    assert "set gains: linear_damping 11" in page
    assert re.search(r'class="changed"><td>linear damping</td><td>11 1/s</td><td>8</td>', page)
    assert page.count('class="changed"') == 1
    assert from_code(re.findall(r"<code>(.*?)</code>", page)[0]) == run.run


def test_titles_are_text_and_never_markup(page):
    assert "Two &lt;pushes&gt;" in page
    assert "<pushes>" not in page


def test_the_checks_hold_and_can_fail(run):
    summary = summarize(run, Timing(np.zeros(0), float("inf")))
    assert all(claim.holds for claim in checks(run, summary))
    worse = msgspec.structs.replace(summary, qp_failures=2, max_equation_residual=1e-3)
    recording = Recording(run.recording.layout, len(run.recording))
    for row in run.recording.rows():
        recording.next_row()[:] = row
    recording.rows()[7, recording.slices["foot_wrench_measured"].start + 2] = -50.0  # pulls
    pulled = dataclasses.replace(run, recording=recording)
    assert [claim.holds for claim in checks(pulled, worse)] == [False, False, False, False]


def test_on_other_ground_the_vertical_is_no_normal_and_nothing_is_claimed_about_it(run):
    summary = summarize(run, Timing(np.zeros(0), float("inf")))
    moved = msgspec.structs.replace(run.run, events=(LoggedEvent(5, SetFriction(0.3)),))
    texts = [claim.text for claim in checks(dataclasses.replace(run, run=moved), summary)]
    assert len(texts) == 2
    assert not any("Friction" in text for text in texts)


def test_without_samples_there_is_no_report(run):
    empty = Recording(run.recording.layout, 1)
    with pytest.raises(InputError, match="a run of at least one tick"):
        report(dataclasses.replace(run, recording=empty))


def test_the_same_run_gives_the_same_picture(run):
    assert png(over_time(run)) == png(over_time(run))


def test_plots_look_along_the_largest_push(run):
    assert along(run) == pytest.approx([1.0, 0.0])


def test_the_table_is_the_recording(run):
    lines = list(csv.reader(io.StringIO(table(run).decode())))
    assert lines[0] == header(run)
    assert len(set(lines[0])) == len(lines[0]) == run.recording.layout.width
    values = np.array(lines[1:], dtype=float)
    assert values == pytest.approx(run.recording.rows(), rel=1e-8, abs=1e-12, nan_ok=True)
    column = lines[0].index("com/z [m]")
    assert values[:, column] == pytest.approx(run.recording.column("com")[:, 2], rel=1e-8)
    weight = values[0, lines[0].index("foot_wrench_measured/left/fz [N]")]
    assert weight == pytest.approx(0.5 * 9.81 * run.robot.mass, rel=0.05)


def test_every_number_of_a_joint_or_the_base_has_its_name_and_unit(run):
    """A column is the joint's own, and no number of a run is called by a bare count."""
    lines = list(csv.reader(io.StringIO(table(run).decode())))
    values, robot = np.array(lines[1:], dtype=float), run.robot
    for joint, name in enumerate(robot.joint_names):
        for quantity, unit, first in (("q", "rad", 7), ("v", "rad/s", 6), ("torque", "N m", 0)):
            column = values[:, lines[0].index(f"{quantity}/{name} [{unit}]")]
            assert column == pytest.approx(run.recording.column(quantity)[:, first + joint], rel=1e-8)
    assert lines[0][:2] == ["time [s]", "q/base_x [m]"]
    without = {name for name in lines[0] if "[" not in name}
    flags = {"torque_ratio", "priority", "solver_failed", "fallen"}
    assert {name for name in without if name.rpartition("/")[2].removeprefix("base_")[:1] != "q"} == flags
    assert not any(part.isdigit() for name in lines[0] for part in name.split("/"))


def test_a_long_run_gives_a_thinner_table(run):
    lines = table(run, most=100).decode().splitlines()
    assert len(lines) == 1 + 100
    assert float(lines[2].split(",")[0]) == pytest.approx(5 * run.scenario.timestep)


def test_a_thinner_table_says_how_thin_it_is(run):
    """500 ticks of 1 ms: all of them, every fifth, a single one, none."""
    words = {most: thinned_words(table(run, most), run.scenario.timestep) for most in (500, 100, 1)}
    assert words[100].startswith("The table holds one tick in 5, a row each 5 ms")
    assert words[500] == words[1] == ""
    empty = dataclasses.replace(run, recording=Recording(run.recording.layout, 1))
    assert thinned_words(table(empty), run.scenario.timestep) == ""


def test_a_robot_at_rest_looks_at_rest():
    """Noise of millionths of a newton is no curve: every axis shows as much as the page does, and no spike is cut."""
    still = FinishedRun.of(replayed(Run(Scenario("still", robot="g1"), (), ticks=40))[0])
    axes = over_time(still).axes
    for chart, least in zip(axes[1:], ("linear", "angular", "momenta"), strict=True):
        low, high = chart.get_ylim()
        assert (low, high) == (-LEAST[least], LEAST[least])
        assert not chart.texts
    low, high = axes[0].get_ylim()
    assert high - low > 2.0 * LEAST["places"]


def test_what_is_larger_than_the_least_is_seen_whole():
    hard = Scenario("hard", robot="g1", pushes=(Push(force=120.0, start=0.01),))
    chart = over_time(FinishedRun.of(replayed(Run(hard, (), ticks=150))[0])).axes[3]
    drawn = np.concatenate([line.get_ydata() for line in chart.get_lines()])
    low, high = chart.get_ylim()
    assert low <= -LEAST["momenta"]
    assert high > drawn.max() > LEAST["momenta"]
