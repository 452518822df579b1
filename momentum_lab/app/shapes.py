"""The solid shapes of point marks: small, upright, and different from every side."""

from __future__ import annotations

from functools import cache

import numpy as np
import trimesh

from momentum_lab.app.marks import Shape

_QUARTER = np.pi / 2.0


@cache
def solid(shape: Shape) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) and faces (m, 3) of a shape of about unit radius, its foot point at the origin.

    Args:
        shape: one of the shapes of single points.

    Raises:
        KeyError: the shape is drawn as lines or arrows.
    """
    mesh = _BUILDERS[shape]()
    vertices = np.ascontiguousarray(mesh.vertices, dtype=np.float32)
    return vertices, np.ascontiguousarray(mesh.faces, dtype=np.uint32)


def is_solid(shape: Shape) -> bool:
    """Whether a shape stands for single points."""
    return shape in _BUILDERS


def _ball() -> trimesh.Trimesh:
    return trimesh.creation.icosphere(3, 1.0)


def _ring() -> trimesh.Trimesh:
    return trimesh.creation.torus(1.0, 0.22, major_sections=32, minor_sections=12)


def _disc() -> trimesh.Trimesh:
    return trimesh.creation.cylinder(0.8, 0.3, sections=32)


def _diamond() -> trimesh.Trimesh:
    """Two pyramids, base to base."""
    corners = np.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [0, 0, 1.3], [0, 0, -1.3]], dtype=float)
    faces = [face for i in range(4) for face in ((i, (i + 1) % 4, 4), ((i + 1) % 4, i, 5))]
    return _faceted(trimesh.Trimesh(corners, faces, process=False))


def _triangle() -> trimesh.Trimesh:
    """A pyramid on three corners that points upwards."""
    angles = 2.0 * np.pi / 3.0 * np.arange(3) + _QUARTER
    base = 1.1 * np.column_stack([np.cos(angles), np.sin(angles), np.zeros(3)])
    corners = np.vstack([base, [0.0, 0.0, 2.2]])
    return _faceted(trimesh.Trimesh(corners, [(0, 1, 3), (1, 2, 3), (2, 0, 3), (0, 2, 1)], process=False))


def _cross() -> trimesh.Trimesh:
    """Three crossing bars."""
    long, thin = 2.4, 0.55
    return trimesh.util.concatenate(
        [trimesh.creation.box([long if i == axis else thin for i in range(3)]) for axis in range(3)]
    )


def _square() -> trimesh.Trimesh:
    return trimesh.creation.box([1.6, 1.6, 0.5])


def _hollow_square() -> trimesh.Trimesh:
    """A frame of four bars."""
    side, thin = 2.2, 0.35
    offset = 0.5 * (side - thin)
    bars = []
    for sign in (-1.0, 1.0):
        for size, at in (
            ((side, thin, 0.5), (0.0, sign * offset)),
            ((thin, side, 0.5), (sign * offset, 0.0)),
        ):
            bar = trimesh.creation.box(size)
            bar.apply_translation((*at, 0.0))
            bars.append(bar)
    return trimesh.util.concatenate(bars)


def _faceted(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    """The mesh with corners of its own for every face, so that its edges stay sharp."""
    faces = np.arange(3 * len(mesh.faces)).reshape(-1, 3)
    return trimesh.Trimesh(mesh.vertices[mesh.faces].reshape(-1, 3), faces, process=False)


_BUILDERS = {
    "ball": _ball,
    "ring": _ring,
    "disc": _disc,
    "diamond": _diamond,
    "triangle": _triangle,
    "cross": _cross,
    "square": _square,
    "hollow square": _hollow_square,
}
