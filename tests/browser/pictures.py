"""Comparing pictures where it matters: small crops around known marks, by a measure that sees what is missing.

The edges of what is drawn differ a little from one graphics library to the next; the mean of a small window does not.
A mark that is not there, or stands somewhere else, changes the mean of the windows that it filled.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image
from scipy.ndimage import uniform_filter

GOLDEN = Path(__file__).parent / "golden"
# Half the side of a crop, px; a CoP is 15 px wide in the picture of a whole robot.
REACH = 16
# The side of the window whose mean is compared, px: about half a CoP.
WINDOW = 7
# Measured around the marks of a whole robot: 0 for the same instant in another session, up to 31 when everything is
# half a pixel aside; 69 and more when a mark is missing (the CoP 104), 138 when the CoP is 12 px aside.
BOUND = 45.0


@dataclass(frozen=True, slots=True)
class Place:
    """Where something is in a picture, px from its upper left corner."""

    x: int
    y: int


def crop(picture: np.ndarray, place: Place, reach: int = REACH) -> np.ndarray:
    """The part of a picture around a place (2 reach, 2 reach, 3).

    Args:
        picture: red, green and blue, 0 to 255 (h, w, 3).
        place: its middle.
        reach: half its side, px.
    """
    height, width = picture.shape[:2]
    inside = reach <= place.x <= width - reach and reach <= place.y <= height - reach
    assert inside, f"{place} is not in the picture of {width} by {height}"
    return picture[place.y - reach : place.y + reach, place.x - reach : place.x + reach]


def difference(one: np.ndarray, other: np.ndarray) -> float:
    """The largest difference of the means of a small window, over places and colours, of 255.

    Args:
        one: a picture (h, w, 3).
        other: a picture of the same size.
    """
    change = one.astype(float) - other.astype(float)
    return float(np.abs(uniform_filter(change, (WINDOW, WINDOW, 1))).max())


def golden(name: str) -> np.ndarray:
    """The picture that is kept under a name (h, w, 3); one that does not exist is an error."""
    path = GOLDEN / f"{name}.png"
    assert path.exists(), f"{path} is missing; only `pytest {path.parent.parent} --update-pictures` makes it"
    return np.array(Image.open(path).convert("RGB"))


def keep(name: str, picture: np.ndarray) -> None:
    """Make a picture the golden one of its name."""
    GOLDEN.mkdir(exist_ok=True)
    Image.fromarray(picture.astype(np.uint8)).save(GOLDEN / f"{name}.png", optimize=True)
