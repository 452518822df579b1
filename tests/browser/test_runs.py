"""Runs compared by a person: two robots at once, one run after another, and a push that is only tried."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import expect

from tests.browser.conftest import OUTPUT, Opener, Served, serve
from tests.browser.lab_page import CANVAS, PATIENCE, LabPage

pytestmark = [pytest.mark.browser, pytest.mark.timeout(240)]


@pytest.fixture
def served_fig7(tmp_path: Path) -> Iterator[Served]:
    """The lab with the two robots of Fig. 7."""
    yield from serve(tmp_path, "test", "fig7")


def test_two_robots_one_stands_and_one_falls(served_fig7: Served, open_page: Opener) -> None:
    lab = open_page(served_fig7.url).until_furnished()
    lab.open_tab("4", "Runs")
    lab.expect_text(r"fell after 1\.[0-9]+ s")
    lab.expect_status("priority 0: standing; priority 1: fell at 1")
    lab.page.wait_for_timeout(2500)
    pause(lab)
    lab.save(OUTPUT / "two_robots_test.png")
    both = lab.picture(CANVAS)
    assert np.isfinite(lab.curve(0, 11)).sum() > 20  # the thin curve of the second robot's CoM
    lab.page.get_by_label("a second robot").first.evaluate("box => box.click()")
    expect(lab.page.locator("[data-runs]")).to_have_count(0, timeout=PATIENCE)
    assert differing(lab.picture(CANVAS), both) > 0.02


def test_a_kept_run_goes_along_as_a_ghost(served: Served, open_page: Opener) -> None:
    lab = open_page(served.url).until_furnished()
    lab.press("p")
    lab.expect_com_travel(1.0)
    lab.page.wait_for_timeout(1000)
    lab.open_tab("2", "Control")
    lab.slide("priority", "End")
    lab.press("n")
    lab.open_tab("4", "Runs")
    expect(lab.page.locator("[data-runs]")).to_contain_text("priority", timeout=PATIENCE)
    lab.expect_com_travel(1.0)
    pause(lab)
    lab.save(OUTPUT / "ghost_test.png")
    assert np.isfinite(lab.curve(0, 7)).sum() > 20  # the dashed curve of the CoM
    with_ghost = sky(lab.picture(CANVAS))
    lab.press("g")
    lab.page.wait_for_timeout(1500)
    assert with_ghost > 0.01
    assert sky(lab.picture(CANVAS)) < 0.2 * with_ghost


def test_a_push_is_only_tried(served: Served, open_page: Opener) -> None:
    lab = open_page(served.url).until_furnished()
    pause(lab)
    before = lab.picture(CANVAS)
    lab.press("f")
    lab.page.wait_for_timeout(3000)
    after = lab.picture(CANVAS)
    lab.save(OUTPUT / "what_if_test.png")
    assert differing(after, before) > 5e-4
    lab.expect_text("Tried, not pushed: would stand; the CoM goes [0-9]+ mm")


def pause(lab: LabPage) -> None:
    lab.press("k")
    lab.expect_text("paused")


def differing(one: np.ndarray, other: np.ndarray) -> float:
    """The part of two pictures that is not the same."""
    return float((np.abs(one - other).max(axis=2) > 40).mean())


def sky(picture: np.ndarray) -> float:
    """The part of a picture that is as blue as a ghost."""
    return float((picture[..., 2] - picture[..., 0] > 40).mean())
