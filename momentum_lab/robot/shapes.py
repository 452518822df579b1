"""The shapes of a URDF as triangles: boxes, cylinders, spheres and the mesh files that it names."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pinocchio as pin
import trimesh

from momentum_lab.errors import RobotError
from momentum_lab.robot.urdf import robot_data_folder

Color = tuple[float, float, float]

_Y_UP = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]], dtype=float)


def shapes_of(element: ET.Element, urdf: Path) -> Iterator[tuple[trimesh.Trimesh, Color | None]]:
    """Triangles of a visual or collision element in its own frame, with the colour that a mesh file gives them.

    Raises:
        RobotError: a mesh file is missing or cannot be read, or the shape has no name that URDF knows.
    """
    shape = element.find("geometry/*")
    if shape is None:
        return
    if shape.tag == "mesh":
        yield from _file_shapes(shape, urdf)
    elif shape.tag == "box":
        yield trimesh.creation.box(numbers(shape.get("size"))), None
    elif shape.tag == "cylinder":
        radius, length = float(shape.get("radius", 0)), float(shape.get("length", 0))
        yield trimesh.creation.cylinder(radius, length, sections=24), None
    elif shape.tag == "sphere":
        yield trimesh.creation.icosphere(3, float(shape.get("radius", 0))), None
    elif shape.tag == "capsule":
        radius, length = float(shape.get("radius", 0)), float(shape.get("length", 0))
        yield trimesh.creation.capsule(length, radius), None
    else:
        raise RobotError(f"shape in {urdf.name}", shape.tag, "mesh, box, cylinder, capsule or sphere")


def _file_shapes(shape: ET.Element, urdf: Path) -> Iterator[tuple[trimesh.Trimesh, Color | None]]:
    path = _mesh_path(shape.get("filename", ""), urdf)
    scale = np.diag([*numbers(shape.get("scale", "1 1 1")), 1.0])
    collada = path.suffix.lower() == ".dae"
    upright = _Y_UP if collada and re.search(rb"<up_axis>\s*Y_UP", path.read_bytes()) else np.eye(4)
    for part in _read_mesh_file(path):
        mesh = trimesh.Trimesh(part.vertices, part.faces)  # joins the vertices that only normals kept apart
        mesh.apply_transform(scale @ upright)
        yield mesh, _material_color(part) if collada else None


def _read_mesh_file(path: Path) -> list[trimesh.Trimesh]:
    try:
        parts = [part for part in trimesh.load_scene(path).dump() if isinstance(part, trimesh.Trimesh)]
    except Exception as error:  # each mesh format raises its own kinds
        raise RobotError("mesh", path, f"a readable mesh file ({error})") from error
    if not parts:
        raise RobotError("mesh", path, "a readable mesh file (this one has no triangles)")
    return parts


def _mesh_path(filename: str, urdf: Path) -> Path:
    """The file that a URDF names.

    A package is looked for above the URDF under its name, then as a folder above the URDF with another name,
    then in the robot-data package.
    """
    scheme, _, rest = filename.rpartition("://")
    if scheme != "package":
        places, where = [urdf.parent / rest], f"{urdf.parent}"
    else:
        inside = rest.partition("/")[2]
        places = [
            *(folder / rest for folder in urdf.parents),
            *(folder / inside for folder in urdf.parents),
            *(folder / rest for folder in robot_data_folder().parents[:2]),
        ]
        where = f"{urdf.parent} or a folder above it"
    for place in places:
        if place.is_file():
            return place
    raise RobotError(f"mesh in {urdf.name}", filename, f"a file that exists in {where}")


def _material_color(mesh: trimesh.Trimesh) -> Color | None:
    material = getattr(mesh.visual, "material", None)
    return None if material is None else rounded_color(material.main_color[:3] / 255.0)


def origin_of(element: ET.Element) -> np.ndarray:
    """Placement of a visual or collision element in its link's frame (4, 4)."""
    origin = element.find("origin")
    if origin is None:
        return np.eye(4)
    rotation = pin.rpy.rpyToMatrix(numbers(origin.get("rpy", "0 0 0")))
    return pin.SE3(rotation, numbers(origin.get("xyz", "0 0 0"))).homogeneous


def numbers(text: str | None) -> np.ndarray:
    """The numbers of an attribute such as xyz."""
    return np.array((text or "").split(), dtype=float)


def rounded_color(rgb: np.ndarray) -> Color:
    """Red, green and blue, 0 to 1, to three digits."""
    red, green, blue = (round(float(channel), 3) for channel in rgb)
    return red, green, blue
