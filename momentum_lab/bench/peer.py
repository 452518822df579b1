"""The loop that a user would build instead of this lab, for comparison: PlaCo decides, MuJoCo moves."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import Any

import numpy as np
import placo

from momentum_lab.errors import SimulationError
from momentum_lab.physics.mujoco_model import load_mujoco, mujoco_model
from momentum_lab.robot.model import RobotModel, Sole
from momentum_lab.robot.state import State
from momentum_lab.robot.urdf import add_fixed_link, bare_urdf

# PlaCo's default cost on torques drags its CoM task away by up to 0.5 m/s^2 on TALOS; without any cost on
# forces the feet would push against each other as hard as their friction lets them.
_TORQUE_COST, _FORCE_COST = 1e-9, 2e-7
# What the lab's controller counts on, too: friction, and how far inside the sole's edge the CoP stays, m.
_FRICTION, _BORDER = 0.6, 0.005
_COM_WEIGHT, _PELVIS_WEIGHT, _POSTURE_WEIGHT = 1.0, 1e-2, 1e-2
# Proportional gains, 1/s^2, which PlaCo damps critically; stiffer ones ask for a CoP beyond the toes of G1.
_COM_GAIN, _PELVIS_GAIN, _POSTURE_GAIN = 12.0, 25.0, 100.0
# A foot in contact is only braked, 1/s: its place on MuJoCo's soft floor is not known to a tenth of a millimetre.
_CONTACT_GAIN, _CONTACT_DAMPING = 0.0, 5.0
# Braking that PlaCo reserves before a joint's limit, rad/s^2; with its 1 the pushed G1 has no solution.
_BRAKING = 50.0
_BASE_QUATERNION = slice(3, 7)


class PlacoPeer:
    """Whole-body control of a standing robot in PlaCo, from a state to torques.

    `DynamicsSolver` with hard planar contacts of both soles (friction cones, CoP within the rectangle, normal
    force above zero), a CoM task, a pelvis orientation task and a soft posture of all joints, all with
    proportional and derivative gains; with torque limits and joint limits, which the lab's controllers respect
    too. PlaCo centres a contact on its frame, so each sole gets a frame at the middle of
    its rectangle. Rotor inertias are the lab's.

    Args:
        robot: the robot.
        home: the standing state, which is what it shall keep.
        timestep: s.
    """

    def __init__(self, robot: RobotModel, home: State, timestep: float) -> None:
        self.robot = robot
        self.body = placo.RobotWrapper(str(robot.urdf), placo.Flags.ignore_collisions, _urdf(robot))
        for name, inertia in zip(robot.joint_names, robot.model.armature[6:].tolist(), strict=True):
            self.body.set_rotor_inertia(name, inertia)
        self.solver = placo.DynamicsSolver(self.body)
        for name in robot.joint_names:
            self.solver.set_qdd_safe(name, _BRAKING)
        self.solver.dt = timestep
        self.solver.torque_cost = _TORQUE_COST
        self.solver.enable_torque_limits(True)
        self.solver.enable_joint_limits(True)
        # Views of PlaCo's own memory: writing to them sets its state.
        self.q, self.v = self.body.state.q, self.body.state.qd
        self.follow(home)
        self.contacts = [self._contact(sole) for sole in robot.soles]
        self._add_tasks(home)

    def follow(self, state: State) -> None:
        """Put PlaCo's robot into a state."""
        self.q[:], self.v[:] = state.q, state.v
        self.body.update_kinematics()

    def solve(self) -> np.ndarray:
        """All generalized forces (nv,), N m, that of the base being zero: one call of DynamicsSolver.solve().

        Raises:
            SimulationError: PlaCo found no solution.
        """
        result = self.solver.solve()
        if not result.success:
            raise SimulationError("PlaCo found no torques")
        return result.tau

    def _add_tasks(self, home: State) -> None:
        com = self.solver.add_com_task(self.body.com_world())
        com.configure("com", "soft", _COM_WEIGHT)
        com.kp = _COM_GAIN
        pelvis = self.robot.spec.pelvis
        upright = self.solver.add_orientation_task(pelvis, self.body.get_T_world_frame(pelvis)[:3, :3])
        upright.configure("pelvis", "soft", _PELVIS_WEIGHT)
        upright.kp = _PELVIS_GAIN
        posture = self.solver.add_joints_task()
        posture.set_joints(dict(zip(self.robot.joint_names, home.q[7:].tolist(), strict=True)))
        posture.configure("posture", "soft", _POSTURE_WEIGHT)
        posture.kp = _POSTURE_GAIN

    def _contact(self, sole: Sole) -> placo.Contact6D:
        frame = _contact_frame(sole)
        task = self.solver.add_frame_task(frame, self.body.get_T_world_frame(frame))
        task.configure(sole.name, "hard")
        for part in (task.position(), task.orientation()):
            part.kp, part.kd = _CONTACT_GAIN, _CONTACT_DAMPING
        contact = self.solver.add_planar_contact(task)
        contact.length, contact.width = sole.upper - sole.lower - 2.0 * _BORDER
        contact.mu = _FRICTION
        contact.weight_forces = contact.weight_moments = contact.weight_tangentials = _FORCE_COST
        return contact


def _urdf(robot: RobotModel) -> str:
    """The robot without meshes, with a frame at the middle of each sole."""
    root = bare_urdf(robot.urdf, robot.spec.feet)
    for sole in robot.soles:
        middle = (*((sole.lower + sole.upper) / 2.0), 0.0)
        add_fixed_link(root, _contact_frame(sole), robot.spec.feet[sole.name].frame, middle)
    return ET.tostring(root, encoding="unicode")


def _contact_frame(sole: Sole) -> str:
    return f"{sole.name}_contact"


class PeerLoop:
    """One robot in MuJoCo, balanced by PlaCo: state, kinematics, torques, step.

    Args:
        placo: the controller.
        home: the standing state it starts from.
        timestep: of control and physics, s.

    Raises:
        LabError: MuJoCo is not installed.
    """

    def __init__(self, placo: PlacoPeer, home: State, timestep: float) -> None:
        mujoco = load_mujoco()
        robot = placo.robot
        self.placo = placo
        self.model = mujoco_model(robot, timestep)
        self.data: Any = mujoco.MjData(self.model)
        self._trunk_force = self.data.xfrc_applied[self.model.body(robot.spec.trunk).id, :3]
        self._step, self._rotate, self._conjugate = (
            mujoco.mj_step,
            mujoco.mju_rotVecQuat,
            mujoco.mju_negQuat,
        )
        # Views and buffers, so that a tick makes no arrays.
        self._qpos, self._qvel, self._ctrl = self.data.qpos, self.data.qvel, self.data.ctrl
        self._quaternion, self._velocity = self._qpos[_BASE_QUATERNION], self._qvel[:3]
        self._base_velocity = placo.v[:3]
        self._to_base = np.zeros(4)
        self._order = np.r_[0:3, 4:7, 3, 7 : robot.nq]
        self._qpos[self._order] = home.q

    def tick(self) -> None:
        """From the present state to the next one."""
        self.control()
        self.move()

    def control(self) -> None:
        """PlaCo's torques for MuJoCo's state, handed to the motors."""
        self.read_state()
        self.placo.body.update_kinematics()
        self._ctrl[:] = self.placo.solve()[6:]

    def move(self) -> None:
        """One step of MuJoCo."""
        self._step(self.model, self.data)

    def push(self, force: np.ndarray) -> None:
        """Pull at the trunk's centre of mass with a force (3,), N, until told otherwise."""
        self._trunk_force[:] = force

    def read_state(self) -> None:
        """Give MuJoCo's state to PlaCo.

        MuJoCo's quaternion is wxyz and its base velocity that of the origin in world axes.
        """
        self._qpos.take(self._order, out=self.placo.q, mode="clip")
        self.placo.v[:] = self._qvel
        self._conjugate(self._to_base, self._quaternion)
        self._rotate(self._base_velocity, self._velocity, self._to_base)
