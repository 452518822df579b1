"""Points on the surface of a robot, joint by joint, from the shapes of its URDF."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np
import pinocchio as pin
from scipy.spatial import ConvexHull, QhullError

from momentum_lab.errors import RobotError
from momentum_lab.robot.shapes import origin_of, shapes_of

Kind = Literal["collision", "visual"]


@dataclass(frozen=True, slots=True)
class Solids:
    """What the robot's surface is made of.

    Attributes:
        points: kind of shape -> joint -> corners of the convex hull of each of its shapes, joint axes (n, 3), m.
        unreadable: what was said about each mesh that could not be read.
        oversized: links whose collision shape is larger than a body can be, with its size, m.
    """

    points: dict[Kind, dict[int, np.ndarray]]
    unreadable: list[str] = field(default_factory=list)
    oversized: dict[str, float] = field(default_factory=dict)

    def of(self, joint: int, *kinds: Kind) -> np.ndarray:
        """Points of a joint (n, 3) from the first of the kinds that it has; none (0, 3) if it has none."""
        for kind in kinds:
            if joint in self.points[kind]:
                return self.points[kind][joint]
        return np.zeros((0, 3))

    def kind_of(self, joint: int, *kinds: Kind) -> Kind | None:
        """The first of the kinds of shape that a joint has."""
        return next((kind for kind in kinds if joint in self.points[kind]), None)


def read_solids(root: ET.Element, urdf: Path, model: pin.Model, largest: float) -> Solids:
    """The shapes of a URDF.

    Args:
        root: the URDF.
        urdf: its file, above which meshes are looked for.
        model: the Pinocchio model of it.
        largest: a shape of more than this across is left out, m.
    """
    solids = Solids({"collision": {}, "visual": {}})
    kinds: tuple[Kind, ...] = ("collision", "visual")
    for link in root.findall("link"):
        name = link.get("name", "")
        if not model.existFrame(name):
            continue
        frame = model.frames[model.getFrameId(name)]
        for kind in kinds:
            for element in link.findall(kind):
                placement = frame.placement.homogeneous @ origin_of(element)
                points = _points(element, urdf, solids.unreadable) @ placement[:3, :3].T + placement[:3, 3]
                size = float(np.linalg.norm(np.ptp(points, axis=0))) if points.size else 0.0
                if size > largest:
                    solids.oversized[name] = size
                elif points.size:
                    known = solids.points[kind].get(frame.parentJoint, np.zeros((0, 3)))
                    solids.points[kind][frame.parentJoint] = np.vstack([known, points])
    return solids


def corners_of(points: np.ndarray) -> np.ndarray:
    """Those of the points (n, 3) that are corners of their convex hull; all of them where they are flat."""
    try:
        return points[np.sort(ConvexHull(points).vertices)]
    except (QhullError, ValueError):
        return points


def _points(element: ET.Element, urdf: Path, unreadable: list[str]) -> np.ndarray:
    """Corners of the hulls of one element's shapes in its own frame (n, 3), m."""
    found = [np.zeros((0, 3))]
    try:
        found += [corners_of(np.array(mesh.vertices)) for mesh, _ in shapes_of(element, urdf)]
    except (RobotError, ValueError) as error:
        text = f"{error.given}" if isinstance(error, RobotError) else f"{error}"
        if text not in unreadable:
            unreadable.append(text)
    return np.vstack(found)
