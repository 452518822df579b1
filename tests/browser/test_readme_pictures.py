"""The README's pictures are screenshots of the lab; `--update-pictures` takes them anew."""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser

from momentum_lab.app.profile import NORMAL
from tests.browser.lab_page import PATIENCE
from tests.browser.readme_scenes import SHOTS, Shot
from tests.browser.readme_shares import check_alike
from tests.browser.scenes import Scene, opened

pytestmark = [
    pytest.mark.browser,
    pytest.mark.timeout(240),
    pytest.mark.filterwarnings("ignore:Queued a:UserWarning"),
]
ROOT = Path(__file__).parents[2]
IMAGES = ROOT / "assets" / "images"
PAGE, CANVAS = (1280, 800), (354, 926)
MOST_BYTES = 250_000
NAMES = [shot.name for shot in SHOTS]


@pytest.fixture(scope="module")
def scene(browser: Browser) -> Iterator[Scene]:
    """The lab as people see it, one page for all pictures."""
    with opened(browser, profile=NORMAL) as scene:
        yield scene


@pytest.mark.parametrize("shot", SHOTS, ids=NAMES)
def test_the_lab_looks_like_its_picture(scene: Scene, shot: Shot, request: pytest.FixtureRequest) -> None:
    shot.reach(scene)
    scene.lab.dismiss_notices()
    if request.config.getoption("--update-pictures"):
        take(scene, shot)
    check_alike(canvas_of(page_picture(scene)), canvas_of(kept(shot), left_edge(shot)))


@pytest.mark.parametrize("shot", SHOTS, ids=NAMES)
def test_a_picture_is_shown_and_small(shot: Shot) -> None:
    assert f"assets/images/{shot.name}.png" in (ROOT / "README.md").read_text()
    assert kept(shot).shape[1::-1] == (right_edge(shot) - left_edge(shot), PAGE[1])
    assert (IMAGES / f"{shot.name}.png").stat().st_size < MOST_BYTES


def test_a_picture_without_its_robot_is_not_alike() -> None:
    """The marks stay; what is grey, robot and shadow, becomes background."""
    canvas = canvas_of(kept(SHOTS[0]), left_edge(SHOTS[0]))
    grey = np.ptp(canvas, axis=2) < 30
    without = np.where(grey[..., None], 255, canvas)
    check_alike(canvas, canvas)
    with pytest.raises(AssertionError, match="a cell is covered"):
        check_alike(without, canvas)


def left_edge(shot: Shot) -> int:
    return 0 if "left" in shot.panels else CANVAS[0]


def right_edge(shot: Shot) -> int:
    return PAGE[0] if "right" in shot.panels else CANVAS[1]


def kept(shot: Shot) -> np.ndarray:
    """The picture of the README (h, w, 3)."""
    return np.array(Image.open(IMAGES / f"{shot.name}.png").convert("RGB")).astype(int)


def canvas_of(picture: np.ndarray, left: int = 0) -> np.ndarray:
    """The part between the panels of a picture (h, w, 3) that begins at a place of the page, px."""
    return picture[:, CANVAS[0] - left : CANVAS[1] - left]


def page_picture(scene: Scene) -> np.ndarray:
    """The page once its canvas has come to rest (h, w, 3)."""
    scene.lab.picture(scene.box)
    return np.array(Image.open(io.BytesIO(scene.lab.page.screenshot(timeout=PATIENCE))).convert("RGB"))


def take(scene: Scene, shot: Shot) -> None:
    """Keep what the page shows, with as many colours as the picture is worth."""
    scene.lab.page.wait_for_timeout(2000)
    picture = Image.fromarray(page_picture(scene)).crop((left_edge(shot), 0, right_edge(shot), PAGE[1]))
    if shot.colours:
        picture = picture.quantize(shot.colours, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    picture.save(IMAGES / f"{shot.name}.png", optimize=True)
