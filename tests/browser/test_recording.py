"""A recording is opened like any file, with no network and no lab, and plays."""

from __future__ import annotations

import io
import time
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, Locator, Page, expect

from momentum_lab.cli import main
from tests.browser.conftest import OUTPUT
from tests.browser.lab_page import PATIENCE

pytestmark = [pytest.mark.browser, pytest.mark.timeout(240)]

# The push begins at 0.5 s; at LATE the robot bows as far as it can.
WORDS = "record stand --robot g1 --push 150 --push-direction 180 --seconds 3"
EARLY, LATE = "0.2", "1.2"
TOAST, BAR = 140, 60
# What the player's button shows while it plays, and while it does not.
PAUSE, PLAY = "svg.tabler-icon-player-pause-filled", "svg.tabler-icon-player-play-filled"
# Of a picture without a robot this much is darker than 215: lines of the floor and labels; measured 0.008.
FLOOR = 0.02


def test_a_recording_plays_from_a_file_without_a_network(browser: Browser, tmp_path: Path) -> None:
    path = tmp_path / "bows.html"
    assert main([*WORDS.split(), "--out", str(path)]) == 0
    context = browser.new_context(viewport={"width": 720, "height": 540}, offline=True)
    asked, errors = [], []
    try:
        page = context.new_page()
        page.on("request", lambda request: asked.append(request.url))
        page.on("console", lambda message: errors.append(message.text) if message.type == "error" else None)
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.goto(path.as_uri())
        assert page.title() == "stand · g1 · computed-torque · priority 0"
        early, late = first_and_later(page)
    finally:
        context.close()
    for shot in (early, late):
        assert has_robot(shot)
        assert (shot[..., 1] - shot[..., 0] > 60).sum() > 300  # the green arrow of the ground reaction force
    assert (np.abs(late - early).max(axis=2) > 60).mean() > FLOOR
    assert {url.partition(":")[0] for url in asked} <= {"file", "data", "blob"}
    assert [url for url in asked if url.startswith("file:")] == [path.as_uri()]
    assert errors == []


def first_and_later(page: Page) -> tuple[np.ndarray, np.ndarray]:
    """The pictures before the push and after it; on the way from one to the other it has played by itself."""
    clock = page.locator("input").first
    expect(clock).to_be_visible(timeout=PATIENCE)
    stand_still(clock, EARLY)
    early = seen(page, "recording-early.png")
    clock.blur()
    page.keyboard.press("Space")
    expect(page.locator(PAUSE)).to_be_visible(timeout=PATIENCE)
    page.wait_for_function(f"Number(document.querySelector('input').value) > {LATE}", timeout=PATIENCE)
    stand_still(clock, LATE)
    return early, seen(page, "recording-late.png")


def stand_still(clock: Locator, instant: str) -> None:
    """Pause what plays, and go to an instant; a number that the clock shows already would pause nothing."""
    clock.page.locator(PAUSE).click(timeout=PATIENCE)
    expect(clock.page.locator(PLAY)).to_be_visible(timeout=PATIENCE)
    clock.fill(instant)
    expect(clock).to_have_value(instant, timeout=PATIENCE)


def seen(page: Page, name: str) -> np.ndarray:
    """What is between the notice about slow graphics and the player's bar, once a robot rests there (h, w, 3)."""
    end, last = time.monotonic() + PATIENCE / 1000.0, np.empty(0)
    while not (np.array_equal(shot := screen(page, name), last) and has_robot(shot)):
        assert time.monotonic() < end, "no robot that stands still"
        last = shot
        page.wait_for_timeout(500)
    return shot


def screen(page: Page, name: str) -> np.ndarray:
    data = page.screenshot(path=OUTPUT / name, timeout=PATIENCE)
    return np.array(Image.open(io.BytesIO(data)).convert("RGB"), dtype=float)[TOAST:-BAR]


def has_robot(shot: np.ndarray) -> bool:
    return bool((shot.mean(axis=2) < 215).mean() > 2 * FLOOR)
