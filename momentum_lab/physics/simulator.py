"""From one state to the next: gravity, torques, pushes, joint limits and contact in one step."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.momentum.wrench import shift_wrench, sum_wrenches
from momentum_lab.physics.contact import Contacts, solve_contact
from momentum_lab.physics.ground import Ground
from momentum_lab.physics.joint_stops import JointStops, joint_stops
from momentum_lab.physics.push import AppliedPush, Push, apply_pushes
from momentum_lab.physics.touch import BodyPoints, Touch, sole_touches
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics, State

_WORLD_ORIGIN = np.zeros(3)


@dataclass(frozen=True, slots=True)
class Step:
    """What happened during one step.

    Attributes:
        state: the state at its end.
        torque: joint torques after the motors' limits (na,), N m.
        stop_torque: what the ends of the joints' ranges add to them (na,), N m.
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
        ground: what it stands on.
        timestep: length of a step, s.
    """

    def __init__(self, robot: RobotModel, ground: Ground, timestep: float) -> None:
        self.robot = robot
        self.ground = ground
        self.timestep = timestep
        self._least_torque = -robot.effort_limit
        self._bodies = BodyPoints(robot, timestep)
        self._push_data = robot.model.createData()

    def step(self, dynamics: Dynamics, torque: np.ndarray, pushes: tuple[Push, ...], time: float) -> Step:
        """The step from `dynamics.state` at `time` under joint torques (na,) and the pushes of the run.

        H (v+ - v) = dt (S tau + J_b^T w_push - C v - tau_g) + J_c^T lambda, q+ = q (+) dt v+ (semi-implicit).

        Raises:
            SimulationError: the state is not finite any more.
        """
        torque = np.minimum(np.maximum(torque, self._least_torque), self.robot.effort_limit)
        push = apply_pushes(self.robot, self._push_data, dynamics, pushes, time, self.timestep)
        stops = joint_stops(self.robot, dynamics, self.timestep)
        mass_matrix, force = _free_motion(dynamics, torque, push, stops)
        touching = sole_touches(self.robot, dynamics, self.ground)
        touching += self._bodies.touches(dynamics.state, self.ground.floor)
        solution = solve_contact(
            mass_matrix,
            self.timestep * force,
            dynamics.state.v,
            _together(touching, self.robot.nv),
            self.timestep,
        )
        q = self.robot.integrate(dynamics.state.q, self.timestep * solution.velocity)
        state = State(q, solution.velocity)
        self._bodies.follow(state)
        feet, others = self._contact_wrenches(touching, solution.frame_impulse / self.timestep)
        pushed = np.zeros(6) if push is None else push.wrench
        rate = sum_wrenches(feet, dynamics.sole_position, dynamics.com_in_world)
        rate += shift_wrench(others + pushed, _WORLD_ORIGIN, dynamics.com_in_world)
        rate[2] -= self.robot.mass * GRAVITY
        return Step(
            state=state,
            torque=torque,
            stop_torque=self._stop_torque(dynamics, state, stops),
            foot_wrench=feet,
            other_wrench=others,
            push_wrench=pushed,
            momentum_rate=rate,
            contact_residual=solution.residual,
        )

    def _stop_torque(self, dynamics: Dynamics, state: State, stops: JointStops | None) -> np.ndarray:
        if stops is None:
            return np.zeros(self.robot.na)
        return stops.felt_torque((state.v - dynamics.state.v) / self.timestep)

    def _contact_wrenches(self, touching: list[Touch], wrenches: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Ground on each foot about its sole (F, 6), and on all else about the world origin (6,).

        `wrenches` (B, 6) are those on the touching bodies in their order, about the origins of their frames.
        """
        feet, others = np.zeros((len(self.robot.soles), 6)), np.zeros(6)
        for touch, wrench in zip(touching, wrenches, strict=True):
            if touch.foot is None:
                others += shift_wrench(wrench, touch.origin, _WORLD_ORIGIN)
            else:
                feet[touch.foot] = wrench
        return feet, others


def _free_motion(
    dynamics: Dynamics, torque: np.ndarray, push: AppliedPush | None, stops: JointStops | None
) -> tuple[np.ndarray, np.ndarray]:
    """Mass matrix (nv, nv) and force (nv,) of the robot without contact."""
    force = -dynamics.nonlinear_effects
    force[6:] += torque
    if push is not None:
        force += push.generalized
    if stops is None:
        return dynamics.mass_matrix, force
    mass_matrix = dynamics.mass_matrix.copy()
    mass_matrix[stops.rows, stops.rows] += stops.added_inertia
    force[stops.rows] += stops.torque
    return mass_matrix, force


def _together(touching: list[Touch], nv: int) -> Contacts:
    """All points that may touch as one problem."""
    if not touching:
        return Contacts(np.zeros((0, nv)), np.zeros((0, 0)), np.zeros(0), ())
    gap = np.concatenate([touch.gap for touch in touching])
    spread = np.zeros((3 * gap.size, 6 * len(touching)))
    friction: tuple[float, ...] = ()
    for body, touch in enumerate(touching):
        row = 3 * len(friction)
        friction += (touch.patch.friction,) * touch.gap.size
        spread[row : 3 * len(friction), 6 * body : 6 * body + 6] = touch.spread
    return Contacts(
        frame_jacobian=np.concatenate([touch.frame_jacobian for touch in touching]),
        spread=spread,
        gap=gap,
        friction=friction,
    )
