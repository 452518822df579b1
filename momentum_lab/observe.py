"""What a tick shows: the measured and derived quantities of one sample."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from momentum_lab.compiled import compiled
from momentum_lab.control.controller import SLACKS, ControlOutput
from momentum_lab.momentum.foot_ground import FootGround
from momentum_lab.momentum.ground import GRAVITY, cmp_coordinates, cop_coordinates, sole_cop
from momentum_lab.momentum.pendulum import capture_coordinates
from momentum_lab.momentum.wrench import sum_wrenches
from momentum_lab.physics.simulator import Step
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.rotation import quaternion_of
from momentum_lab.robot.state import Dynamics

_MATRIX, _VECTOR = "f8[:, ::1]", "f8[::1]"
_NO_SLACK = np.zeros(len(SLACKS))


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
        ground: the plates under the feet at its start; net CoP, CMP and capture point lie at their mean height.
        priority: from 0 to 1.
        fallen: whether the robot has fallen.
    """

    robot: RobotModel
    time: float
    timestep: float
    dynamics: Dynamics
    output: ControlOutput
    step: Step
    ground: FootGround
    priority: float
    fallen: bool


def observe(row: np.ndarray, tick: Tick) -> None:
    """Write all quantities of a tick into a row (width,), in the order of `Layout.of`.

    CoP and CMP come from the measured ground wrench (Eqs. 21, 22), the equation residual is
    |A_G a + dA_G v - dh_measured| / (m g) with a = (v+ - v) / dt (Eq. 20).
    """
    dynamics, output, step = tick.dynamics, tick.output, tick.step
    fill(
        row,
        dynamics.state.q,
        dynamics.state.v,
        dynamics.com_in_world,
        dynamics.com_velocity,
        dynamics.momentum,
        dynamics.centroidal_map,
        dynamics.centroidal_bias,
        dynamics.sole_position,
        dynamics.sole_rotation,
        tick.ground.position,
        tick.ground.rotation,
        output.momentum_rate_desired,
        output.momentum_rate_admissible,
        output.foot_wrench_admissible,
        output.cop_desired,
        output.cop_admissible,
        step.state.v,
        step.torque,
        step.stop_torque,
        step.foot_wrench,
        step.other_wrench,
        step.push_wrench,
        step.momentum_rate,
        step.contact_residual,
        slack_of(output),
        output.torque,
        tick.robot.effort_limit,
        tick.time,
        tick.timestep,
        tick.ground.height,
        tick.robot.mass * GRAVITY,
        tick.priority,
        output.failure is not None,
        tick.fallen,
    )


def slack_of(output: ControlOutput) -> np.ndarray:
    """The slacks of an answer in the order of `SLACKS`; 0 where it has none."""
    if not output.slack:
        return _NO_SLACK
    return np.array([output.slack.get(name, 0.0) for name in SLACKS])


@compiled("f8(f8[::1], f8[::1])")
def torque_ratio(torque: np.ndarray, limit: np.ndarray) -> float:
    """Largest |tau_j| / tau_max,j over all joints (na,)."""
    largest = 0.0
    for j in range(len(torque)):
        largest = max(largest, abs(torque[j]) / limit[j])
    return largest


@compiled("f8[:, ::1](f8[:, ::1], f8[:, :, ::1])")
def sole_poses(position: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """Positions (F, 3) and quaternions xyzw of axes (F, 3, 3), of soles or plates, as one array (F, 7)."""
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


@compiled("i8(f8[::1], i8, f8[:])")
def put(row: np.ndarray, start: int, numbers: np.ndarray) -> int:
    """Write numbers into a row from a place on, if they fit in; the place behind them."""
    end = start + numbers.size
    if end > row.size:
        raise ValueError("the quantities of a tick do not fill a row")
    row[start:end] = numbers
    return end


@compiled(
    # the row, then what comes from the dynamics, the output, the step, and the tick itself
    f"void({_VECTOR}, {_VECTOR}, {_VECTOR}, {_VECTOR}, {_VECTOR}, {_VECTOR}, {_MATRIX}, {_VECTOR}, {_MATRIX}, "
    f"f8[:, :, ::1], {_MATRIX}, f8[:, :, ::1], {_VECTOR}, {_VECTOR}, {_MATRIX}, {_VECTOR}, {_VECTOR}, {_VECTOR}, "
    f"{_VECTOR}, {_VECTOR}, "
    f"{_MATRIX}, {_VECTOR}, {_VECTOR}, {_VECTOR}, f8, {_VECTOR}, {_VECTOR}, {_VECTOR}, "
    f"f8, f8, f8, f8, f8, b1, b1)"
)
def fill(
    row: np.ndarray,
    q: np.ndarray,
    v: np.ndarray,
    com: np.ndarray,
    com_velocity: np.ndarray,
    momentum: np.ndarray,
    centroidal_map: np.ndarray,
    centroidal_bias: np.ndarray,
    sole_position: np.ndarray,
    sole_rotation: np.ndarray,
    plate_position: np.ndarray,
    plate_rotation: np.ndarray,
    rate_desired: np.ndarray,
    rate_admissible: np.ndarray,
    wrench_admissible: np.ndarray,
    cop_desired: np.ndarray,
    cop_admissible: np.ndarray,
    next_velocity: np.ndarray,
    torque: np.ndarray,
    stop_torque: np.ndarray,
    foot_wrench: np.ndarray,
    other_wrench: np.ndarray,
    push_wrench: np.ndarray,
    momentum_rate: np.ndarray,
    contact_residual: float,
    slack: np.ndarray,
    torque_demanded: np.ndarray,
    effort_limit: np.ndarray,
    time: float,
    timestep: float,
    ground_height: float,
    weight: float,
    priority: float,
    failed: bool,
    fallen: bool,
) -> None:
    """Derive what is not given and write all quantities into a row (width,), in the order of `Layout.of`.

    Shapes and units of the arguments are those of `Dynamics`, `ControlOutput`, `Step` and `Tick`; the weight is
    m g, N.
    """
    world = np.zeros(3)
    contact = sum_wrenches(foot_wrench, sole_position, world) + other_wrench
    residual = equation_residual(centroidal_map, centroidal_bias, v, next_velocity, momentum_rate, timestep)
    row[0] = time
    end = put(row, 1, q)
    end = put(row, end, v)
    end = put(row, end, torque)
    end = put(row, end, stop_torque)
    end = put(row, end, com)
    end = put(row, end, com_velocity)
    end = put(row, end, momentum)
    end = put(row, end, rate_desired)
    end = put(row, end, rate_admissible)
    end = put(row, end, momentum_rate)
    end = put(row, end, foot_wrench.ravel())
    end = put(row, end, wrench_admissible.ravel())
    end = put(row, end, sole_poses(sole_position, sole_rotation).ravel())
    end = put(row, end, sole_poses(plate_position, plate_rotation).ravel())
    end = put(row, end, np.array(cop_coordinates(contact, world, ground_height)))
    end = put(row, end, cop_admissible)
    end = put(row, end, cop_desired)
    end = put(row, end, np.array(cmp_coordinates(contact[:3], com, ground_height)))
    end = put(row, end, np.array(capture_coordinates(com, com_velocity, ground_height)))
    end = put(row, end, sole_cops(foot_wrench, sole_rotation).ravel())
    end = put(row, end, push_wrench)
    end = put(row, end, other_wrench)
    end = put(row, end, slack)
    numbers = (
        torque_ratio(torque_demanded, effort_limit),
        priority,
        residual / weight,
        contact_residual,
        1.0 * failed,
        1.0 * fallen,
    )
    end = put(row, end, np.array(numbers))
    if end != row.size:
        raise ValueError("the quantities of a tick do not fill a row")
