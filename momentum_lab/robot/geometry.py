"""What the robot looks like: the visual meshes of its URDF, ready to be drawn.

The URDF is read here and not through Pinocchio's geometry model: that one builds a collision tree per
mesh, drops the colours inside Collada files and does not turn those whose up axis is y.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections import defaultdict
from dataclasses import dataclass

import numpy as np
import trimesh

from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.shapes import Color, numbers, origin_of, rounded_color, shapes_of
from momentum_lab.robot.urdf import read_urdf

# The simplifier stops where a collapse would cost more than about 3.3 of its length units: 4.5 mm in these.
_UNITS_PER_METRE = 720.0
_AGGRESSIVENESS = 5
_FEW = 400
_LOOSE = 0.25
_CREASE = np.radians(40.0)
_GREY: Color = (0.7, 0.7, 0.7)
# A robot without meshes: radius of its bones, thickness of its soles, by how much those are drawn larger, m.
_BONE, _PLATE, _RIM = 0.025, 0.02, 0.01


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

    A URDF without visual geometry is drawn as its skeleton.

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
            placement = frame.placement.homogeneous @ origin_of(visual)
            painted = _painted(visual, named_colors)
            for mesh, own_color in shapes_of(visual, robot.urdf):
                mesh.apply_transform(placement)
                parts[frame.parentJoint, own_color or painted].append(mesh)
    parts = parts or _skeleton(robot)
    return tuple(_link_mesh(joint, color, shapes) for (joint, color), shapes in sorted(parts.items()))


def _skeleton(robot: RobotModel) -> dict[tuple[int, Color], list[trimesh.Trimesh]]:
    """Bones from each joint to the joints it carries, and the soles as plates; each in its joint's frame."""
    model = robot.model
    parts: dict[tuple[int, Color], list[trimesh.Trimesh]] = defaultdict(list)
    for joint in range(2, model.njoints):
        end = model.jointPlacements[joint].translation
        parts[int(model.parents[joint]), _GREY].append(_bone(end))
        parts[joint, _GREY].append(trimesh.creation.icosphere(2, 1.1 * _BONE))
    for sole in robot.soles:
        frame = model.frames[sole.frame]
        length, width = sole.upper - sole.lower
        plate = trimesh.creation.box((length + _RIM, width + _RIM, _PLATE))
        plate.apply_translation([*(sole.lower + sole.upper) / 2, _PLATE / 2])
        plate.apply_transform(frame.placement.homogeneous)
        heel_to_joint = _bone(frame.placement.act(np.append((sole.lower + sole.upper) / 2, _PLATE)))
        parts[frame.parentJoint, _GREY] += [plate, heel_to_joint]
    return parts


def _bone(end: np.ndarray) -> trimesh.Trimesh:
    """A rod from the origin to a point (3,), m; a ball where the two are one."""
    if np.linalg.norm(end) < _BONE:
        return trimesh.creation.icosphere(2, _BONE)
    return trimesh.creation.cylinder(_BONE, segment=[np.zeros(3), end], sections=16)


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


def _painted(visual: ET.Element, named: dict[str | None, Color | None]) -> Color:
    material = visual.find("material")
    if material is None:
        return _GREY
    return _rgb(material) or named.get(material.get("name")) or _GREY


def _rgb(material: ET.Element) -> Color | None:
    color = material.find("color")
    return None if color is None else rounded_color(numbers(color.get("rgba"))[:3])
