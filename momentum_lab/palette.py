"""One palette for screen, plots and pictures: which colour each quantity has, wherever it is drawn.

The colours are those of Okabe and Ito, which people with any kind of colour vision can tell apart.
"""

from __future__ import annotations

Color = tuple[int, int, int]
"""Red, green, blue, 0 to 255."""

BLACK: Color = (0, 0, 0)
WHITE: Color = (255, 255, 255)
ORANGE: Color = (230, 159, 0)
SKY: Color = (86, 180, 233)
GREEN: Color = (0, 158, 115)
YELLOW: Color = (240, 228, 66)
BLUE: Color = (0, 114, 178)
VERMILLION: Color = (213, 94, 0)
PURPLE: Color = (204, 121, 167)
GREY: Color = (110, 110, 110)

COM, COP, CMP, CAPTURE = ORANGE, BLUE, VERMILLION, PURPLE
# A CoP, desired or granted, that is not measured; and the force of the ground.
COP_WANTED, GRF = SKY, GREEN
# What is asked for, what the ground may give, what it gave: the last like the force that gives it.
DESIRED, ADMISSIBLE, MEASURED = GREY, BLUE, GRF
LINEAR, ANGULAR = ORANGE, PURPLE
"""Both momenta."""


def css(color: Color) -> str:
    """A colour as #rrggbb."""
    return "#" + "".join(f"{channel:02x}" for channel in color)
