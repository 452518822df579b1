"""A robot's meshes with fewer triangles: a machine that draws in software needs time for each."""

from __future__ import annotations

import dataclasses

import numpy as np

from momentum_lab.robot.geometry import LinkMesh


def coarse(meshes: tuple[LinkMesh, ...], cell: float) -> tuple[LinkMesh, ...]:
    """The meshes, each with its vertices in one cube of space drawn together; those smaller than a cube are left out.

    Args:
        meshes: those of a robot.
        cell: side of the cubes, m; 0 leaves everything as it is.
    """
    if cell == 0.0:
        return meshes
    thinned = (_thinned(mesh, cell) for mesh in meshes)
    return tuple(mesh for mesh in thinned if len(mesh.faces))


def _thinned(mesh: LinkMesh, cell: float) -> LinkMesh:
    _, cube = np.unique(np.floor(mesh.vertices / cell), axis=0, return_inverse=True)
    cube = cube.ravel()
    sums = np.column_stack([np.bincount(cube, axis) for axis in mesh.vertices.T])
    faces = cube[mesh.faces]
    a, b, c = faces.T
    whole = (a != b) & (b != c) & (c != a)
    return dataclasses.replace(
        mesh,
        vertices=(sums / np.bincount(cube)[:, None]).astype(np.float32),
        faces=np.unique(faces[whole], axis=0).astype(np.uint32),
    )
