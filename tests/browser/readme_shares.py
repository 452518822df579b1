"""Whether a picture still shows the lab as it is: how much of each cell is covered, within wide bounds."""

from __future__ import annotations

import numpy as np

# Cells of a canvas, down and across: a robot fills some, and leaves others empty.
CELLS = (6, 4)
# The least that a pixel of the robot or of a mark is darker than the white page, of 255.
DARK = 40
# The least that the colours of a mark's pixel are apart, of 255; the robot and its shadow are grey.
COLOURED = 60
# Shares of a cell, of one. Two sessions differed by at most 0.04; without the robot it is 0.53.
BOUND = 0.2
# The share of coloured pixels may be this many times more or less: two sessions differed by 1.07, for the kept
# pictures have 256 colours.
TIMES = 1.5


def covered(canvas: np.ndarray) -> np.ndarray:
    """The share of what is not background in each cell (rows, columns).

    Args:
        canvas: red, green and blue, 0 to 255 (h, w, 3).
    """
    rows, columns = CELLS
    drawn = (canvas.min(axis=2) < 255 - DARK).astype(float)
    height, width = (size // cells for size, cells in zip(drawn.shape, CELLS, strict=True))
    cells = drawn[: height * rows, : width * columns].reshape(rows, height, columns, width)
    return cells.mean(axis=(1, 3))


def coloured(canvas: np.ndarray) -> float:
    """The share of a canvas (h, w, 3) that has a mark's colour."""
    return float((np.ptp(canvas.astype(int), axis=2) > COLOURED).mean())


def check_alike(now: np.ndarray, kept: np.ndarray) -> None:
    """Fail if two canvases (h, w, 3) do not show the same things at about the same places."""
    assert now.shape == kept.shape
    apart = np.abs(covered(now) - covered(kept)).max()
    assert apart < BOUND, f"a cell is covered {apart:.2f} more or less"
    ratio = coloured(now) / coloured(kept)
    assert 1.0 / TIMES < ratio < TIMES, f"{ratio:.2f} times the coloured pixels"
