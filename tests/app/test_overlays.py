"""Marks as data: where they are, when they exist, what their numbers say."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from momentum_lab.app.marks import STYLES
from momentum_lab.app.overlays import Mark, Picture, overlays
from momentum_lab.app.steady import FIGURE_SPACE
from momentum_lab.physics.push import Push
from momentum_lab.recording import Layout
from tests.app.conftest import changed_sample, sample_at
from tests.conftest import assert_close
from tests.runs import PUSH_END, PUSH_START

WEIGHT = 90.272192 * 9.81


@pytest.fixture
def picture(talos, pushed) -> Picture:
    return Picture(talos, pushed.pushes[0], safe_border=0.005)


def drawn(sample, picture) -> dict[str, Mark]:
    return {mark.key: mark for mark in overlays(sample, picture)}


def points(mark: Mark) -> np.ndarray:
    return np.array(mark.points)


def number(text: str) -> float:
    return next(float(word) for word in text.split() if word.replace("-", "").isdigit())


def test_every_mark_has_a_style_and_appears_once(saturated, picture):
    keys = [mark.key for mark in overlays(saturated, picture)]
    assert set(keys) == set(STYLES)
    assert len(keys) == len(set(keys))


def test_com_and_the_point_below_it(saturated, picture):
    marks = drawn(saturated, picture)
    assert_close(points(marks["com"])[0], saturated["com"], 1e-12)
    assert_close(points(marks["com_ground"])[0, :2], saturated["com"][:2], 1e-12)
    assert 0.0 < points(marks["com_ground"])[0, 2] < 0.02


def test_arrow_of_the_ground_reaction_force(saturated, picture):
    # The net force is what changes the momentum besides weight; the push has just ended.
    start, end = points(drawn(saturated, picture)["grf"])
    force = saturated["momentum_rate_measured"][:3] + [0.0, 0.0, WEIGHT]
    assert_close(start[:2], saturated["cop_measured"], 1e-12)
    assert_close(np.cross(end - start, force) / WEIGHT, 0.0, 1e-9)
    assert number(drawn(saturated, picture)["grf"].text) == pytest.approx(np.linalg.norm(force), abs=0.51)


def test_arrow_of_a_standing_robots_weight_ends_at_its_com(standing, picture):
    _, end = points(drawn(standing, picture)["grf"])
    assert end[2] == pytest.approx(standing["com"][2], abs=0.01)


def test_arrows_scale(saturated, talos, picture):
    twice = Picture(talos, picture.push, picture.safe_border, arrow_scale=2.0)
    for key in ("grf", "foot_grf", "push"):
        once_arrow, twice_arrow = (points(drawn(saturated, p)[key]) for p in (picture, twice))
        assert_close(twice_arrow[1] - twice_arrow[0], 2.0 * (once_arrow[1] - once_arrow[0]), 1e-9)


def test_line_from_com_to_cmp_is_parallel_to_the_force(saturated, picture):
    marks = drawn(saturated, picture)
    line = np.diff(points(marks["com_cmp"]), axis=0)[0]
    arrow = np.diff(points(marks["grf"]), axis=0)[0]
    assert_close(
        np.cross(line / np.linalg.norm(line), arrow / np.linalg.norm(arrow)), 0.0, 1e-2
    )  # the end on the ground is raised by millimetres


def test_the_label_of_the_force_keeps_its_width(talos, standing, picture):
    wrench = standing["foot_wrench_measured"]
    layout, parts = Layout.of(talos), (0.05, 0.4, 1.0, 1.1)
    pressed = [changed_sample(standing, layout, foot_wrench_measured=part * wrench) for part in parts]
    texts = [drawn(sample, picture)["grf"].text for sample in pressed]  # 44 to 974 N
    assert len({len(text) for text in texts}) == 1
    assert [number(text) for text in texts] == pytest.approx([part * WEIGHT for part in parts], rel=0.02)


def test_gap_tells_the_rate_of_angular_momentum(saturated, picture):
    # No push acts any more: dk/dt about the horizontal axes is the moment of the ground about the CoM.
    gap = drawn(saturated, picture)["gap"]
    moment = np.linalg.norm(saturated["momentum_rate_measured"][3:5])
    assert moment > 20.0
    assert gap.text.replace(FIGURE_SPACE, "") == f"rate of angular momentum {moment:.0f} N m"
    assert_close(points(gap)[:, :2], [saturated["cop_measured"], saturated["cmp"]], 1e-12)


def test_a_standing_robot_has_no_gap(standing, picture):
    assert "gap" not in drawn(standing, picture)


def test_support_is_the_hull_of_both_soles(standing, talos, picture):
    corners = points(drawn(standing, picture)["support"])[:, :2]
    assert corners.min(axis=0).tolist() == pytest.approx([-0.100, -0.145], abs=2e-3)
    assert corners.max(axis=0).tolist() == pytest.approx([0.091, 0.145], abs=2e-3)


def test_support_of_one_foot(standing, pushed, talos):
    wrench = standing["foot_wrench_measured"].copy()
    wrench[1] = 0.0  # feet are left, right
    lifted = changed_sample(standing, pushed.recording.layout, foot_wrench_measured=wrench)
    corners = points(drawn(lifted, Picture(talos))["support"])[:, :2]
    assert corners[:, 1].min() == pytest.approx(0.085 - 0.060, abs=2e-3)


def test_margin_is_the_distance_to_the_nearest_edge(saturated, picture):
    # At the toes the nearest edge is the line x = front of the soles.
    text = drawn(saturated, picture)["safe_border"].text
    assert text == f"CoP {1e3 * (0.091 - saturated['cop_measured'][0]):.0f} mm from the edge"


def test_dashes_keep_the_safe_border(standing, picture):
    dashes = points(drawn(standing, picture)["safe_border"])
    assert len(dashes) % 2 == 0
    assert dashes[:, 0].max() == pytest.approx(0.091 - 0.005, abs=2e-3)


def test_desired_and_granted_cop_stand_apart_when_priority_gives_way(saturated, picture):
    marks = drawn(saturated, picture)
    desired, granted = points(marks["cop_desired"])[0], points(marks["cop_granted"])[0]
    assert desired[0] - granted[0] > 0.02
    assert granted[0] == pytest.approx(0.091 - 0.005, abs=2e-3)


def test_push_is_drawn_while_it_acts_and_a_moment_longer(pushed, picture):
    for time, there in ((PUSH_START - 0.01, False), (PUSH_START + 0.01, True), (PUSH_END + 0.9, True)):
        assert ("push" in drawn(sample_at(pushed, time), picture)) == there
    assert "push" not in drawn(sample_at(pushed, PUSH_END + 1.1), picture)


def test_push_points_where_it_pushes(saturated, talos):
    push = Push(force=100.0, direction_deg=90.0, start=saturated.number("time"), height=1.2)
    mark = drawn(saturated, Picture(talos, push))["push"]
    start, end = points(mark)
    assert_close((end - start) / np.linalg.norm(end - start), [0.0, 1.0, 0.0], 1e-12)
    assert end[2] == pytest.approx(1.2, abs=1e-3)
    assert mark.text == "100 N for 100 ms"


def test_in_flight_only_what_exists_is_drawn(standing, pushed, talos):
    flying = changed_sample(
        standing,
        pushed.recording.layout,
        foot_wrench_measured=0.0,
        cop_measured=np.nan,
        cmp=np.nan,
        foot_cop_measured=np.nan,
    )
    assert set(drawn(flying, Picture(talos))) == {"com", "com_ground", "capture"}


def test_marks_are_plain_data_that_can_be_compared(saturated, picture):
    assert overlays(saturated, picture) == overlays(saturated, picture)
    moved = Picture(
        picture.robot, msgspec.structs.replace(picture.push, direction_deg=180.0), picture.safe_border
    )
    assert overlays(saturated, moved) != overlays(saturated, picture)
