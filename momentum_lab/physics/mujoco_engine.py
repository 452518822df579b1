"""From one state to the next in MuJoCo's physics: another answer to the same question as `simulator.Simulator`."""

from __future__ import annotations

from typing import Any

import numpy as np

from momentum_lab.errors import InputError
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.momentum.wrench import cross
from momentum_lab.physics.ground import Ground, Patch
from momentum_lab.physics.mujoco_model import CONTACTS_PER_FOOT, falling_model, load_mujoco
from momentum_lab.physics.push import AppliedPush, Push, apply_pushes
from momentum_lab.physics.simulator import Step, driven, external_wrenches
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics, State

# MuJoCo's floor is a damped spring; it keeps one stable that answers within two steps, and no faster one.
_STEPS_OF_FLOOR = 2.0
# Friction is this much harder than the floor: a foot that holds 1 m/s^2 creeps by some micrometres a second.
_FRICTION_STIFFNESS = 10.0
# The time constant of the lab's own joint stops, s.
_STOP_TIME = 0.01
_CRITICAL = 1.0
# Where MuJoCo's Newton iteration may end; at its 1e-8 forces and accelerations of a fall disagree by 1e-4 m g.
_TOLERANCE = 1e-12
_OTHER = -1
# MuJoCo's quaternion is wxyz.
_QUATERNION = slice(3, 7)


class MujocoSimulator:
    """The world of one robot, moved by MuJoCo: same links, limits, motors, soles, friction and pushes.

    Contacts are MuJoCo's: soft, though as hard as the timestep permits, with elliptic friction cones. A step
    depends on nothing but its arguments: the solver starts cold every time.

    Args:
        robot: the robot.
        ground: what it stands on: level, at rest.
        timestep: length of a step, s.

    Raises:
        InputError: MuJoCo is not installed, or the ground is not level.
        RobotError: MuJoCo refuses the robot.
    """

    def __init__(self, robot: RobotModel, ground: Ground, timestep: float) -> None:
        mujoco = load_mujoco()
        self.robot = robot
        self.timestep = timestep
        self._mujoco = mujoco
        self._model = falling_model(robot, timestep)
        self._weigh(robot.inertia_scale)
        self._model.opt.tolerance = _TOLERANCE
        self._model.opt.impratio = _FRICTION_STIFFNESS
        self._model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_WARMSTART
        self._model.geom_solref[:] = _STEPS_OF_FLOOR * timestep, _CRITICAL
        self._model.jnt_solref[:] = _STOP_TIME, _CRITICAL
        check_level(ground)
        self._ground = ground
        self._foot_of_geom = self._on_the_floor(ground.floor)
        self._data: Any = mujoco.MjData(self._model)
        self._middle = 0.5 * (robot.position_lower + robot.position_upper)
        self._weight = robot.mass * GRAVITY
        self._push_data = robot.model.createData()

    def step(self, dynamics: Dynamics, torque: np.ndarray, pushes: tuple[Push, ...], time: float) -> Step:
        """The step from `dynamics.state` at `time` under joint torques (na,) and the pushes of the run.

        MuJoCo says what accelerates, contact and joint limits included; v+ = v + dt a, q+ = q (+) dt v+ as in
        the lab's own physics, so that Eq. 20 holds here, too, to the last digits. `contact_residual` is the
        largest normal speed of a sole's corner that is pressed on the floor: rigid ground would let none move.
        """
        torque, _ = driven(torque, self.robot.effort_limit, dynamics.nonlinear_effects)
        push = apply_pushes(self.robot, self._push_data, dynamics, pushes, time, self.timestep)
        turn = self._begin(dynamics.state, torque, push)
        friction = self._ground.friction(time)
        soles = self._foot_of_geom != _OTHER
        self._model.geom_friction[soles, 0] = friction[self._foot_of_geom[soles]]
        self._mujoco.mj_forward(self._model, self._data)
        wrenches, pressed = self._contact_wrenches(dynamics)
        velocity = dynamics.state.v + self.timestep * self._acceleration(dynamics.state, turn)
        pushed = np.zeros(6) if push is None else push.wrench
        feet, others, rate = self._external(dynamics, wrenches, pushed)
        return Step(
            state=State(self.robot.integrate(dynamics.state.q, self.timestep * velocity), velocity),
            torque=torque,
            stop_torque=self._stop_torque(),
            foot_wrench=feet,
            other_wrench=others,
            push_wrench=pushed,
            momentum_rate=rate,
            contact_residual=_sinking(dynamics, velocity, pressed),
        )

    def _on_the_floor(self, floor: Patch) -> np.ndarray:
        """Height and friction of the floor given to the model; which foot each of its shapes is on, or -1."""
        self._model.geom("floor").pos[2] = floor.origin[2]
        # MuJoCo takes the larger coefficient of the two shapes, hence none for the floor.
        self._model.geom_friction[:, 0] = floor.friction
        self._model.geom("floor").friction[0] = 0.0
        foot = np.full(self._model.ngeom, _OTHER)
        for i, sole in enumerate(self.robot.soles):
            foot[[self._model.geom(f"{sole.name}_{k}").id for k in range(CONTACTS_PER_FOOT)]] = i
        return foot

    def _begin(self, state: State, torque: np.ndarray, push: AppliedPush | None) -> np.ndarray:
        """Give MuJoCo everything that a step depends on; the base's axes in the world (3, 3).

        MuJoCo's base velocity is that of the origin in world axes, its forces likewise: v_mj = T v,
        f_mj = T f with T = diag(R, 1, 1).
        """
        data, axes = self._data, np.zeros(9)
        data.qpos[:] = state.q
        data.qpos[_QUATERNION] = state.q[[6, 3, 4, 5]]
        self._mujoco.mju_quat2Mat(axes, data.qpos[_QUATERNION])
        turn = axes.reshape(3, 3)
        data.qvel[:] = state.v
        data.qvel[:3] = turn @ state.v[:3]
        data.ctrl[:] = torque
        data.qfrc_applied[:] = 0.0 if push is None else push.generalized
        data.qfrc_applied[:3] = turn @ data.qfrc_applied[:3]
        return turn

    def _acceleration(self, state: State, turn: np.ndarray) -> np.ndarray:
        """MuJoCo's acceleration in Pinocchio's axes (nv,): those of the base turn, hence - omega x v."""
        acceleration: np.ndarray = self._data.qacc.copy()
        acceleration[:3] = turn.T @ acceleration[:3] - cross(state.v[3:6], state.v[:3])
        return acceleration

    def _contact_wrenches(self, dynamics: Dynamics) -> tuple[np.ndarray, np.ndarray]:
        """The floor on each foot about its sole origin, and on all else about the world origin (F + 1, 6).

        Also the pressed corners of soles: foot and point in the world of each (K, 4).
        """
        contact, origins = self._data.contact, self._origins(dynamics)
        touching = np.flatnonzero(contact.efc_address >= 0)
        foot, point = self._foot_of_geom[contact.geom[touching, 1]], contact.pos[touching]
        # The contact's axes are rows, its normal first, from the floor, always the first shape, upwards.
        local = self._data.efc_force[contact.efc_address[touching, None] + np.arange(3)]
        force = np.einsum("kji,kj->ki", contact.frame[touching].reshape(-1, 3, 3), local)
        wrenches = np.zeros((len(origins), 6))
        np.add.at(wrenches, foot, np.hstack([force, np.cross(point - origins[foot], force)]))
        pressed = (foot != _OTHER) & (local[:, 0] > 0.0)
        return wrenches, np.column_stack([foot, point])[pressed]

    def _external(
        self, dynamics: Dynamics, wrenches: np.ndarray, pushed: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        feet = len(wrenches) - 1
        return external_wrenches(
            self.timestep * wrenches,
            self.timestep,
            np.array([*range(feet), _OTHER]),
            self._origins(dynamics),
            pushed,
            dynamics.sole_position,
            dynamics.com_in_world,
            self._weight,
        )

    def _weigh(self, scale: float) -> None:
        """Make links heavier than the URDF says by a factor."""
        if scale != 1.0:
            self._model.body_mass *= scale
            self._model.body_inertia *= scale
            self._mujoco.mj_setConst(self._model, self._mujoco.MjData(self._model))

    def _stop_torque(self) -> np.ndarray:
        """What the ends of the joints' ranges add to the motors' torques (na,), N m."""
        data, torque = self._data, np.zeros(self.robot.na)
        limits = np.flatnonzero(data.efc_type == self._mujoco.mjtConstraint.mjCNSTR_LIMIT_JOINT)
        joints = data.efc_id[limits] - 1
        inwards = np.where(data.qpos[7 + joints] < self._middle[joints], 1.0, -1.0)
        torque[joints] = inwards * data.efc_force[limits]
        return torque

    @staticmethod
    def _origins(dynamics: Dynamics) -> np.ndarray:
        """Where wrenches are given about: sole origins, and the world origin for everything else (F + 1, 3), m."""
        return np.vstack([dynamics.sole_position, np.zeros(3)])


def _sinking(dynamics: Dynamics, velocity: np.ndarray, pressed: np.ndarray) -> float:
    """Largest normal speed of a pressed corner (K, 4) at velocities (nv,), m/s."""
    speed = 0.0
    for foot, *point in pressed:
        of_sole = dynamics.sole_jacobian[int(foot)] @ velocity
        speed = max(speed, abs(of_sole[2] + cross(of_sole[3:], point - dynamics.sole_position[int(foot)])[2]))
    return float(speed)


def check_level(ground: Ground) -> None:
    """Refuse ground that is not one level floor at rest; its friction may differ and change.

    Raises:
        InputError: a plate is tilted, higher than another, or moves.
    """
    planes = (ground.floor, *ground.under_feet)
    tilted = any((plane.rotation[:, 2] != (0.0, 0.0, 1.0)).any() for plane in planes)
    if tilted or ground.motions or len({float(plane.origin[2]) for plane in planes}) > 1:
        raise InputError("engine", "mujoco", "pinocchio, because the ground is tilted, moves or has a step")
