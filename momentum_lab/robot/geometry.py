"""What the robot looks like: the visual meshes of its URDF, ready to be drawn.

The URDF is read here and not through Pinocchio's geometry model: that one builds a collision tree per
mesh, drops the colours inside Collada files and does not turn those whose up axis is y.
"""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pinocchio as pin
import trimesh

from momentum_lab.errors import RobotError
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.urdf import read_urdf

Color = tuple[float, float, float]

# The simplifier stops where a collapse would cost more than about 3.3 of its length units: 4.5 mm in these.
_UNITS_PER_METRE = 720.0
_AGGRESSIVENESS = 5
_FEW = 400
_LOOSE = 0.25
_CREASE = np.radians(40.0)
_GREY: Color = (0.7, 0.7, 0.7)
_Y_UP = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]], dtype=float)


@dataclass(frozen=True, slots=True)
class LinkMesh:
    """Everything of one colour that moves with one joint.

    Attributes:
        joint: index of the joint in the Pinocchio model; 1 is the free-flyer.
        vertices: points in that joint's frame (n, 3), m, float32.
        faces: vertex indices of the triangles (m, 3), uint32.
        color: red, green, blue, 0 to 1.
    """

    joint: int
    vertices: np.ndarray
    faces: np.ndarray
    color: Color


def visual_meshes(robot: RobotModel) -> tuple[LinkMesh, ...]:
    """The robot's visual geometry, one mesh per joint and colour, simplified to about 5 mm.

    A mesh file's own colours win over the URDF's, because a URDF has one colour for the whole file. Vertices
    are shared only across smooth edges, so that smooth shading keeps sharp edges sharp.

    Args:
        robot: the robot to draw; its URDF names the mesh files.

    Returns:
        meshes with their placement baked into the vertices, ordered by joint.

    Raises:
        RobotError: a mesh file is missing or cannot be read.
    """
    root = read_urdf(robot.urdf)
    named_colors = {material.get("name"): _rgb(material) for material in root.findall("material")}
    parts: dict[tuple[int, Color], list[trimesh.Trimesh]] = defaultdict(list)
    for link in root.findall("link"):
        frame = robot.model.frames[robot.frame(link.get("name", ""))]
        for visual in link.findall("visual"):
            placement = frame.placement.homogeneous @ _origin(visual)
            painted = _painted(visual, named_colors)
            for mesh, own_color in _shapes(visual, robot.urdf):
                mesh.apply_transform(placement)
                parts[frame.parentJoint, own_color or painted].append(mesh)
    return tuple(_link_mesh(joint, color, shapes) for (joint, color), shapes in sorted(parts.items()))


def _link_mesh(joint: int, color: Color, shapes: list[trimesh.Trimesh]) -> LinkMesh:
    simple = _simplified(trimesh.util.concatenate(shapes))
    mesh = trimesh.graph.smooth_shade(simple, _CREASE, facet_minarea=None)
    return LinkMesh(joint, np.array(mesh.vertices, np.float32), np.array(mesh.faces, np.uint32), color)


def _simplified(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    """The mesh without the triangles that its shape does not need.

    Small meshes stay as they are, and so do loose panels, which the simplifier eats away from their rims.
    """
    if len(mesh.faces) <= _FEW or np.mean(np.bincount(mesh.edges_unique_inverse) == 1) > _LOOSE:
        return mesh
    scaled = mesh.copy().apply_scale(_UNITS_PER_METRE)
    simple = scaled.simplify_quadric_decimation(face_count=_FEW, aggression=_AGGRESSIVENESS)
    return simple.apply_scale(1.0 / _UNITS_PER_METRE)


def _shapes(visual: ET.Element, urdf: Path) -> Iterator[tuple[trimesh.Trimesh, Color | None]]:
    """Triangles of one visual element in its own frame, with the colour that a mesh file gives them."""
    shape = visual.find("geometry/*")
    if shape is None:
        return
    if shape.tag == "mesh":
        yield from _file_shapes(shape, urdf)
    elif shape.tag == "box":
        yield trimesh.creation.box(_numbers(shape.get("size"))), None
    elif shape.tag == "cylinder":
        radius, length = float(shape.get("radius", 0)), float(shape.get("length", 0))
        yield trimesh.creation.cylinder(radius, length, sections=24), None
    elif shape.tag == "sphere":
        yield trimesh.creation.icosphere(3, float(shape.get("radius", 0))), None
    else:
        raise RobotError(f"shape in {urdf.name}", shape.tag, "mesh, box, cylinder or sphere")


def _file_shapes(shape: ET.Element, urdf: Path) -> Iterator[tuple[trimesh.Trimesh, Color | None]]:
    path = _mesh_path(shape.get("filename", ""), urdf)
    scale = np.diag([*_numbers(shape.get("scale", "1 1 1")), 1.0])
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
    """The file that a URDF names: package folders are looked for above the URDF."""
    scheme, _, rest = filename.rpartition("://")
    folders = [*urdf.parents] if scheme == "package" else [urdf.parent]
    for folder in folders:
        if (folder / rest).is_file():
            return folder / rest
    where = f"{urdf.parent} or a folder above it" if scheme == "package" else f"{urdf.parent}"
    raise RobotError(f"mesh in {urdf.name}", filename, f"a file that exists in {where}")


def _material_color(mesh: trimesh.Trimesh) -> Color | None:
    material = getattr(mesh.visual, "material", None)
    return None if material is None else _color(material.main_color[:3] / 255.0)


def _painted(visual: ET.Element, named: dict[str | None, Color | None]) -> Color:
    material = visual.find("material")
    if material is None:
        return _GREY
    return _rgb(material) or named.get(material.get("name")) or _GREY


def _rgb(material: ET.Element) -> Color | None:
    color = material.find("color")
    return None if color is None else _color(_numbers(color.get("rgba"))[:3])


def _color(rgb: np.ndarray) -> Color:
    red, green, blue = (round(float(channel), 3) for channel in rgb)
    return red, green, blue


def _origin(visual: ET.Element) -> np.ndarray:
    """Placement of a visual in its link's frame (4, 4)."""
    origin = visual.find("origin")
    if origin is None:
        return np.eye(4)
    rotation = pin.rpy.rpyToMatrix(_numbers(origin.get("rpy", "0 0 0")))
    return pin.SE3(rotation, _numbers(origin.get("xyz", "0 0 0"))).homogeneous


def _numbers(text: str | None) -> np.ndarray:
    return np.array((text or "").split(), dtype=float)
