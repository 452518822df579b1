"""The lab's page as a person uses it: keys, sliders, buttons, and what can be read and seen."""

from __future__ import annotations

import io
import re
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image
from playwright.sync_api import Locator, Page, expect

# Drawing in software on a busy machine takes its time, ms.
PATIENCE = 60_000
# Heights of a page, px: half as many pixels are drawn twice as fast, where no picture is looked at.
LOW, TALL = 400, 800
# The canvas between the docked panels and above the bar, whose clock runs, of a page of 1280 by TALL pixels.
CANVAS = {"x": 380, "y": 10, "width": 520, "height": 620}
# A picture that is the same after this is at rest, ms: messages that are processed are drawn in the next frame.
_REST = 300


class LabPage:
    """A page of the lab."""

    def __init__(self, page: Page) -> None:
        self.page = page

    def until_furnished(self) -> LabPage:
        """Wait until the panels and the robot are there, and keys are heard: the time is told after all of them."""
        expect(self.page.get_by_role("button", name="Push (P)")).to_be_visible(timeout=PATIENCE)
        expect(self.page.get_by_text("simulated time")).to_be_visible(timeout=PATIENCE)
        self.dismiss_notices()
        return self

    def dismiss_notices(self) -> None:
        """Close what covers the picture: the browser's warning that it draws in software."""
        close = "document.querySelectorAll('.mantine-Notification-closeButton').forEach(b => b.click())"
        self.page.evaluate(close)
        expect(self.page.locator(".mantine-Notification-root")).to_have_count(0, timeout=PATIENCE)

    @property
    def status(self) -> Locator:
        """The line that says how the robot is doing."""
        return self.page.locator("[data-status]")

    def expect_status(self, words: str) -> None:
        self.status.filter(has_text=re.compile(words)).wait_for(timeout=PATIENCE)

    def expect_text(self, words: str) -> None:
        self.page.get_by_text(re.compile(words)).first.wait_for(timeout=PATIENCE)

    def expect_gone(self, words: str) -> None:
        expect(self.page.get_by_text(words)).to_have_count(0, timeout=PATIENCE)

    def pause(self) -> None:
        """Stop time by its key."""
        self.press("k")
        self.page.locator("[data-time]").filter(has_text="paused").wait_for(timeout=PATIENCE)

    @property
    def time(self) -> float:
        """The simulated time that is told, s, to the millisecond."""
        return float(self.page.locator("[data-time]").get_attribute("data-time") or "nan")

    def until(self, true: Callable[[], bool], what: str) -> None:
        """Wait until something is the case with the page; say what it was if it never is."""
        end = time.monotonic() + PATIENCE / 1000.0
        while not true():
            assert time.monotonic() < end, what
            self.page.wait_for_timeout(50)

    def expect_time(self, seconds: float) -> None:
        self.page.locator(f"[data-time='{seconds:.3f}']").wait_for(timeout=PATIENCE)

    def press(self, *keys: str) -> None:
        for key in keys:
            self.page.keyboard.press(key)

    def open_tab(self, key: str, name: str) -> None:
        """Open a tab by its key; a page that is busy may need a second press."""
        tab = self.page.get_by_role("tab", name=name)
        for _ in range(5):
            self.press(key)
            for _ in range(10):
                if tab.get_attribute("aria-selected") == "true":
                    return
                self.page.wait_for_timeout(200)
        expect(tab).to_have_attribute("aria-selected", "true")

    def click(self, name: str) -> None:
        """Press a button, by script: a page that draws in software is slow to say that it stands still."""
        self.page.get_by_role("button", name=name, exact=True).first.evaluate("b => b.click()")

    def slide(self, label: str, key: str) -> None:
        """Focus the slider of a label and press a key on it."""
        row = self.page.locator("label").filter(has_text=re.compile(f"^{re.escape(label)}$")).first
        uuid = row.get_attribute("for", timeout=PATIENCE)
        slider = self.page.locator(f"[id='{uuid}'] [role=slider]").first
        expect(slider).to_be_visible(timeout=PATIENCE)
        slider.evaluate("s => s.focus()")
        self.press(key)

    def curve(self, plot: int, series: int) -> np.ndarray:
        """The numbers of one curve, as the page draws them."""
        script = """([plot, series]) => {
            const plots = Object.values(window.__viserTestpoints?.uplots ?? {});
            return plots.length > plot ? Array.from(plots[plot].chart.data[series]) : [];
        }"""
        values: list[Any] = self.page.evaluate(script, [plot, series])
        return np.array([value for value in values if value is not None], dtype=float)

    def expect_ticks(self, plot: int) -> None:
        """Wait until the time axis of a plot has been laid out."""
        script = """plot => {
            const chart = Object.values(window.__viserTestpoints?.uplots ?? {})[plot]?.chart;
            return (chart?.axes[0]._values ?? []).filter(v => v !== null && v !== '').length;
        }"""
        self.until(lambda: self.page.evaluate(script, plot) >= 3, "the time axis has no figures")

    def com_travel(self) -> float:
        """How far the CoM has moved along the push, cm."""
        com = self.curve(0, 1)
        return float(np.nanmax(com) - np.nanmin(com)) if com.size else 0.0

    def expect_com_travel(self, least: float) -> None:
        self.until(lambda: self.com_travel() >= least, f"the CoM has not moved {least} cm")

    def expect_points(self, plot: int, series: int, least: int) -> None:
        """Wait until a curve has so many points."""
        self.until(
            lambda: int(np.isfinite(self.curve(plot, series)).sum()) >= least,
            f"curve {series} of plot {plot} has no {least} points",
        )

    def picture(self, clip: dict[str, int] | None = None) -> np.ndarray:
        """The page, or a part of it, once two pictures in a row are the same (h, w, 3)."""
        end, last = time.monotonic() + PATIENCE / 1000.0, b""
        while (data := self.page.screenshot(clip=clip, timeout=PATIENCE)) != last:
            assert time.monotonic() < end, "the picture does not come to rest"
            last = data
            self.page.wait_for_timeout(_REST)
        return np.array(Image.open(io.BytesIO(data)).convert("RGB")).astype(int)

    def picture_with(self, seen: Callable[[np.ndarray], bool], what: str) -> np.ndarray:
        """The canvas, once something is seen in it (h, w, 3); say what it was if it never is."""
        pictures = [self.picture(CANVAS)]

        def look() -> bool:
            pictures.append(self.picture(CANVAS))
            return seen(pictures[-1])

        if not seen(pictures[-1]):
            self.until(look, what)
        return pictures[-1]

    def save(self, path: Path) -> None:
        """Keep a picture of the whole page, for people to look at."""
        self.page.screenshot(path=path, timeout=PATIENCE)


def differing(one: np.ndarray, other: np.ndarray) -> float:
    """The part of two pictures that is not the same."""
    return float((np.abs(one - other).max(axis=2) > 40).mean())
