"""Solids of point marks are closed, small and different."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from momentum_lab.app.marks import STYLES
from momentum_lab.app.shapes import is_solid, solid

SOLIDS = sorted({style.shape for style in STYLES.values() if is_solid(style.shape)})


@pytest.mark.parametrize("shape", SOLIDS)
def test_a_solid_is_closed_and_turned_outside(shape):
    vertices, faces = solid(shape)
    mesh = trimesh.Trimesh(vertices, faces, process=True)  # joins corners that were kept apart for shading
    _, uses = np.unique(mesh.edges_sorted, axis=0, return_counts=True)
    assert (uses % 2 == 0).all()
    assert mesh.volume > 0.0


@pytest.mark.parametrize("shape", SOLIDS)
def test_a_solid_is_about_one_in_radius(shape):
    vertices, _ = solid(shape)
    assert 0.7 < np.abs(vertices[:, :2]).max() < 1.6


def test_solids_differ():
    meshes = [trimesh.Trimesh(*solid(shape)) for shape in SOLIDS]
    looks = {(*np.round(mesh.extents, 1), round(mesh.volume, 1)) for mesh in meshes}
    assert len(looks) == len(SOLIDS)


def test_lines_and_arrows_are_no_solids():
    assert not any(is_solid(shape) for shape in ("arrow", "thin arrow", "line", "bar", "area", "dashes"))
