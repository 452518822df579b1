"""A body can be told from the floor on a light and on a dark page."""

from __future__ import annotations

import pytest

from momentum_lab.app.body_look import opacity_in, tinted
from momentum_lab.app.world import FLOORS

# The darkest parts of the robots that ship are black.
BLACK_PART, WHITE_PART = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)


def luminance(color: tuple[float, float, float]) -> float:
    """Relative luminance of an sRGB colour, 0 to 255, as WCAG 2 defines it."""
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in (v / 255 for v in color)]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: tuple[float, float, float], other: tuple[float, float, float]) -> float:
    bright, dark = sorted((luminance(one), luminance(other)), reverse=True)
    return (bright + 0.05) / (dark + 0.05)


def test_luminance_has_its_published_ends():
    assert contrast((0, 0, 0), (255, 255, 255)) == pytest.approx(21.0)


def test_a_black_part_shows_through_before_the_dark_floor():
    """Before shading: half a lifted part, half the floor behind it."""
    floor, opacity = FLOORS["dark"][0], opacity_in("dark")
    part = tinted(BLACK_PART, "dark")
    seen = tuple(opacity * body + (1.0 - opacity) * ground for body, ground in zip(part, floor, strict=True))
    assert contrast(seen, floor) > 1.5


def test_colours_on_a_light_page_are_the_robots_own():
    assert tinted((0.2, 0.4, 1.0), "light") == (51, 102, 255)


def test_bright_stays_brighter_than_dark_and_white_stays_white():
    grey = tinted((0.5, 0.5, 0.5), "dark")
    assert tinted(BLACK_PART, "dark") < grey < tinted(WHITE_PART, "dark") == (255, 255, 255)
