"""How a robot's body looks on a light or a dark page: dark parts must not vanish before a dark floor."""

from __future__ import annotations

from momentum_lab.app.marks import Theme
from momentum_lab.palette import Color

# Of a body that marks show through; on a dark page less light comes through it from behind.
_SEE_THROUGH: dict[Theme, float] = {"light": 0.3, "dark": 0.45}
# On a dark page no part is darker than this, of 255.
_DARKEST = 150


def opacity_in(theme: Theme) -> float:
    """Opacity of a body that the marks inside it show through."""
    return _SEE_THROUGH[theme]


def tinted(color: tuple[float, float, float], theme: Theme) -> Color:
    """Colour of a part of the body, 0 to 255: on a dark page brighter, in the same order.

    Args:
        color: its own, red, green, blue, 0 to 1.
        theme: whether the page is light or dark.
    """
    least = _DARKEST if theme == "dark" else 0
    red, green, blue = (round(least + (255 - least) * channel) for channel in color)
    return red, green, blue
