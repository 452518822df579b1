"""The marks are drawn where they are: local comparisons with golden crops, which a missing mark must fail."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator

import numpy as np
import pytest
from playwright.sync_api import Browser
from scipy.ndimage import shift

from momentum_lab.app import stage
from momentum_lab.app.overlays import Mark, overlays
from tests.browser import pictures
from tests.browser.pictures import BOUND, Place, crop, difference, golden, keep
from tests.browser.scenes import Scene, opened

pytestmark = [
    pytest.mark.browser,
    pytest.mark.timeout(240),
    pytest.mark.filterwarnings("ignore:Queued a:UserWarning"),
]
MARKS = ("com", "com_ground", "cop", "foot_cop", "cmp", "capture", "grf")
ASIDE = 12.0


@pytest.fixture(scope="module")
def scene(browser: Browser) -> Iterator[Scene]:
    """A robot a moment after a push, its marks without words."""
    with opened(browser) as scene:
        scene.push()
        scene.view("Whole robot")
        scene.lab.page.get_by_text("Each mark").evaluate("folder => folder.click()")
        scene.switch("labels")
        for name in ("CoP of a foot", "capture point"):
            scene.switch(name)
        yield scene


def crops(scene: Scene) -> dict[str, np.ndarray]:
    """What is around each mark now, wherever it should be."""
    picture, marks = scene.picture(), scene.marks
    return {key: crop(picture, scene.place(marks[key].points[0])) for key in MARKS}


def differences(found: dict[str, np.ndarray]) -> dict[str, float]:
    return {key: difference(part, golden(f"push-{key}")) for key, part in found.items()}


def test_every_mark_is_where_it_is_in_the_golden_pictures(
    scene: Scene, request: pytest.FixtureRequest
) -> None:
    found = crops(scene)
    if request.config.getoption("--update-pictures"):
        for key, part in found.items():
            keep(f"push-{key}", part)
    apart = differences(found)
    assert max(apart.values()) < BOUND, apart


def test_the_same_instant_again_is_the_same_picture(scene: Scene) -> None:
    scene.push()
    apart = differences(crops(scene))
    assert max(apart.values()) < BOUND, apart


def test_a_missing_cop_is_seen(scene: Scene) -> None:
    scene.switch("CoP")
    missing = differences(crops(scene))["cop"]
    scene.switch("CoP")
    print(f"missing CoP: {missing:.0f}, bound {BOUND:.0f}")
    assert missing > 1.5 * BOUND


def test_a_cop_12_px_aside_is_seen(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    point = np.array(scene.marks["cop"].points[0])
    here, there = scene.place(tuple(point)), scene.place(tuple(point - (0.0, 0.1, 0.0)))
    way = 0.1 * ASIDE / np.hypot(there.x - here.x, there.y - here.y)

    def aside(*arguments) -> list[Mark]:
        moved = tuple((point - (0.0, way, 0.0)).tolist())
        return [
            dataclasses.replace(mark, points=(moved,)) if mark.key == "cop" else mark
            for mark in overlays(*arguments)
        ]

    with monkeypatch.context() as patch:
        patch.setattr(stage, "overlays", aside)
        scene.switch("CMP")  # asks for a new picture
        scene.switch("CMP")
        apart = differences(crops(scene))["cop"]
    scene.switch("CMP")
    scene.switch("CMP")
    print(f"CoP {ASIDE:.0f} px aside: {apart:.0f}, bound {BOUND:.0f}")
    assert apart > 1.5 * BOUND


@pytest.mark.parametrize("key", MARKS)
def test_edges_half_a_pixel_aside_are_no_difference(key: str) -> None:
    """As another graphics library may draw them."""
    part = golden(f"push-{key}")
    assert difference(shift(part.astype(float), (0.5, 0.5, 0.0), order=1, mode="nearest"), part) < BOUND


def test_a_golden_picture_that_is_missing_is_an_error(tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pictures, "GOLDEN", tmp_path)
    with pytest.raises(AssertionError, match="--update-pictures"):
        golden("push-cop")
    assert list(tmp_path.iterdir()) == []


def test_a_crop_beyond_the_picture_is_an_error() -> None:
    with pytest.raises(AssertionError, match="not in the picture"):
        crop(np.zeros((100, 100, 3)), Place(5, 50))
