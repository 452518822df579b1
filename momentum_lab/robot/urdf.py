"""Where a robot's URDF lies, what it says as XML, and the Pinocchio model of it."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable
from fnmatch import fnmatchcase
from importlib import metadata
from pathlib import Path

import pinocchio as pin

from momentum_lab.errors import RobotError
from momentum_lab.robot.catalog import LimitSpec, RobotSpec

_DATA = "example-robot-data"
_LEVEL = (0.0, 0.0, 0.0)


def robot_data_folder() -> Path:
    """The folder `robots` of the installed example-robot-data distribution.

    Raises:
        RobotError: the distribution is not installed, or holds no robots.
    """
    try:
        files = metadata.files(_DATA) or []
    except metadata.PackageNotFoundError as error:
        raise RobotError(_DATA, "not installed", f"pip install {_DATA}") from error
    for file in files:
        if _DATA in file.parts and "robots" in file.parts:
            folder = Path(str(file.locate()))
            return next(p for p in folder.parents if p.name == "robots" and p.parent.name == _DATA)
    raise RobotError(_DATA, "an installation without robots", f"pip install {_DATA}")


def urdf_path(spec: RobotSpec) -> Path:
    """The URDF file of a robot, taken from the robot-data package unless its path is absolute.

    Raises:
        RobotError: there is no such file.
    """
    path = Path(spec.urdf)
    path = path if path.is_absolute() else robot_data_folder() / spec.urdf
    if not path.is_file():
        raise RobotError(
            f"urdf of {spec.name}", spec.urdf, "a file in the robot-data package, or an absolute path"
        )
    return path


def read_urdf(path: Path) -> ET.Element:
    """The root element of a URDF file.

    Raises:
        RobotError: the file is no XML, or its root is not a robot with links.
    """
    try:
        root = ET.parse(path).getroot()
    except (ET.ParseError, OSError, ValueError) as error:
        raise RobotError("urdf", path, f"a URDF file in XML ({error})") from error
    if root.tag != "robot" or root.find("link") is None:
        raise RobotError("urdf", path, f"a URDF file whose root is <robot> with links, not <{root.tag}>")
    return root


def bare_urdf(path: Path, spec: RobotSpec) -> ET.Element:
    """A URDF without its meshes, which other libraries would look for, and with what the robot's file adds to it.

    Args:
        path: the URDF file.
        spec: the robot; a foot with a parent gets a link of its own, limits of the file replace the URDF's.

    Raises:
        RobotError: the file is no URDF.
    """
    root = read_urdf(path)
    for link in root.findall("link"):
        for shape in (*link.findall("visual"), *link.findall("collision")):
            link.remove(shape)
    for foot in spec.feet.values():
        if foot.parent is not None:
            add_fixed_link(root, foot.frame, foot.parent, foot.offset, foot.rpy)
    for pattern, limit in spec.limits.items():
        for joint in root.findall("joint"):
            if fnmatchcase(joint.get("name", ""), pattern):
                _replace_limit(joint, limit)
    return root


def _replace_limit(joint: ET.Element, limit: LimitSpec) -> None:
    """Write the limits that are given into a joint of a URDF."""
    element = joint.find("limit")
    if element is None:
        element = ET.SubElement(joint, "limit", velocity="0")
    for name, value in (("lower", limit.lower), ("upper", limit.upper), ("effort", limit.effort)):
        if value is not None:
            element.set(name, repr(value))


def add_fixed_link(
    root: ET.Element, name: str, parent: str, offset: Iterable[float], rpy: Iterable[float] = _LEVEL
) -> None:
    """Add a link without mass to a URDF, at an offset (3,) in another link, m, turned by rpy (3,), rad."""
    ET.SubElement(root, "link", name=name)
    joint = ET.SubElement(root, "joint", name=f"{name}_weld", type="fixed")
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=name)
    ET.SubElement(joint, "origin", xyz=" ".join(map(str, offset)), rpy=" ".join(map(str, rpy)))


def load_model(path: Path) -> pin.Model:
    """The Pinocchio model of a URDF, a free-flyer at its root.

    The XML is parsed beforehand because Pinocchio would write the parser's complaints to stderr.

    Raises:
        RobotError: the file is no URDF, or one of its joints turns without end or in more than one way.
    """
    read_urdf(path)
    try:
        model = pin.buildModelFromUrdf(str(path), pin.JointModelFreeFlyer())
    except (ValueError, RuntimeError) as error:
        raise RobotError("urdf", path, f"a URDF that Pinocchio can read ({error})") from error
    odd = [model.names[j] for j in range(2, model.njoints) if model.nqs[j] != 1 or model.nvs[j] != 1]
    if odd:
        raise RobotError(
            "urdf", path, f"joints with one limited angle or position each, not {', '.join(odd)}"
        )
    return model
