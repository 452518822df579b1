"""What a tick shows: the measured and derived quantities of one sample."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from momentum_lab.compiled import compiled
from momentum_lab.control.controller import ControlOutput
from momentum_lab.momentum.ground import GRAVITY, cmp_coordinates, cop_coordinates, sole_cop
from momentum_lab.momentum.pendulum import capture_point
from momentum_lab.momentum.wrench import sum_wrenches
from momentum_lab.physics.simulator import Step
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.rotation import quaternion_of
from momentum_lab.robot.state import Dynamics


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
        priority: from 0 to 1.
        fallen: whether the robot has fallen.
    """

    robot: RobotModel
    time: float
    timestep: float
    dynamics: Dynamics
    output: ControlOutput
    step: Step
    ground_height: float
    priority: float
    fallen: bool


def observe(row: np.ndarray, tick: Tick) -> None:
    """Write all quantities of a tick into a row (width,), in the order of `Layout.of`.

    CoP and CMP come from the measured ground wrench (Eqs. 21, 22), the equation residual is
    |A_G a + dA_G v - dh_measured| / (m g) with a = (v+ - v) / dt (Eq. 20).
    """
    dynamics, output, step = tick.dynamics, tick.output, tick.step
    poses, cop, cmp, foot_cops, residual = derived(
        dynamics.sole_position,
        dynamics.sole_rotation,
        dynamics.com_in_world,
        dynamics.centroidal_map,
        dynamics.centroidal_bias,
        dynamics.state.v,
        step.state.v,
        step.foot_wrench,
        step.other_wrench,
        step.momentum_rate,
        tick.ground_height,
        tick.timestep,
    )
    quantities = (
        tick.time,
        dynamics.state.q,
        dynamics.state.v,
        step.torque,
        step.stop_torque,
        dynamics.com_in_world,
        dynamics.com_velocity,
        dynamics.momentum,
        output.momentum_rate_desired,
        output.momentum_rate_admissible,
        step.momentum_rate,
        step.foot_wrench,
        output.foot_wrench_admissible,
        poses,
        cop,
        output.cop_admissible,
        output.cop_desired,
        cmp,
        capture_point(dynamics.com_in_world, dynamics.com_velocity, tick.ground_height),
        foot_cops,
        step.push_wrench,
        step.other_wrench,
        (
            tick.priority,
            residual / (tick.robot.mass * GRAVITY),
            step.contact_residual,
            output.failure is not None,
            tick.fallen,
        ),
    )
    np.concatenate(quantities, axis=None, out=row)


@compiled("f8[:, ::1](f8[:, ::1], f8[:, :, ::1])")
def sole_poses(position: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """Positions (F, 3) and quaternions xyzw of axes (F, 3, 3) as one array (F, 7)."""
    poses = np.empty((len(position), 7))
    for foot in range(len(position)):
        poses[foot, :3] = position[foot]
        poses[foot, 3:] = quaternion_of(rotation[foot])
    return poses


@compiled("f8[:, ::1](f8[:, ::1], f8[:, :, ::1])")
def sole_cops(foot_wrench: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """CoP of each foot in its sole frame (F, 2), m: see `sole_cop`; wrenches (F, 6) are in world axes."""
    cops = np.empty((len(foot_wrench), 2))
    for foot in range(len(foot_wrench)):
        local = foot_wrench[foot].copy().reshape(2, 3) @ rotation[foot]
        cops[foot] = sole_cop(local.ravel())
    return cops


@compiled("f8(f8[:, ::1], f8[::1], f8[::1], f8[::1], f8[::1], f8)")
def equation_residual(
    centroidal_map: np.ndarray,
    centroidal_bias: np.ndarray,
    before: np.ndarray,
    after: np.ndarray,
    measured: np.ndarray,
    timestep: float,
) -> float:
    """Largest entry of |A_G (v+ - v) / dt + dA_G v - dh_measured|, N or N m (Eq. 20).

    Args:
        centroidal_map: A_G (6, nv).
        centroidal_bias: dA_G v (6,).
        before: v (nv,).
        after: v+ (nv,).
        measured: dh_measured (6,).
        timestep: dt, s.
    """
    unexplained = centroidal_map @ ((after - before) / timestep) + centroidal_bias - measured
    return float(np.abs(unexplained).max())


@compiled(
    "Tuple((f8[:, ::1], f8[::1], f8[::1], f8[:, ::1], f8))(f8[:, ::1], f8[:, :, ::1], f8[::1], f8[:, ::1], f8[::1],"
    "f8[::1], f8[::1], f8[:, ::1], f8[::1], f8[::1], f8, f8)"
)
def derived(
    sole_position: np.ndarray,
    sole_rotation: np.ndarray,
    com: np.ndarray,
    centroidal_map: np.ndarray,
    centroidal_bias: np.ndarray,
    velocity: np.ndarray,
    next_velocity: np.ndarray,
    foot_wrench: np.ndarray,
    other_wrench: np.ndarray,
    momentum_rate: np.ndarray,
    ground_height: float,
    timestep: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, float]:
    """Sole poses (F, 7), net CoP (2,) and CMP (2,), foot CoPs (F, 2), residual of Eq. 20: all in one call.

    Shapes and units of the arguments are those of `Dynamics` and `Step`.
    """
    contact = sum_wrenches(foot_wrench, sole_position, np.zeros(3)) + other_wrench
    return (
        sole_poses(sole_position, sole_rotation),
        np.array(cop_coordinates(contact, np.zeros(3), ground_height)),
        np.array(cmp_coordinates(contact[:3], com, ground_height)),
        sole_cops(foot_wrench, sole_rotation),
        equation_residual(centroidal_map, centroidal_bias, velocity, next_velocity, momentum_rate, timestep),
    )
