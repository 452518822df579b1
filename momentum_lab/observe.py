"""What a tick shows: the measured and derived quantities of one sample."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from momentum_lab.control.controller import ControlOutput
from momentum_lab.momentum.ground import GRAVITY, cmp_from_force, cop_from_wrench, sole_cop
from momentum_lab.momentum.pendulum import capture_point
from momentum_lab.momentum.wrench import sum_wrenches, wrench_in_frame_axes
from momentum_lab.physics.simulator import Step
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics

_WORLD_ORIGIN = np.zeros(3)


@dataclass(frozen=True, slots=True)
class Tick:
    """Everything that one tick has produced.

    Attributes:
        robot: the robot.
        time: simulated time at the start of the tick, s.
        timestep: its length, s.
        dynamics: the state at its start with everything computed.
        output: what the controller answered.
        step: what the world answered.
        ground_height: height of the plane that CoP, CMP and capture point lie on, m.
    """

    robot: RobotModel
    time: float
    timestep: float
    dynamics: Dynamics
    output: ControlOutput
    step: Step
    ground_height: float


def observe(row: np.ndarray, at: dict[str, slice], tick: Tick) -> None:
    """Write all quantities of a tick into a row (width,), `at` says where.

    CoP and CMP come from the measured ground wrench (Eqs. 21, 22), the equation residual is
    |A_G a + dA_G v - dh_measured| / (m g) with a = (v+ - v) / dt (Eq. 20).
    """
    dynamics, output, step = tick.dynamics, tick.output, tick.step
    contact = sum_wrenches(step.foot_wrench, dynamics.sole_position, _WORLD_ORIGIN) + step.other_wrench
    height = tick.ground_height
    row[at["time"]] = tick.time
    row[at["q"]] = dynamics.state.q
    row[at["v"]] = dynamics.state.v
    row[at["torque"]] = step.torque
    row[at["joint_stop_torque"]] = step.stop_torque
    row[at["com"]] = dynamics.com_in_world
    row[at["com_velocity"]] = dynamics.com_velocity
    row[at["momentum"]] = dynamics.momentum
    row[at["momentum_rate_desired"]] = output.momentum_rate_desired
    row[at["momentum_rate_admissible"]] = output.momentum_rate_admissible
    row[at["momentum_rate_measured"]] = step.momentum_rate
    row[at["foot_wrench_measured"]] = step.foot_wrench.ravel()
    row[at["foot_wrench_admissible"]] = output.foot_wrench_admissible.ravel()
    row[at["sole_pose"]] = _poses(dynamics).ravel()
    row[at["cop_measured"]] = cop_from_wrench(contact, _WORLD_ORIGIN, height)
    row[at["cop_admissible"]] = output.cop_admissible
    row[at["cop_desired"]] = output.cop_desired
    row[at["cmp"]] = cmp_from_force(contact[:3], dynamics.com_in_world, height)
    row[at["capture_point"]] = capture_point(dynamics.com_in_world, dynamics.com_velocity, height)
    row[at["foot_cop_measured"]] = _foot_cops(dynamics, step.foot_wrench).ravel()
    row[at["push_wrench"]] = step.push_wrench
    row[at["other_contact_wrench"]] = step.other_wrench
    row[at["equation_residual"]] = _equation_residual(tick)
    row[at["contact_residual"]] = step.contact_residual
    row[at["solver_failed"]] = output.failure is not None


def _poses(dynamics: Dynamics) -> np.ndarray:
    """Position and quaternion xyzw of each sole (F, 7)."""
    return np.array(
        [
            (*position, *pin.Quaternion(rotation).coeffs())
            for position, rotation in zip(dynamics.sole_position, dynamics.sole_rotation, strict=True)
        ]
    )


def _foot_cops(dynamics: Dynamics, foot_wrench: np.ndarray) -> np.ndarray:
    """CoP of each foot in its sole frame (F, 2)."""
    return np.array(
        [
            sole_cop(wrench_in_frame_axes(wrench, rotation))
            for wrench, rotation in zip(foot_wrench, dynamics.sole_rotation, strict=True)
        ]
    )


def _equation_residual(tick: Tick) -> float:
    dynamics = tick.dynamics
    acceleration = (tick.step.state.v - dynamics.state.v) / tick.timestep
    rate = dynamics.centroidal_map @ acceleration + dynamics.centroidal_bias
    return float(np.abs(rate - tick.step.momentum_rate).max()) / (tick.robot.mass * GRAVITY)
