"""Runs compared by a person: two robots at once, one run after another, and a push that is only tried."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import expect

from tests.browser.conftest import OUTPUT, Opener, Served, serve
from tests.browser.lab_page import CANVAS, PATIENCE, TALL, differing

pytestmark = [pytest.mark.browser, pytest.mark.timeout(240)]


@pytest.fixture
def served_fig7(tmp_path: Path) -> Iterator[Served]:
    """The lab with the two robots of Fig. 7."""
    yield from serve(tmp_path, "coarse", "fig7")


def test_two_robots_one_stands_and_one_falls(served_fig7: Served, open_page: Opener) -> None:
    lab = open_page(served_fig7.url, height=TALL).until_furnished()
    lab.open_tab("4", "Runs")
    lab.expect_text(r"fell after 1\.[0-9]+ s")
    lab.expect_status("priority 0: standing; priority 1: fell at 1")
    lab.expect_points(0, 11, 21)  # the thin curve of the second robot's CoM
    lab.pause()
    lab.save(OUTPUT / "two_robots_test.png")
    both = lab.picture(CANVAS)
    lab.page.get_by_label("a second robot").first.evaluate("box => box.click()")
    expect(lab.page.locator("[data-runs]")).to_have_count(0, timeout=PATIENCE)
    lab.picture_with(lambda now: differing(now, both) > 0.02, "still two robots")


def test_a_kept_run_goes_along_as_a_ghost(served: Served, open_page: Opener) -> None:
    lab = open_page(served.url, height=TALL).until_furnished()
    lab.press("p")
    lab.expect_com_travel(1.0)
    lab.open_tab("2", "Control")
    lab.slide("priority", "End")
    lab.press("n")
    lab.open_tab("4", "Runs")
    expect(lab.page.locator("[data-runs]")).to_contain_text("priority", timeout=PATIENCE)
    lab.expect_com_travel(1.0)
    lab.expect_points(0, 7, 21)  # the dashed curve of the CoM
    lab.pause()
    lab.save(OUTPUT / "ghost_test.png")
    with_ghost = sky(lab.picture(CANVAS))
    lab.press("g")
    assert with_ghost > 0.01
    lab.picture_with(lambda now: sky(now) < 0.2 * with_ghost, "the ghost is still there")


def test_a_push_is_only_tried(served: Served, open_page: Opener) -> None:
    lab = open_page(served.url, height=TALL).until_furnished()
    lab.pause()
    before = lab.picture(CANVAS)
    lab.press("f")
    lab.picture_with(lambda now: differing(now, before) > 5e-4, "nothing is foreseen")
    lab.save(OUTPUT / "what_if_test.png")
    lab.expect_text("Tried, not pushed: would stand; the CoM goes [0-9]+ mm")


def sky(picture: np.ndarray) -> float:
    """The part of a picture that is as blue as a ghost."""
    return float((picture[..., 2] - picture[..., 0] > 40).mean())
