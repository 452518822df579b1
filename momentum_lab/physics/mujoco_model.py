"""The robot as a MuJoCo model: same links, limits, rotor inertias and soles, on a floor."""

from __future__ import annotations

import copy
import xml.etree.ElementTree as ET
from collections.abc import Mapping, Sequence
from functools import lru_cache
from types import ModuleType
from typing import Any

import numpy as np
import pinocchio as pin

from momentum_lab.errors import InputError, RobotError
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.urdf import bare_urdf

CONTACTS_PER_FOOT = 4
# A ball this small touches the floor at its lowest point only, which is a corner of the sole, m.
_BALL_RADIUS = 0.005
_FLOOR_BIT, _SOLE_BIT = 1, 2


def load_mujoco() -> ModuleType:
    """The module mujoco, which only those who ask for this engine need.

    Raises:
        InputError: it is not installed.
    """
    try:
        import mujoco
    except ImportError as error:
        install = "pinocchio, or first: pip install 'momentum-lab[mujoco]'"
        raise InputError("engine", "mujoco, which is not installed", install) from error
    return mujoco


def falling_model(robot: RobotModel, timestep: float) -> Any:
    """The same as `mujoco_model` for a robot that may fall: its other bodies touch the floor, too.

    They do so at the lab's own points, `fall_points` of the robot's file. The caller owns the answer.
    """
    return copy.copy(_compiled(robot, timestep))


@lru_cache(maxsize=4)
def _compiled(robot: RobotModel, timestep: float) -> Any:
    """To compile a robot takes as long as half a second of its motion, and sessions begin anew often."""
    return mujoco_model(robot, timestep, robot.spec.fall_points)


def mujoco_model(
    robot: RobotModel, timestep: float, fall_points: Mapping[str, Sequence[Sequence[float]]] | None = None
) -> Any:
    """A compiled `mujoco.MjModel` of a robot on a level floor at height 0.

    The base is free, its velocity in MuJoCo's convention; joints and motors are in the order of
    `robot.joint_names`. The corners of the soles touch the floor (four for each foot, elliptic friction cones),
    rotor inertias are the lab's, joints have no friction or damping, motors
    end at the effort limits and joints at the position limits of the URDF.

    Args:
        robot: the robot.
        timestep: length of a step, s.
        fall_points: points in the frames of further links that touch the floor, too, m.

    Raises:
        InputError: MuJoCo is not installed.
        RobotError: MuJoCo refuses the robot, for example links with impossible inertias.
    """
    mujoco = load_mujoco()
    try:
        spec = mujoco.MjSpec.from_string(_ordered_urdf(robot))
        _set_options(mujoco, spec, timestep)
        base = spec.worldbody.first_body()
        base.add_freejoint()
        _set_joints(mujoco, spec, robot)
        _add_floor(mujoco, spec, robot)
        for sole in robot.soles:
            _add_balls(mujoco, spec, robot, sole.frame, sole.name, sole.corners)
        for link, points in (fall_points or {}).items():
            _add_balls(mujoco, spec, robot, robot.frame(link), link, np.array(points))
        model = spec.compile()
    except ValueError as error:
        raise RobotError(f"urdf of {robot.spec.name}", error, "a robot that MuJoCo accepts") from error
    names = tuple(model.joint(i).name for i in range(1, model.njnt))
    if names != robot.joint_names:
        raise RobotError(f"joints of {robot.spec.name} in MuJoCo", names, ", ".join(robot.joint_names))
    return model


def _ordered_urdf(robot: RobotModel) -> str:
    """The bare URDF with its joints in Pinocchio's order: MuJoCo keeps the order of the file.

    Friction and damping of the joints go, because the lab's own physics does not know them either.
    """
    root = bare_urdf(robot.urdf, robot.spec)
    place = {name: i for i, name in enumerate(robot.joint_names)}
    joints = sorted(root.findall("joint"), key=lambda joint: place.get(joint.get("name", ""), len(place)))
    for joint in joints:
        root.remove(joint)
        for dynamics in joint.findall("dynamics"):
            joint.remove(dynamics)
    root.extend(joints)
    return ET.tostring(root, encoding="unicode")


def _set_options(mujoco: ModuleType, spec: Any, timestep: float) -> None:
    spec.option.timestep = timestep
    spec.option.gravity = (0.0, 0.0, -GRAVITY)
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC


def _set_joints(mujoco: ModuleType, spec: Any, robot: RobotModel) -> None:
    """Rotor inertias and motors, which actuators are by default; MuJoCo takes the effort limits from the URDF."""
    for name, armature in zip(robot.joint_names, robot.model.armature[6:], strict=True):
        spec.joint(name).armature = armature
        spec.add_actuator(name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)


def _add_floor(mujoco: ModuleType, spec: Any, robot: RobotModel) -> None:
    spec.worldbody.add_geom(
        name="floor",
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=(0.0, 0.0, 1.0),
        friction=(robot.spec.friction, 0.0, 0.0),
        contype=_FLOOR_BIT,
        conaffinity=_SOLE_BIT,
    )


def _add_balls(
    mujoco: ModuleType, spec: Any, robot: RobotModel, frame: int, name: str, points: np.ndarray
) -> None:
    """Balls whose lowest points are the points (n, 3), m, of a frame that is level, on the link that carries it."""
    link = _link_of_joint(robot, robot.model.frames[frame].parentJoint)
    for i, point in enumerate(points):
        spec.body(link).add_geom(
            name=f"{name}_{i}",
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            pos=robot.model.frames[frame].placement.act(point + np.array([0.0, 0.0, _BALL_RADIUS])),
            size=(_BALL_RADIUS, 0.0, 0.0),
            friction=(robot.spec.friction, 0.0, 0.0),
            contype=_SOLE_BIT,
            conaffinity=_FLOOR_BIT,
            mass=0.0,
        )


def _link_of_joint(robot: RobotModel, joint: int) -> str:
    """The link whose frame is the frame of a joint."""
    return next(
        frame.name
        for frame in robot.model.frames
        if frame.parentJoint == joint and frame.type == pin.FrameType.BODY and frame.placement.isIdentity()
    )
