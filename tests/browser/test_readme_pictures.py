"""The README's pictures are screenshots of the lab; `--update-pictures` takes them anew."""

from __future__ import annotations

import io
from pathlib import Path

import pytest
from PIL import Image
from playwright.sync_api import Browser

from momentum_lab.app.profile import NORMAL
from tests.browser.lab_page import PATIENCE
from tests.browser.scenes import Scene, opened

pytestmark = [
    pytest.mark.browser,
    pytest.mark.timeout(240),
    pytest.mark.filterwarnings("ignore:Queued a:UserWarning"),
]
ROOT = Path(__file__).parents[2]
PICTURES = {"push": (1280, 800), "feet": (1280, 800)}
MOST_BYTES = 200_000


def test_pictures_are_taken_only_when_asked_for(request: pytest.FixtureRequest, browser: Browser) -> None:
    if not request.config.getoption("--update-pictures"):
        pytest.skip("--update-pictures takes the README's pictures")
    with opened(browser, profile=NORMAL) as scene:
        scene.push()
        scene.view("Whole robot")
        scene.lab.open_tab("1", "Push")
        take(scene, "push")
        scene.view("Feet")
        take(scene, "feet")


@pytest.mark.parametrize("name", PICTURES)
def test_a_picture_is_shown_and_small(name: str) -> None:
    file = ROOT / "assets" / "images" / f"{name}.png"
    assert f"(assets/images/{name}.png)" in (ROOT / "README.md").read_text()
    with Image.open(file) as picture:
        assert picture.size == PICTURES[name]
    assert file.stat().st_size < MOST_BYTES


def take(scene: Scene, name: str) -> None:
    """Keep what the page shows, with 256 colours."""
    scene.lab.page.wait_for_timeout(3000)
    picture = Image.open(io.BytesIO(scene.lab.page.screenshot(timeout=PATIENCE))).convert("RGB")
    few = picture.quantize(256, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    few.save(ROOT / "assets" / "images" / f"{name}.png", optimize=True)
