"""Standing postures by PlaCo's inverse kinematics."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import pinocchio as pin
import placo

from momentum_lab.errors import RobotError
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.urdf import bare_urdf

LIFT = 0.05
"""Height of a lifted sole above its place on the ground, m."""

MARGIN = 0.05
"""Smallest distance of a leg joint's angle from its limits, rad."""

# Each weight outweighs the next by far: what the robot can reach is reached, and what it cannot reach costs
# the later goals first. A robot with stiff ankles leans its pelvis when it stands on one foot.
_STANCE, _COM, _SWING, _HEIGHT, _UPRIGHT, _REST = 1e6, 1e6, 1e3, 1e2, 1.0, 1e-4
# The step limit keeps the iteration from jumping between joint limits: no joint moves more than this, rad.
_LARGEST_STEP = 0.2
_STEPS, _STILL = 200, 1e-9
_DISTANCE_ERROR, _ANGLE_ERROR, _LIFT_ERROR = 2e-5, 2e-5, 0.02
# A URDF whose soles are tilted by less than this has z up: its feet hang a little, nothing more.
_NEARLY_UP = np.cos(np.pi / 4)
_REACHABLE_HOME = "a home (foot_distance, base_height, joints) that the legs can reach"
_REACHABLE_PLATES = "plates that the legs can reach: less tilt or less height between the feet"


@dataclass(frozen=True, slots=True)
class _Goal:
    """Where everything should be, world axes, and what to ask for if that is out of reach."""

    turn: np.ndarray
    soles: dict[str, pin.SE3]
    com: np.ndarray
    height: float
    pelvis: np.ndarray
    allowed: str


def home_places(robot: RobotModel) -> np.ndarray:
    """Where the soles are when the robot stands on a level floor, facing along x (F, 3), m."""
    data = _kinematics(robot, pin.neutral(robot.model))
    turn = _turn(robot, data)
    sides = [np.sign((turn @ data.oMf[sole.frame].translation)[1]) for sole in robot.soles]
    return np.array([(0.0, 0.5 * side * robot.spec.home.foot_distance, 0.0) for side in sides])


def standing_posture(
    robot: RobotModel,
    stance: Sequence[str] | None = None,
    com_outside: float | None = None,
    places: Sequence[pin.SE3] | None = None,
) -> np.ndarray:
    """A configuration in which the robot stands on the given feet, facing along x.

    Soles of the stance are flat at their places, the others `LIFT` above them. The CoM is above the mean of the
    stance soles' rectangle centres, the pelvis at its home height above the lowest of them and as upright as
    the joints allow, the upper body at its home angles.

    Args:
        robot: the robot.
        stance: names of the feet to stand on; all of them unless given.
        com_outside: how far outside the outer edge of the only stance foot the CoM is instead, m (Fig. 9).
        places: where each sole is if it stands; level at z = 0, x = 0 and y = +-foot_distance / 2 unless given.

    Returns:
        q (nq,), m and rad, in Pinocchio's order; the same arguments give the same bits.

    Raises:
        RobotError: a foot is unknown, a home angle is outside its limits, or the posture is out of reach.
    """
    feet = tuple(robot.foot_names if stance is None else stance)
    if not feet or not set(feet) <= set(robot.foot_names):
        raise RobotError("stance", ", ".join(feet), f"one or more of {', '.join(robot.foot_names)}")
    if com_outside is not None and len(feet) != 1:
        raise RobotError("stance of a robot with its CoM outside", ", ".join(feet), "a single foot")
    allowed = _REACHABLE_PLATES
    if places is None:
        places, allowed = [pin.SE3(np.eye(3), place) for place in home_places(robot)], _REACHABLE_HOME
    where = tuple((place.rotation.tobytes("C"), place.translation.tobytes()) for place in places)
    return _found(robot, feet, com_outside, where, allowed).copy()


# PlaCo never gives back the 2 MB of a robot that it has read, and every start of a scenario asks for two postures.
@lru_cache(maxsize=32)
def _found(
    robot: RobotModel,
    feet: tuple[str, ...],
    com_outside: float | None,
    where: tuple[tuple[bytes, bytes], ...],
    allowed: str,
) -> np.ndarray:
    places = [
        pin.SE3(np.frombuffer(rotation).reshape(3, 3), np.frombuffer(translation))
        for rotation, translation in where
    ]
    goal = _goal(robot, feet, com_outside, places, allowed)
    q = _solve(robot, feet, goal)
    _verify(robot, feet, goal, q)
    return q


def _home_angles(robot: RobotModel) -> np.ndarray:
    """Joint angles (na,) that the robot's file asks for, rad; zero where it says nothing."""
    angles = np.zeros(robot.na)
    for pattern, angle in robot.spec.home.joints.items():
        angles[robot.matching_joints([pattern])] = angle
    outside = np.flatnonzero((angles < robot.position_lower) | (angles > robot.position_upper))
    if outside.size:
        i = outside[0]
        raise RobotError(
            f"home.joints of {robot.spec.name}",
            f"{robot.joint_names[i]} = {angles[i]:g}",
            f"{robot.position_lower[i]:g} to {robot.position_upper[i]:g} rad",
        )
    return angles


def _turn(robot: RobotModel, data: pin.Data) -> np.ndarray:
    """The turn (3, 3) that lets a robot stand upright and face along x, as its sole does with all joints at zero."""
    sole = data.oMf[robot.soles[0].frame].rotation
    upright = _upright(sole[:, 2])
    toes = upright @ sole[:, 0]
    turn: np.ndarray = pin.utils.rotate("z", -float(np.arctan2(toes[1], toes[0]))) @ upright
    return turn


def _goal(
    robot: RobotModel,
    feet: Sequence[str],
    com_outside: float | None,
    places: Sequence[pin.SE3],
    allowed: str,
) -> _Goal:
    """Targets of the stance."""
    data = _kinematics(robot, pin.neutral(robot.model))
    turn, soles = _turn(robot, data), {}
    for sole, place in zip(robot.soles, places, strict=True):
        lift = np.array([0.0, 0.0, 0.0 if sole.name in feet else LIFT])
        soles[sole.name] = pin.SE3(place.rotation, place.translation + lift)
    centres = [soles[sole.name].act(sole.corners.mean(axis=0)) for sole in robot.soles if sole.name in feet]
    com, height = np.mean(centres, axis=0), min(soles[name].translation[2] for name in feet)
    if com_outside is not None:
        (sole,) = (sole for sole in robot.soles if sole.name in feet)
        half_width = 0.5 * (sole.upper[1] - sole.lower[1])
        com[1] += np.sign(soles[sole.name].translation[1]) * (half_width + com_outside)
    return _Goal(turn, soles, com, height, turn @ data.oMf[robot.pelvis].rotation, allowed)


def _upright(sole_normal: np.ndarray) -> np.ndarray:
    """The smallest turn (3, 3) that lets the normal of a sole point up, if the URDF has another axis up than z."""
    if sole_normal[2] > _NEARLY_UP:
        return np.eye(3)
    return pin.Quaternion.FromTwoVectors(sole_normal, np.array([0.0, 0.0, 1.0])).toRotationMatrix()


def _solve(robot: RobotModel, feet: Sequence[str], goal: _Goal) -> np.ndarray:
    xml = ET.tostring(bare_urdf(robot.urdf, robot.spec), encoding="unicode")
    body = placo.RobotWrapper(str(robot.urdf), placo.Flags.ignore_collisions, xml)
    solver = placo.KinematicsSolver(body)
    _start(robot, body, solver, goal)
    for sole in robot.soles:
        position, rotation = (_STANCE, _STANCE) if sole.name in feet else (_SWING, _UPRIGHT)
        task = solver.add_frame_task(robot.spec.feet[sole.name].frame, goal.soles[sole.name].homogeneous)
        task.configure(sole.name, "soft", position, rotation)
    com = solver.add_com_task(goal.com)
    com.mask.set_axises("xy")
    com.configure("com", "soft", _COM)
    pelvis_height = np.array([0.0, 0.0, goal.height + robot.spec.home.base_height])
    height = solver.add_position_task(robot.spec.pelvis, pelvis_height)
    height.mask.set_axises("z")
    height.configure("height", "soft", _HEIGHT)
    solver.add_orientation_task(robot.spec.pelvis, goal.pelvis).configure("upright", "soft", _UPRIGHT)
    solver.add_regularization_task(_REST)
    try:
        _iterate(body, solver)
    except RuntimeError as error:
        raise RobotError(f"standing posture of {robot.spec.name}", error, goal.allowed) from error
    base = pin.SE3ToXYZQUAT(pin.SE3(body.get_T_world_fbase()))
    return np.concatenate([base, [body.get_joint(name) for name in robot.joint_names]])


def _iterate(body: placo.RobotWrapper, solver: placo.KinematicsSolver) -> None:
    for _ in range(_STEPS):
        step = solver.solve(True)
        body.update_kinematics()
        if np.abs(step).max() < _STILL:
            return


def _start(robot: RobotModel, body: placo.RobotWrapper, solver: placo.KinematicsSolver, goal: _Goal) -> None:
    """Put PlaCo's robot into the home posture, hold its upper body there and set the limits of the rest."""
    for i, (name, angle) in enumerate(zip(robot.joint_names, _home_angles(robot), strict=True)):
        body.set_joint(name, angle)
        if i in robot.upper_body:
            solver.mask_dof(name)
        else:
            body.set_joint_limits(name, robot.position_lower[i] + MARGIN, robot.position_upper[i] - MARGIN)
    base = pin.SE3(goal.turn, np.array([0.0, 0.0, goal.height + robot.spec.home.base_height]))
    body.set_T_world_fbase(base.homogeneous)
    body.update_kinematics()
    solver.enable_joint_limits(True)
    solver.enable_velocity_limits(True)
    body.set_velocity_limits(_LARGEST_STEP)
    solver.dt = 1.0


def _verify(robot: RobotModel, feet: Sequence[str], goal: _Goal, q: np.ndarray) -> None:
    """Refuse a configuration that is not the posture asked for, in words."""
    data = _kinematics(robot, q)
    faults = []
    for sole in robot.soles:
        error = goal.soles[sole.name].actInv(data.oMf[sole.frame])
        distance, angle = np.linalg.norm(error.translation), np.linalg.norm(pin.log3(error.rotation))
        if distance > (_DISTANCE_ERROR if sole.name in feet else _LIFT_ERROR):
            faults.append(f"{sole.name} sole {1e3 * distance:.2f} mm from its place")
        if sole.name in feet and angle > _ANGLE_ERROR:
            faults.append(f"{sole.name} sole {angle:.4f} rad from the tilt of its place")
    sway = np.linalg.norm(pin.centerOfMass(robot.model, data, q)[:2] - goal.com[:2])
    if sway > _DISTANCE_ERROR:
        faults.append(f"centre of mass {1e3 * sway:.2f} mm from its place above the support")
    outside = (q[7:] < robot.position_lower) | (q[7:] > robot.position_upper)
    faults += [f"{robot.joint_names[i]} outside its limits" for i in np.flatnonzero(outside)]
    if faults:
        raise RobotError(f"standing posture of {robot.spec.name}", "; ".join(faults), goal.allowed)


def _kinematics(robot: RobotModel, q: np.ndarray) -> pin.Data:
    data = robot.model.createData()
    pin.framesForwardKinematics(robot.model, data, q)
    return data
