"""Fewer triangles, in the same places."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from scipy.spatial import cKDTree

from momentum_lab.app.coarse import coarse
from momentum_lab.robot.geometry import LinkMesh

CELL = 0.04


def mesh_of(shape: trimesh.Trimesh) -> LinkMesh:
    return LinkMesh(
        3, np.array(shape.vertices, np.float32), np.array(shape.faces, np.uint32), (0.1, 0.2, 0.3)
    )


@pytest.fixture
def ball() -> LinkMesh:
    return mesh_of(trimesh.creation.icosphere(4, 0.2))


def test_no_cell_no_change(ball):
    (same,) = coarse((ball,), 0.0)
    assert same is ball


def test_a_ball_keeps_its_size_with_few_of_its_triangles(ball):
    (thin,) = coarse((ball,), CELL)
    assert (thin.joint, thin.color) == (ball.joint, ball.color)
    assert (thin.vertices.dtype, thin.faces.dtype) == (np.float32, np.uint32)
    assert len(thin.faces) < 0.3 * len(ball.faces)
    radius = np.linalg.norm(thin.vertices, axis=1)
    assert np.abs(radius - 0.2).max() < 0.5 * CELL
    volume = trimesh.Trimesh(thin.vertices, thin.faces, process=False).volume
    assert volume == pytest.approx(4.0 / 3.0 * np.pi * 0.2**3, rel=0.2)  # its faces still look outwards


def test_no_vertex_leaves_its_cube(ball):
    (thin,) = coarse((ball,), CELL)
    distance, _ = cKDTree(ball.vertices).query(thin.vertices)
    assert distance.max() <= np.sqrt(3.0) * CELL


def test_every_triangle_has_three_corners(ball):
    (thin,) = coarse((ball,), CELL)
    assert all(len(set(face)) == 3 for face in thin.faces.tolist())
    assert thin.faces.max() < len(thin.vertices)


def test_what_is_smaller_than_a_cube_is_left_out(ball):
    screw = mesh_of(trimesh.creation.icosphere(2, 0.005).apply_translation([0.02, 0.02, 0.02]))
    assert len(coarse((screw, ball), CELL)) == 1
