"""Marks in the scene: plain data becomes viser handles, and only what has changed is sent."""

from __future__ import annotations

from collections.abc import Collection
from typing import Protocol

import numpy as np

from momentum_lab.app.label_scene import LabelScene, arrange
from momentum_lab.app.marks import STYLES, MarkStyle, Theme, in_theme
from momentum_lab.app.overlays import Mark
from momentum_lab.app.shapes import is_solid, solid
from momentum_lab.app.viewer import Viewer

# Less than this does not show, m.
_SAME_PLACE = 3e-4
# Sizes for a robot whose CoM is one metre high, m.
_RADIUS = {"ball": 0.036, "ring": 0.026, "disc": 0.014}
_POINT_RADIUS = 0.02
_SHAFT = {"arrow": 0.009, "thin arrow": 0.005}
_THICKNESS = {"line": 0.005, "bar": 0.02, "dashes": 0.004}


class _Drawing(Protocol):
    """The handles of one kind of mark."""

    def move(self, points: np.ndarray) -> None:
        """Go to new points (n, 3)."""

    def show(self, visible: bool) -> None:
        """Appear or disappear."""


class MarkScene:
    """All marks in one browser tab.

    Args:
        client: the browser tab.
        size: height of the robot's CoM, m; marks of small robots are small.
        root: name of the node that everything hangs below; empty: the world.
    """

    def __init__(self, client: Viewer, size: float, root: str = "") -> None:
        self._client, self._root = client, root
        self._size = size
        self._drawings: dict[str, _Drawing] = {}
        self._labels = LabelScene(client, root)
        self._points: dict[str, np.ndarray] = {}
        self._theme: Theme = "light"

    def paint(self, theme: Theme) -> None:
        """Have the colours of a light or a dark page from the next picture on."""
        if theme != self._theme:
            self._theme = theme
            self._clear()

    def draw(self, marks: list[Mark], shown: Collection[str], labelled: Collection[str]) -> None:
        """Show some of the marks.

        Args:
            marks: what exists in the present sample.
            shown: keys of the marks that are switched on.
            labelled: keys of those that may have a label.
        """
        present = {mark.key: mark for mark in marks if mark.key in shown}
        for key, drawing in self._drawings.items():
            drawing.show(key in present)
        for mark in present.values():
            self._draw_one(mark)
        self._labels.draw(arrange([m for m in present.values() if m.key in labelled], self._size))

    def remove(self) -> None:
        """Take all marks out of the scene."""
        self._clear()
        self._labels.remove()

    def _clear(self) -> None:
        for key in self._drawings:
            self._client.scene.remove_by_name(f"{self._root}/marks/{key}")
        self._drawings.clear()
        self._points.clear()

    def _draw_one(self, mark: Mark) -> None:
        points = np.array(mark.points, dtype=np.float32)
        drawn = self._points.get(mark.key)
        if drawn is not None and drawn.shape == points.shape and np.abs(drawn - points).max() < _SAME_PLACE:
            return
        self._points[mark.key] = points
        if mark.key not in self._drawings:
            style = in_theme(STYLES[mark.key], self._theme)
            self._drawings[mark.key] = _drawing(self._client, self._root, style, points, self._size)
        else:
            self._drawings[mark.key].move(points)


def _drawing(client: Viewer, root: str, style: MarkStyle, points: np.ndarray, size: float) -> _Drawing:
    name = f"{root}/marks/{style.key}"
    if is_solid(style.shape):
        return _Solids(client, name, style, points, size)
    if style.shape in _SHAFT:
        return _Arrows(client, name, style, points, size)
    if style.shape == "area":
        return _Area(client, name, style, points)
    return _Lines(client, name, style, points, size)


class _Solids:
    """One small solid per point."""

    def __init__(self, client: Viewer, name: str, style: MarkStyle, points: np.ndarray, size: float) -> None:
        vertices, faces = solid(style.shape)
        radius = size * _RADIUS.get(style.shape, _POINT_RADIUS)
        self._handle = client.scene.add_batched_meshes_simple(
            name,
            vertices * radius,
            faces,
            batched_wxyzs=_upright(len(points)),
            batched_positions=points,
            batched_colors=style.linear,
            lod="off",
            cast_shadow=False,
            receive_shadow=False,
        )

    def move(self, points: np.ndarray) -> None:
        if len(points) != len(self._handle.batched_positions):
            self._handle.batched_wxyzs = _upright(len(points))
        self._handle.batched_positions = points

    def show(self, visible: bool) -> None:
        self._handle.visible = visible


class _Arrows:
    """One arrow per pair of points."""

    def __init__(self, client: Viewer, name: str, style: MarkStyle, points: np.ndarray, size: float) -> None:
        radius = size * _SHAFT[style.shape]
        self._handle = client.scene.add_arrows(
            name,
            _pairs(points),
            style.linear,
            shaft_radius=radius,
            head_radius=2.4 * radius,
            head_length=6.0 * radius,
        )

    def move(self, points: np.ndarray) -> None:
        self._handle.points = _pairs(points)

    def show(self, visible: bool) -> None:
        self._handle.visible = visible


class _Lines:
    """One straight line per pair of points."""

    def __init__(self, client: Viewer, name: str, style: MarkStyle, points: np.ndarray, size: float) -> None:
        self._handle = client.scene.add_line_segments(
            name, _pairs(points), style.color, thickness=size * _THICKNESS[style.shape]
        )

    def move(self, points: np.ndarray) -> None:
        self._handle.points = _pairs(points)

    def show(self, visible: bool) -> None:
        self._handle.visible = visible


class _Area:
    """A filled convex polygon."""

    def __init__(self, client: Viewer, name: str, style: MarkStyle, points: np.ndarray) -> None:
        self._handle = client.scene.add_mesh_simple(
            name,
            points,
            _fan(len(points)),
            color=style.color,
            opacity=0.4,
            side="double",
            cast_shadow=False,
            receive_shadow=False,
        )

    def move(self, points: np.ndarray) -> None:
        if len(points) != len(self._handle.vertices):
            self._handle.faces = _fan(len(points))
        self._handle.vertices = points

    def show(self, visible: bool) -> None:
        self._handle.visible = visible


def _pairs(points: np.ndarray) -> np.ndarray:
    return points.reshape(-1, 2, 3)


def _fan(corners: int) -> np.ndarray:
    return np.array([(0, i, i + 1) for i in range(1, corners - 1)], dtype=np.uint32)


def _upright(count: int) -> np.ndarray:
    return np.tile(np.array([1.0, 0.0, 0.0, 0.0], dtype=np.float32), (count, 1))
