"""How long a page takes until something that stands in the middle of its scene can be seen."""

from __future__ import annotations

import io
import time

import numpy as np
from PIL import Image
from playwright.sync_api import Browser, Error

# The middle of a page of 1280 by 800 pixels: floor and sky, and the body of whoever stands there.
_MIDDLE = {"x": 580, "y": 230, "width": 120, "height": 340}
# Floor, sky and grid lines are lighter than this in every colour, of 255; a robot's shaded sides are darker.
_DARK = 150
# What part of the middle a body darkens: TALOS, whose shells are light, 0.4 of it; an empty floor nothing.
_SEEN = 0.1
# When to give up, s.
_PATIENCE = 60.0


def first_picture(browser: Browser, url: str) -> float:
    """Time from asking for a page to the end of the first screenshot with something dark in its middle, s.

    Args:
        browser: it opens a page of its own.
        url: of the page.
    """
    page = browser.new_page(viewport={"width": 1280, "height": 800})
    try:
        start = time.perf_counter()
        page.goto(url, wait_until="commit")
        while (passed := time.perf_counter() - start) < _PATIENCE:
            try:
                data = page.screenshot(clip=_MIDDLE, timeout=1e3 * _PATIENCE)
            except Error:  # Chromium has none to give while it sets up the page
                continue
            if darkened(data) > _SEEN:
                return time.perf_counter() - start
    finally:
        page.close()
    raise AssertionError(f"nothing can be seen after {passed:.0f} s")


def darkened(data: bytes) -> float:
    """The part of an image, as a file's bytes, that is neither floor nor sky."""
    picture = np.array(Image.open(io.BytesIO(data)).convert("RGB"))
    return float(np.mean(picture.min(axis=2) < _DARK))
