"""How long a page takes until something that stands in the middle of its scene can be seen."""

from __future__ import annotations

import base64
import io
import time
from typing import Any

import numpy as np
from PIL import Image
from playwright.sync_api import Browser, Page

WIDTH, HEIGHT = 1280, 800
# The middle of a page: floor and sky, and the body of whoever stands there; left, top, right, bottom.
_MIDDLE = (580, 230, 700, 570)
# Floor, sky and grid lines are lighter than this in every colour, of 255; a robot's shaded sides are darker.
_DARK = 150
# What part of the middle a body darkens: TALOS, whose shells are light, 0.4 of it; an empty floor nothing.
_SEEN = 0.1
# When to give up, s, and how often to look, ms.
_PATIENCE, _LOOK = 60.0, 20.0


def first_picture(browser: Browser, url: str) -> float:
    """Time from asking for a page to the first frame on its screen with something dark in its middle, s.

    The frames are those that Chromium has put on the screen, each with its time: a screenshot would have to wait
    until the page has done all else it has to do.

    Args:
        browser: it opens a page of its own.
        url: of the page.
    """
    page = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})
    seen = _watched(page)
    try:
        start = time.time()
        page.goto(url, wait_until="commit")
        while not seen and time.time() - start < _PATIENCE:
            page.wait_for_timeout(_LOOK)
    finally:
        page.close()
    assert seen, f"nothing can be seen after {_PATIENCE:.0f} s"
    return seen[0] - start


def darkened(data: bytes) -> float:
    """The part of the middle of a page, as an image file's bytes of any size, that is neither floor nor sky."""
    image = Image.open(io.BytesIO(data)).convert("RGB")
    scale = image.width / WIDTH
    left, top, right, bottom = (round(scale * edge) for edge in _MIDDLE)
    picture = np.array(image)[top:bottom, left:right]
    return float(np.mean(picture.min(axis=2) < _DARK))


def _watched(page: Page) -> list[float]:
    """When frames with a body in their middle came on a page's screen, s since 1970; the list grows."""
    session, seen = page.context.new_cdp_session(page), []

    def look(frame: dict[str, Any]) -> None:
        session.send("Page.screencastFrameAck", {"sessionId": frame["sessionId"]})
        if darkened(base64.b64decode(frame["data"])) > _SEEN:
            seen.append(frame["metadata"]["timestamp"])

    session.on("Page.screencastFrame", look)
    session.send("Page.startScreencast", {"format": "png", "maxWidth": WIDTH // 2, "maxHeight": HEIGHT // 2})
    return seen
