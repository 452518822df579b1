"""A robot as PlaCo knows it, with the inertias and limits of ours and a frame in the middle of each sole."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np
import placo

from momentum_lab.robot.model import RobotModel, Sole
from momentum_lab.robot.state import State
from momentum_lab.robot.urdf import add_fixed_link, bare_urdf

# The same names are given to no link of any robot.
_MIDDLE = "{}_sole_middle"


def middle_frame(sole: Sole) -> str:
    """Name of the frame in the middle of a sole's rectangle, with the axes of the sole."""
    return _MIDDLE.format(sole.name)


def middle_of(sole: Sole) -> np.ndarray:
    """The middle of a sole's rectangle in the sole frame (3,), m."""
    return np.append((sole.lower + sole.upper) / 2.0, 0.0)


def placo_body(robot: RobotModel) -> placo.RobotWrapper:
    """The robot in PlaCo; joints, masses, rotor inertias, limits and the order of q and v are those of `robot`."""
    root = bare_urdf(robot.urdf, robot.spec)
    for sole in robot.soles:
        add_fixed_link(root, middle_frame(sole), robot.spec.feet[sole.name].frame, middle_of(sole).tolist())
    urdf = ET.tostring(root, encoding="unicode")
    body = placo.RobotWrapper(str(robot.urdf), placo.Flags.ignore_collisions, urdf)
    body.model.armature = robot.model.armature
    return body


def follow(body: placo.RobotWrapper, state: State) -> None:
    """Put PlaCo's robot into a state."""
    body.state.q, body.state.qd = state.q, state.v
    body.update_kinematics()
