"""From one state to the next: gravity, torques, pushes, joint limits and contact in one step."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from momentum_lab.compiled import compiled
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.momentum.wrench import shift_wrench, sum_wrenches
from momentum_lab.physics.body_touch import BodyPoints
from momentum_lab.physics.contact import ContactSolution, solve_contact, solve_lying
from momentum_lab.physics.ground import Ground
from momentum_lab.physics.implicit_torque import ImplicitTorque
from momentum_lab.physics.joint_friction import joint_friction
from momentum_lab.physics.joint_stops import joint_stops
from momentum_lab.physics.push import Push, apply_pushes
from momentum_lab.physics.touch import SolePoints, Touches, near_points, together
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics, State


@dataclass(frozen=True, slots=True)
class Step:
    """What happened during one step.

    Attributes:
        state: the state at its end.
        torque: joint torques after the motors' limits (na,), N m.
        stop_torque: what friction and the ends of the joints' ranges add to them (na,), N m.
        foot_wrench: ground on each foot about the sole origin, world axes (F, 6), N and N m.
        other_wrench: ground on everything that is not a sole, about the world origin (6,), N and N m.
        push_wrench: pushes on the robot about the world origin (6,), N and N m.
        momentum_rate: sum of all external wrenches about the CoM at the start of the step (6,), N and N m.
        contact_residual: how far the step is from the laws of contact, m/s and N s.
    """

    state: State
    torque: np.ndarray
    stop_torque: np.ndarray
    foot_wrench: np.ndarray
    other_wrench: np.ndarray
    push_wrench: np.ndarray
    momentum_rate: np.ndarray
    contact_residual: float


class Simulator:
    """The world of one robot.

    Args:
        robot: the robot.
        ground: what it stands on; it may be exchanged between two steps for one that is not higher.
        timestep: length of a step, s.
    """

    def __init__(self, robot: RobotModel, ground: Ground, timestep: float) -> None:
        self.robot = robot
        self.ground = ground
        self.timestep = timestep
        self._weight = robot.mass * GRAVITY
        self._soles = SolePoints(robot, timestep)
        self._bodies = BodyPoints(robot, timestep)
        self._push_data = robot.model.createData()
        self._rubbing = bool(robot.joint_friction.any())

    def step(self, dynamics: Dynamics, torque: np.ndarray, pushes: tuple[Push, ...], time: float) -> Step:
        """The step from `dynamics.state` at `time` under joint torques (na,) and the pushes of the run.

        H (v+ - v) = dt (S tau + J_b^T w_push - C v - tau_g) + J_c^T lambda, q+ = q (+) dt v+ (semi-implicit).

        Raises:
            SimulationError: the state is not finite any more.
        """
        torque, force = driven(torque, self.robot.effort_limit, dynamics.nonlinear_effects)
        push = apply_pushes(self.robot, self._push_data, dynamics, pushes, time, self.timestep)
        if push is not None:
            force += push.generalized
        passive = self._passive(dynamics)
        mass_matrix = _braked(dynamics.mass_matrix, force, passive) if passive else dynamics.mass_matrix
        touches, solve = self._touches(dynamics, time)
        solution = solve(
            mass_matrix, self.timestep * force, dynamics.state.v, touches.contacts, self.timestep
        )
        q = self.robot.integrate(dynamics.state.q, self.timestep * solution.velocity)
        state = State(q, solution.velocity)
        self._bodies.follow(state)
        pushed = np.zeros(6) if push is None else push.wrench
        feet, others, rate = external_wrenches(
            solution.frame_impulse,
            self.timestep,
            touches.foot,
            touches.origin,
            pushed,
            dynamics.sole_position,
            dynamics.com_in_world,
            self._weight,
        )
        return Step(
            state=state,
            torque=torque,
            stop_torque=self._stop_torque(dynamics, state, passive),
            foot_wrench=feet,
            other_wrench=others,
            push_wrench=pushed,
            momentum_rate=rate,
            contact_residual=solution.residual,
        )

    def _touches(self, dynamics: Dynamics, time: float) -> tuple[Touches, Callable[..., ContactSolution]]:
        """All points that may touch, soles and other bodies in a fall, and what solves for them."""
        soles = self._soles.touches(dynamics, self.ground, time)
        bodies = self._bodies.touches(dynamics.state, self.ground.floor)
        if bodies is None:
            return soles, solve_contact
        return together(near_points(soles), bodies), solve_lying

    def _passive(self, dynamics: Dynamics) -> list[ImplicitTorque]:
        """What joints do of themselves: their stops, and their friction if they have any."""
        stops = joint_stops(self.robot, dynamics, self.timestep)
        passive = [] if stops is None else [stops]
        if self._rubbing:
            passive.append(joint_friction(self.robot.joint_friction, dynamics, self.timestep))
        return passive

    def _stop_torque(self, dynamics: Dynamics, state: State, passive: list[ImplicitTorque]) -> np.ndarray:
        felt = np.zeros(self.robot.na)
        for torque in passive:
            felt += torque.felt_torque((state.v - dynamics.state.v) / self.timestep)
        return felt


def _braked(mass_matrix: np.ndarray, force: np.ndarray, passive: list[ImplicitTorque]) -> np.ndarray:
    """Mass matrix (nv, nv) with implicit torques of the joints; the force (nv,) is given theirs, too."""
    mass_matrix = mass_matrix.copy()
    for torque in passive:
        mass_matrix[torque.rows, torque.rows] += torque.added_inertia
        force[torque.rows] += torque.torque
    return mass_matrix


@compiled("UniTuple(f8[::1], 2)(f8[::1], f8[::1], f8[::1])")
def driven(
    torque: np.ndarray, effort_limit: np.ndarray, nonlinear_effects: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Torques within the motors' limits (na,), and with gravity and velocities the force S tau - C v - tau_g (nv,).

    Args:
        torque: asked for (na,), N m.
        effort_limit: tau_max (na,), N m.
        nonlinear_effects: C v + tau_g (nv,), N and N m.
    """
    if torque.size != effort_limit.size:
        raise ValueError("a controller has to answer with one torque per joint")
    given, force = torque.copy(), -nonlinear_effects
    for joint in range(torque.size):
        limit = effort_limit[joint]
        if abs(torque[joint]) > limit:
            given[joint] = math.copysign(limit, torque[joint])
        force[6 + joint] += given[joint]
    return given, force


@compiled(
    "Tuple((f8[:, ::1], f8[::1], f8[::1]))"
    "(f8[:, ::1], f8, i8[::1], f8[:, ::1], f8[::1], f8[:, ::1], f8[::1], f8)"
)
def external_wrenches(
    frame_impulse: np.ndarray,
    timestep: float,
    foot: np.ndarray,
    origin: np.ndarray,
    pushed: np.ndarray,
    sole_position: np.ndarray,
    com: np.ndarray,
    weight: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """What acts on the robot from outside, and the momentum rate it causes (Eqs. 1, 2).

    Args:
        frame_impulse: of the ground on the touching bodies about the origins of their frames (B, 6).
        timestep: dt, s.
        foot: which foot each of them is; -1 for other bodies (B,).
        origin: origins of their frames (B, 3), m.
        pushed: wrench of the pushes about the world origin (6,), N and N m.
        sole_position: sole origins (F, 3), m.
        com: r_G (3,), m.
        weight: m g, N.

    Returns:
        Ground on each foot about its sole origin (F, 6), on all else about the world origin (6,), and
        [dl/dt; dk/dt] about the CoM (6,), N and N m.
    """
    feet, others, world = np.zeros((len(sole_position), 6)), np.zeros(6), np.zeros(3)
    for body in range(len(foot)):
        wrench = frame_impulse[body] / timestep
        if foot[body] < 0:
            others += shift_wrench(wrench, origin[body], world)
        else:
            feet[foot[body]] = wrench
    rate = sum_wrenches(feet, sole_position, com) + shift_wrench(others + pushed, world, com)
    rate[2] -= weight
    return feet, others, rate
