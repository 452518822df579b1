"""A robot's file proposed from its URDF and the names of its two sole frames."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import msgspec
import numpy as np
import pinocchio as pin

from momentum_lab.robot.catalog import HomeSpec, RobotSpec
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.posture import standing_posture
from momentum_lab.robot.proposal.body import FEET, Body, find_body
from momentum_lab.robot.proposal.fall_points import find_fall_points
from momentum_lab.robot.proposal.home import Home, find_home, foot_distance
from momentum_lab.robot.proposal.limits import missing_limits
from momentum_lab.robot.proposal.remarks import (
    Remark,
    masses_of,
    remarks_on_body,
    remarks_on_inertia,
    remarks_on_posture,
    remarks_on_soles,
    remarks_on_solids,
    remarks_on_urdf,
)
from momentum_lab.robot.proposal.sole_fit import Sole, fit_sole
from momentum_lab.robot.proposal.solids import read_solids
from momentum_lab.robot.proposal.srdf import Semantics, read_semantics
from momentum_lab.robot.state import State
from momentum_lab.robot.urdf import load_model, read_urdf, robot_data_folder

_FRICTION = 0.7
# A rotor behind its gear is guessed as this part of what it moves, within what motors of humanoids have, kg m^2.
_ROTOR, _SMALLEST, _LARGEST = 0.1, 0.001, 0.2
_LIMITS_SOURCE = {
    "limits": "estimate where the URDF gives none: motors of a leg hold 0.3 m g l, others a tenth of it"
}
# Holding still should take no more than this part of a motor's torque.
_EASY = 0.8
# No shape of a link is larger than this many leg lengths.
_LARGEST_SHAPE = 2.0


@dataclass(frozen=True, slots=True)
class Proposal:
    """A robot's file, and what to look at in it.

    Attributes:
        spec: the file's content.
        remarks: what is missing, doubtful or guessed.
        fault: why the robot cannot stand, in words; empty if a posture was found.
    """

    spec: RobotSpec
    remarks: tuple[Remark, ...]
    fault: str


def propose(urdf: Path, soles: Sequence[str]) -> Proposal:
    """A robot's file from its URDF.

    Soles, pelvis, trunk, legs, bodies to push and fall points come from the kinematic tree and the shapes, the
    standing posture from inverse kinematics, the arms from an SRDF beside the URDF. Friction and rotor inertias
    are estimates.

    Args:
        urdf: the URDF file.
        soles: names of the left and the right sole frame, or of the links of the feet.

    Raises:
        RobotError: the file is no URDF of a humanoid, or a frame is unknown or belongs to no leg.
    """
    root = read_urdf(urdf)
    body = find_body(load_model(urdf), masses_of(root), soles)
    semantics = read_semantics(urdf)
    solids = read_solids(root, urdf, body.model, _LARGEST_SHAPE * body.leg_length)
    fitted = fit_sole(body, 0, solids, semantics), fit_sole(body, 1, solids, semantics)
    fall_points, bare = find_fall_points(body, solids)
    spec = _first_spec(root, urdf, body, fitted, semantics)
    spec = msgspec.structs.replace(spec, fall_points=fall_points)
    home = find_home(body, spec, semantics.angles, max(sole.drop for sole in fitted))
    spec = msgspec.structs.replace(spec, home=home.spec)
    if not home.fault:
        spec = _with_rotors(spec)
    remarks = [
        *remarks_on_urdf(root),
        *remarks_on_body(body),
        *remarks_on_soles(body, fitted),
        *remarks_on_solids(solids, bare),
        *remarks_on_inertia(root, body),
        *remarks_on_posture(body, semantics),
        *_estimates(spec, home),
    ]
    return Proposal(spec, tuple(remarks), home.fault)


def _first_spec(
    root: ET.Element, urdf: Path, body: Body, soles: tuple[Sole, Sole], semantics: Semantics
) -> RobotSpec:
    """Everything but fall points, rotors and posture."""
    title = root.get("name") or urdf.stem
    (left, right) = (sole.spec for sole in soles)
    return RobotSpec(
        name=re.sub(r"[^a-z0-9]+", "_", title.lower()).strip("_"),
        title=title,
        urdf=_place(urdf),
        pelvis=body.pelvis_link,
        trunk=body.link(body.trunk),
        upper_body=tuple(body.model.names[joint] for joint in body.upper),
        feet=dict(zip(FEET, (left, right), strict=True)),
        home=HomeSpec(foot_distance(body, (left.y, right.y)), body.leg_length),
        push_bodies=_push_bodies(body),
        friction=_FRICTION,
        limits=(limits := missing_limits(body)),
        sources=_sources(soles[0], semantics) | (_LIMITS_SOURCE if limits else {}),
    )


def _place(urdf: Path) -> str:
    """Relative to the robot-data package where it lies in it, absolute elsewhere."""
    path = urdf.resolve()
    data = robot_data_folder().resolve()
    return path.relative_to(data).as_posix() if path.is_relative_to(data) else str(path)


def _push_bodies(body: Body) -> dict[str, str]:
    found = {"pelvis": body.pelvis_link, "trunk": body.link(body.trunk)}
    if body.head_link is not None:
        found["head"] = body.head_link
    for side, arm in zip(FEET, body.arms, strict=True):
        if arm:
            found[f"{side}_hand"] = body.link(arm[-1])
    for side, leg in zip(FEET, body.legs, strict=True):
        if leg.pitch:
            found[f"{side}_knee"] = body.link(leg.pitch[1])
    return found


def _with_rotors(spec: RobotSpec) -> RobotSpec:
    """The robot with rotor inertias in proportion to what each joint moves when the robot stands.

    The joints of a leg get the same one: their motors are alike, and an ankle moves a foot or the whole robot.
    """
    robot = RobotModel(spec)
    mass_matrix = pin.crba(robot.model, robot.model.createData(), standing_posture(robot))
    loads = np.diag(mass_matrix)[6:] - robot.model.armature[6:]
    for sole in robot.soles:
        loads[sole.joints] = np.median(loads[sole.joints])
    rotors = {
        name: float(f"{np.clip(_ROTOR * load, _SMALLEST, _LARGEST):.1g}")
        for name, load, own in zip(robot.joint_names, loads, robot.model.armature[6:], strict=True)
        if not own > 0.0
    }
    return msgspec.structs.replace(spec, armature=rotors)


def _sources(sole: Sole, semantics: Semantics) -> dict[str, str]:
    arms = f"arms from {semantics.state} of {semantics.file}" if semantics.state else "arms at zero"
    return {
        "urdf": "masses, effort, position and velocity limits are the URDF's",
        "soles": f"{sole.source}, rounded inwards to 1 mm",
        "home": f"knees bent as far as limits and reach allow, feet as far apart as the legs hang, {arms}",
        "friction": "estimate: rubber sole on a hard floor, a customary value",
        "armature": "estimate: a tenth of what a joint moves in the home posture, in a leg of the median joint",
        "fall_points": "corners of the shapes' convex hulls, far from each other, rounded to 1 mm",
    }


def _estimates(spec: RobotSpec, home: Home) -> list[Remark]:
    """What has been guessed, and what the posture that was found is worth."""
    found = [
        Remark("estimated", f"friction {_FRICTION:g}: rubber on a hard floor"),
        Remark("estimated", "armature: a tenth of what each joint moves, in a leg of its median joint"),
    ]
    if not home.fault and home.bend < 0.5:
        found.append(Remark("doubtful", f"the knees could be bent by no more than {home.bend:g} rad"))
    if not home.fault:
        robot = RobotModel(spec)
        for joint, part in _strained(robot, standing_posture(robot)).items():
            found.append(
                Remark("doubtful", f"holding the home posture takes {part:.0%} of the effort of {joint}")
            )
    return found


def _strained(robot: RobotModel, q: np.ndarray) -> dict[str, float]:
    """Motors that need more than 80 % of their torque while the soles share the weight: joint -> part.

    tau = g(q) - sum J_f^T w, each w a half of the weight in the middle of its sole.
    """
    dynamics = robot.at(State(q, np.zeros(robot.nv)))
    torque = dynamics.nonlinear_effects.copy()
    force = np.array([0.0, 0.0, torque[2] / len(robot.soles)])
    for i, sole in enumerate(robot.soles):
        lever = dynamics.sole_rotation[i] @ sole.corners.mean(axis=0)
        torque -= dynamics.sole_jacobian[i].T @ np.concatenate([force, np.cross(lever, force)])
    parts = np.abs(torque[6:]) / robot.effort_limit
    return {robot.joint_names[i]: float(parts[i]) for i in np.flatnonzero(parts > _EASY)}


__all__ = ["Proposal", "Remark", "propose"]
