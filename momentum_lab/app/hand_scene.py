"""The arrow of a pull while a hand is pulling, with its force."""

from __future__ import annotations

from typing import Any

import numpy as np
import viser

from momentum_lab.app.marks import STYLES

_NAME = "/hand"
# For a robot whose CoM is one metre high, m.
_SHAFT = 0.011


class HandScene:
    """An arrow and two labels in one browser tab; they are there only while somebody pulls.

    Args:
        client: the browser tab.
    """

    def __init__(self, client: viser.ClientHandle) -> None:
        self._client = client
        self._handles: tuple[Any, Any, Any] | None = None

    def draw(self, start: np.ndarray, along: np.ndarray, text: str, home: str, size: float) -> None:
        """Show an arrow from a point along a vector, both (3,), m, with words at both ends.

        Args:
            start: the grabbed point.
            along: from there to the tip.
            text: the words at the tip.
            home: those where it begins; none: nothing is there.
            size: height of the robot's CoM, m.
        """
        points = np.array([[start, start + along]], dtype=np.float32)
        with self._client.atomic():
            if self._handles is None:
                self._handles = self._add(points, text, size)
            arrow, label, below = self._handles
            arrow.points = points
            arrow.visible = bool(np.linalg.norm(along) > 0.0)
            label.text = text
            label.position = tuple(points[0, 1].tolist())
            below.text, below.visible = home, bool(home)
            below.position = tuple(points[0, 0].tolist())
        self._client.flush()

    def clear(self) -> None:
        """Take the arrow away."""
        if self._handles is not None:
            for handle in self._handles:
                handle.remove()
            self._handles = None
            self._client.flush()

    def _add(self, points: np.ndarray, text: str, size: float) -> tuple[Any, Any, Any]:
        radius = _SHAFT * size
        arrow = self._client.scene.add_arrows(
            f"{_NAME}/arrow",
            points,
            STYLES["push"].linear,
            shaft_radius=radius,
            head_radius=2.4 * radius,
            head_length=6.0 * radius,
        )
        label = self._client.scene.add_label(
            f"{_NAME}/label",
            text,
            position=tuple(points[0, 1].tolist()),
            anchor="bottom-left",
            font_screen_scale=1.1,
        )
        below = self._client.scene.add_label(
            f"{_NAME}/home", "", position=tuple(points[0, 0].tolist()), anchor="top-center", visible=False
        )
        return arrow, label, below
