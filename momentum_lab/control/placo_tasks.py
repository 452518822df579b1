"""One whole-body program on PlaCo's dynamics solver: planar contacts that hold, and tasks that give way."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import placo

from momentum_lab.control.controller import Reference
from momentum_lab.control.placo_body import follow, middle_frame, middle_of, placo_body
from momentum_lab.errors import SolverError
from momentum_lab.momentum.directions import axes
from momentum_lab.momentum.foot_ground import acceleration_at, distance_above, velocity_at
from momentum_lab.momentum.wrench import cross, shift_wrench, wrench_in_world_axes
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics

# PlaCo's default price of torque drags the CoM away by up to 0.5 m/s^2 on TALOS.
_TORQUE_COST = 1e-9
# Small wrenches, moments above all: this shares the load between feet, and costs the CoM less than 1e-4 m/s^2.
_FORCE_COST, _MOMENT_COST = 1e-6, 1e-4
# Accelerations of the three tasks against each other; priority exchanges the first two.
_FIRST, _SECOND, _POSTURE = 1e3, 1e1, 1e-3


@dataclass(frozen=True, slots=True)
class Law:
    """Gains of one task: acceleration = stiffness * error + damping * rate of the error.

    Attributes:
        stiffness: 1/s^2.
        damping: 1/s.
    """

    stiffness: float
    damping: float


@dataclass(frozen=True, slots=True)
class TaskLaws:
    """How every task of the program pulls.

    Attributes:
        com: of the centre of mass.
        pelvis: of the pelvis orientation.
        posture: of all joints.
        contact_rate: kappa, at which stance feet come to rest and lie flat, 1/s.
        safe_border: how far inside the edge of the sole its CoP stays, m.
        friction: Coulomb coefficient of the ground.
    """

    com: Law
    pelvis: Law
    posture: Law
    contact_rate: float
    safe_border: float
    friction: float


@dataclass(frozen=True, slots=True)
class WholeBodyAnswer:
    """What PlaCo answers.

    Attributes:
        torque: joint torques (na,), N m.
        acceleration: generalized acceleration (nv,).
        wrench: ground on each foot about the sole origin, world axes (F, 6), N and N m.
    """

    torque: np.ndarray
    acceleration: np.ndarray
    wrench: np.ndarray


class PlacoTasks:
    """CoM, pelvis and posture of one robot on some of its feet.

    Contact k of PlaCo sits in the middle of its sole, so that its rectangle is the sole's. Its friction cone is a
    square pyramid around the true cone; with mu / sqrt(2) it is the one inside.

    Args:
        robot: the robot.
        stance: the feet that carry, as indices.
        timestep: s.
    """

    def __init__(self, robot: RobotModel, stance: tuple[int, ...], timestep: float) -> None:
        self.robot = robot
        self.stance = stance
        self._body = placo_body(robot)
        self._solver = placo.DynamicsSolver(self._body)
        self._solver.dt = timestep
        self._solver.torque_cost = _TORQUE_COST
        self._solver.enable_torque_limits(True)
        self._feet = [self._foot(foot) for foot in stance]
        self._contacts = [self._contact(task) for task in self._feet]
        self._com = self._solver.add_com_task(np.zeros(3))
        self._pelvis = self._solver.add_orientation_task(robot.spec.pelvis, np.eye(3))
        self._posture = self._solver.add_joints_task()
        self._posture.configure("posture", "soft", _POSTURE)

    def solve(
        self, dynamics: Dynamics, reference: Reference, laws: TaskLaws, priority: float
    ) -> WholeBodyAnswer:
        """The torques of one tick; the answer depends on the arguments alone.

        Args:
            dynamics: the state with everything computed.
            reference: goals of CoM, pelvis and joints.
            laws: how the tasks pull.
            priority: 0 gives the CoM a hundred times the weight of the pelvis, 1 the other way round.

        Raises:
            SolverError: the contacts cannot hold within friction and torque limits.
        """
        follow(self._body, dynamics.state)
        self._hold_feet(dynamics, reference, laws)
        self._com.configure("com", "soft", _FIRST ** (1.0 - priority) * _SECOND**priority)
        self._pelvis.configure("pelvis", "soft", _SECOND ** (1.0 - priority) * _FIRST**priority)
        self._com.mask.set_axises(axes(reference.controlled)[0], "task")
        self._com.target_world, self._com.dtarget_world = reference.com, reference.com_velocity
        self._com.ddtarget_world = reference.com_acceleration
        self._pelvis.R_world_frame = reference.pelvis_rotation
        posture = reference.posture_ahead(_lead(laws.posture))
        self._posture.set_joints(dict(zip(self.robot.joint_names, posture.tolist(), strict=True)))
        _obey(self._com, laws.com)
        _obey(self._pelvis, laws.pelvis)
        _obey(self._posture, laws.posture)
        result = self._solver.solve(False)
        if not result.success:
            raise SolverError("PlaCo finds no torques within the limits of joints, friction and soles")
        return WholeBodyAnswer(result.tau[6:].copy(), result.qdd.copy(), self._wrenches(dynamics))

    def _hold_feet(self, dynamics: Dynamics, reference: Reference, laws: TaskLaws) -> None:
        """Eq. 31 as PlaCo's frame tasks: flat on their plates and moving with them (see `standing_feet`)."""
        law = Law(laws.contact_rate**2, 2.0 * laws.contact_rate)
        for foot, task, contact in zip(self.stance, self._feet, self._contacts, strict=True):
            sole = self.robot.soles[foot]
            position, rotation = dynamics.sole_position[foot], dynamics.sole_rotation[foot]
            there = position + rotation @ middle_of(sole)
            plate, axes_of_plate = reference.ground.position[foot], reference.ground.rotation[foot]
            normal, moving = axes_of_plate[:, 2], reference.ground.velocity[foot]
            carried = velocity_at(there, plate, moving)
            speeding = acceleration_at(there, plate, moving, reference.ground.acceleration[foot])
            task.position().target_world = there - distance_above(plate, axes_of_plate, there) * normal
            task.position().dtarget_world, task.position().ddtarget_world = carried[:3], speeding[:3]
            task.orientation().R_world_frame = _laid_flat(rotation, normal)
            task.orientation().omega_world, task.orientation().domega_world = carried[3:], speeding[3:]
            _obey(task.position(), law)
            _obey(task.orientation(), law)
            contact.length, contact.width = (sole.upper - sole.lower - 2.0 * laws.safe_border).tolist()
            contact.mu = laws.friction / math.sqrt(2.0)

    def _wrenches(self, dynamics: Dynamics) -> np.ndarray:
        """PlaCo's contact wrenches, in sole axes about the sole's middle, where ours are (F, 6)."""
        wrench = np.zeros((len(self.robot.soles), 6))
        for foot, contact in zip(self.stance, self._contacts, strict=True):
            about_sole = shift_wrench(contact.wrench, middle_of(self.robot.soles[foot]), np.zeros(3))
            wrench[foot] = wrench_in_world_axes(about_sole, dynamics.sole_rotation[foot])
        return wrench

    def _foot(self, foot: int) -> placo.DynamicsFrameTask:
        sole = self.robot.soles[foot]
        task = self._solver.add_frame_task(middle_frame(sole), np.eye(4))
        task.configure(sole.name, "hard")
        return task

    def _contact(self, task: placo.DynamicsFrameTask) -> placo.Contact6D:
        contact = self._solver.add_planar_contact(task)
        contact.weight_forces, contact.weight_moments = _FORCE_COST, _MOMENT_COST
        # PlaCo applies this one to the lateral and the normal force.
        contact.weight_tangentials = 0.0
        return contact


def _lead(law: Law) -> float:
    """How far ahead a moving posture has to be for the law to follow it, s."""
    return law.damping / law.stiffness if law.stiffness else 0.0


def _obey(task: Any, law: Law) -> None:
    task.kp, task.kd = law.stiffness, law.damping


def _laid_flat(rotation: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Axes whose z is a normal (3,), the sole's own heading kept: x is its forward axis, laid into the plate."""
    forward = rotation[:, 0] - (rotation[:, 0] @ normal) * normal
    forward /= math.sqrt(forward @ forward)
    return np.column_stack([forward, cross(normal, forward), normal])
