"""A standing posture to propose: knees slightly bent, feet as far apart as they hang, arms as the SRDF has them."""

from __future__ import annotations

from dataclasses import dataclass

import msgspec
import numpy as np
import pinocchio as pin

from momentum_lab.errors import RobotError
from momentum_lab.robot.catalog import HomeSpec, RobotSpec
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.posture import MARGIN, standing_posture
from momentum_lab.robot.proposal.body import Body, Leg

# Knee angles that are tried one after the other, rad: the first that the limits and the motors allow is proposed.
_BENDS = (0.7, 0.5, 0.35, 0.2, 0.1)
# Soles keep this distance between them, m.
_GAP = 0.02


@dataclass(frozen=True, slots=True)
class Home:
    """A posture that was found.

    Attributes:
        spec: what the robot's file says about it.
        bend: angle of the knees that was aimed for, rad.
        fault: why no posture was found, in words; empty if one was.
    """

    spec: HomeSpec
    bend: float
    fault: str


def first_home(body: Body, angles: dict[str, float], distance: float, drop: float, bend: float) -> HomeSpec:
    """Where the inverse kinematics may start: leg angles that keep the foot below the hip, and the height they give.

    Args:
        body: the robot's parts.
        angles: joint -> angle of the upper body, rad; zero where nothing is said.
        distance: between the sole origins, m.
        drop: how far the soles lie below the given frames, m.
        bend: of the knees, rad.
    """
    joints = {body.model.names[j]: _within_limits(body.model, j, angles.get(body.model.names[j], 0.0))
              for j in body.upper}  # fmt: skip
    for leg in body.legs:
        joints |= _bent(body, leg, bend)
    return HomeSpec(
        distance, _height(body, joints, drop), {name: a for name, a in joints.items() if a != 0.0}
    )


def find_home(body: Body, spec: RobotSpec, angles: dict[str, float], drop: float) -> Home:
    """The most bent of some postures that inverse kinematics reaches, with its pelvis height.

    Args:
        body: the robot's parts.
        spec: the robot, its home yet to be found.
        angles: joint -> angle of the upper body, rad.
        drop: how far the soles lie below the given frames, m.
    """
    fault = ""
    for bend in _BENDS:
        guess = first_home(body, angles, spec.home.foot_distance, drop, bend)
        try:
            robot = RobotModel(msgspec.structs.replace(spec, home=guess))
            q = standing_posture(robot)
        except RobotError as error:
            fault = f"{error.argument}: {error.given}"
            continue
        return Home(msgspec.structs.replace(guess, base_height=_pelvis_height(robot, q)), bend, "")
    return Home(first_home(body, angles, spec.home.foot_distance, drop, _BENDS[0]), _BENDS[0], fault)


def foot_distance(body: Body, spec_feet: tuple[tuple[float, float], tuple[float, float]]) -> float:
    """Lateral distance of the soles as the legs hang, wider if the soles would touch, m.

    Args:
        body: the robot's parts.
        spec_feet: y range of the left and the right sole in its frame, m.
    """
    hanging = float((body.data.oMf[body.soles[0]].translation - body.data.oMf[body.soles[1]].translation)
                    @ body.axes[:, 1])  # fmt: skip
    (inner_left, _), (_, inner_right) = spec_feet
    return round(max(hanging, inner_right - inner_left + _GAP), 4)


def _bent(body: Body, leg: Leg, bend: float) -> dict[str, float]:
    """Hip, knee and ankle angles with the ankle below the hip and the foot level, within their limits."""
    if not leg.pitch:
        return {}
    hip, knee, ankle = leg.pitch
    thigh = float(np.linalg.norm(body.place(knee) - body.place(hip)))
    shank = float(np.linalg.norm(body.place(ankle) - body.place(knee)))
    lean = float(np.arctan2(shank * np.sin(bend), thigh + shank * np.cos(bend)))
    wanted = (-lean, bend, lean - bend)
    return {
        body.model.names[joint]: round(_within_limits(body.model, joint, sign * angle), 4)
        for joint, sign, angle in zip(leg.pitch, leg.sign, wanted, strict=True)
    }


def _within_limits(model: pin.Model, joint: int, angle: float) -> float:
    """The angle, or the nearest one that keeps its distance from the joint's limits."""
    index = model.joints[joint].idx_q
    low, high = model.lowerPositionLimit[index], model.upperPositionLimit[index]
    if not low < high:
        return angle
    margin = min(MARGIN, 0.25 * (high - low))
    return float(np.clip(angle, np.ceil(1e4 * (low + margin)) / 1e4, np.floor(1e4 * (high - margin)) / 1e4))


def _height(body: Body, joints: dict[str, float], drop: float) -> float:
    """Pelvis above the soles with the legs bent, m."""
    model, data = body.model, body.model.createData()
    q = pin.neutral(model)
    for name, angle in joints.items():
        q[model.joints[model.getJointId(name)].idx_q] = angle
    pin.framesForwardKinematics(model, data, q)
    up = body.axes[:, 2]
    soles = min(float(data.oMf[sole].translation @ up) for sole in body.soles)
    pelvis = data.oMf[model.getFrameId(body.link(body.pelvis))]
    return round(max(float(pelvis.translation @ up) - soles + drop, 0.05), 4)


def _pelvis_height(robot: RobotModel, q: np.ndarray) -> float:
    data = robot.model.createData()
    pin.framesForwardKinematics(robot.model, data, q)
    return round(float(data.oMf[robot.pelvis].translation[2]), 4)
