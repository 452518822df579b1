"""Where a push would take CoM and capture point, as lines in the scene, before anybody pushes."""

from __future__ import annotations

from typing import Any

import numpy as np
import viser

from momentum_lab.app.marks import STYLES
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.wire import Foreseen, rows_of

# So much of the path is drawn, so much is left out, in samples: dashes say that it has not happened.
_DASH, _GAP = 3, 1
_THICKNESS, _RAISED = 0.008, 0.010
# How far above the furthest CoM the words are, in CoM heights: next to it is the name of the CoM itself.
_LABEL_ABOVE = 0.12

PATHS = ("com", "com_ground", "capture")
"""The marks whose paths are drawn."""


class ForesightScene:
    """The paths of one robot in one browser tab.

    Args:
        client: the browser tab.
        robot: the robot.
        foreseen: what its push would do.
        root: name of the node that everything hangs below; empty: the world.

    Attributes:
        words: how it would end.
    """

    def __init__(
        self, client: viser.ClientHandle, robot: LoadedRobot, foreseen: Foreseen, root: str = ""
    ) -> None:
        rows, at = rows_of(foreseen.rows, robot.layout.width), robot.layout.slices
        com, capture = rows[:, at["com"]], rows[:, at["capture_point"]]
        ground = float(rows[0, at["sole_pose"]].reshape(-1, 7)[:, 2].min()) + _RAISED
        below = np.full(len(rows), ground)
        paths = (com, np.column_stack([com[:, :2], below]), np.column_stack([capture, below]))
        self._handles: list[Any] = [
            client.scene.add_line_segments(
                f"{root}/foreseen/{key}", dashes(path), STYLES[key].color, thickness=_THICKNESS
            )
            for key, path in zip(PATHS, paths, strict=True)
        ]
        way = np.linalg.norm(com[:, :2] - com[0, :2], axis=1)
        furthest = com[int(np.nanargmax(way))] + np.array([0.0, 0.0, _LABEL_ABOVE * com[0, 2]])
        self.words = words_of(foreseen, float(np.nanmax(way)))
        self._handles.append(
            client.scene.add_label(
                f"{root}/foreseen/end",
                self.words,
                position=furthest,
                anchor="bottom-left",
                font_screen_scale=1.1,
            )
        )

    def remove(self) -> None:
        """Take the paths away."""
        for handle in self._handles:
            handle.remove()


def dashes(path: np.ndarray) -> np.ndarray:
    """A path through points (n, 3) as dashes (m, 2, 3), without what is no number."""
    pairs = np.stack([path[:-1], path[1:]], axis=1)
    drawn = np.arange(len(pairs)) % (_DASH + _GAP) < _DASH
    return np.asarray(pairs[drawn & np.isfinite(pairs).all(axis=(1, 2))], dtype=np.float32)


def words_of(foreseen: Foreseen, way: float) -> str:
    """How it would end, and how far the CoM would go, m."""
    if foreseen.fall is not None and foreseen.fall.time < foreseen.start:
        return "has fallen already"
    if foreseen.fall is None:
        return f"would stand; the CoM goes {1e3 * way:.0f} mm"
    return f"would fall after {foreseen.fall.time - foreseen.start:.2f} s"
