"""A recording is opened like any file, with no network and no lab, and plays."""

from __future__ import annotations

import io
import time
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, Page, expect

from momentum_lab.cli import main
from tests.browser.conftest import OUTPUT
from tests.browser.lab_page import PATIENCE

pytestmark = [pytest.mark.browser, pytest.mark.timeout(240)]

# The push begins at 0.5 s; a second later the robot still bows as far as it can.
WORDS = "record stand --robot g1 --push 150 --push-direction 180 --seconds 3"
TOAST, BAR = 140, 60
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
    """The picture at 0.2 s, and one after 1.2 s to which it has played."""
    clock = page.locator("input").first
    expect(clock).to_be_visible(timeout=PATIENCE)
    clock.fill("0.2")
    clock.press("Enter")  # stands still there
    early = seen(page, "recording-early.png")
    clock.blur()
    page.keyboard.press("Space")
    page.wait_for_function("Number(document.querySelector('input').value) > 1.2", timeout=PATIENCE)
    page.keyboard.press("Space")
    return early, seen(page, "recording-late.png")


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
