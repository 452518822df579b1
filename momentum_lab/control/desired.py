"""Which momentum rates balance asks for."""

from __future__ import annotations

import numpy as np

from momentum_lab.compiled import compiled
from momentum_lab.control.controller import Reference
from momentum_lab.robot.rotation import rotation_error
from momentum_lab.robot.state import Dynamics


def desired_linear_rate(
    mass: float, dynamics: Dynamics, reference: Reference, damping: float, stiffness: float
) -> np.ndarray:
    """The linear momentum rate that brings the CoM to its reference.

    Eq. 38: dl_d/dt = m [ddr_d + Gamma_21 (dr_d - dr) + Gamma_22 (r_d - r)], with the acceleration of a goal that
    moves with the ground, which the chapter leaves out.

    Args:
        mass: total mass m, kg.
        dynamics: the state with everything computed.
        reference: holds r_d, m, dr_d, m/s, and ddr_d, m/s^2.
        damping: Gamma_21, 1/s, the same in all directions.
        stiffness: Gamma_22, 1/s^2, the same in all directions.

    Returns:
        The rate (3,), N.
    """
    return _linear_rate(
        mass,
        reference.com_acceleration,
        reference.com_velocity,
        dynamics.com_velocity,
        reference.com,
        dynamics.com_in_world,
        damping,
        stiffness,
    )


def desired_angular_rate(
    dynamics: Dynamics, reference: Reference, damping: float, pelvis_stiffness: float
) -> np.ndarray:
    """The angular momentum rate that damps angular momentum and brings the pelvis upright.

    Eq. 37: dk_d/dt = Gamma_11 (k_d - k), and an extension that the chapter does not have: - K_theta I_G e_R
    with e_R = log(R R_d^T). There is no angular position to feed back, so without that term the pelvis
    drifts wherever the motion of the CoM turns it.

    Args:
        dynamics: the state with everything computed.
        reference: holds k_d, N m s, and the desired pelvis axes R_d.
        damping: Gamma_11, 1/s.
        pelvis_stiffness: K_theta, 1/s^2; 0 gives the chapter's law.

    Returns:
        The rate (3,), N m.
    """
    return _angular_rate(
        dynamics.momentum,
        reference.angular_momentum,
        dynamics.locked_inertia,
        dynamics.pelvis_rotation,
        reference.pelvis_rotation,
        damping,
        pelvis_stiffness,
    )


def desired_momentum_rate(
    mass: float,
    dynamics: Dynamics,
    reference: Reference,
    linear_damping: float,
    linear_stiffness: float,
    angular_damping: float,
    pelvis_stiffness: float,
) -> np.ndarray:
    """[dl_d/dt; dk_d/dt] (6,), N and N m: `desired_linear_rate` and `desired_angular_rate` in one call.

    Args:
        mass: total mass m, kg.
        dynamics: the state with everything computed.
        reference: what the robot shall do.
        linear_damping: Gamma_21, 1/s.
        linear_stiffness: Gamma_22, 1/s^2.
        angular_damping: Gamma_11, 1/s.
        pelvis_stiffness: K_theta, 1/s^2.
    """
    return _momentum_rate(
        mass,
        reference.com_acceleration,
        reference.com_velocity,
        dynamics.com_velocity,
        reference.com,
        dynamics.com_in_world,
        linear_damping,
        linear_stiffness,
        dynamics.momentum,
        reference.angular_momentum,
        dynamics.locked_inertia,
        dynamics.pelvis_rotation,
        reference.pelvis_rotation,
        angular_damping,
        pelvis_stiffness,
    )


@compiled("f8[::1](f8, f8[::1], f8[::1], f8[::1], f8[::1], f8[::1], f8, f8)")
def _linear_rate(
    mass: float,
    desired_acceleration: np.ndarray,
    desired_velocity: np.ndarray,
    velocity: np.ndarray,
    desired: np.ndarray,
    com: np.ndarray,
    damping: float,
    stiffness: float,
) -> np.ndarray:
    pulled = damping * (desired_velocity - velocity) + stiffness * (desired - com)
    return mass * (desired_acceleration + pulled)


@compiled("f8[::1](f8[::1], f8[::1], f8[:, :], f8[:, :], f8[:, :], f8, f8)")
def _angular_rate(
    momentum: np.ndarray,
    desired: np.ndarray,
    locked_inertia: np.ndarray,
    pelvis: np.ndarray,
    desired_pelvis: np.ndarray,
    damping: float,
    stiffness: float,
) -> np.ndarray:
    tilt = rotation_error(pelvis, desired_pelvis)
    rate = damping * (desired - momentum[3:])
    for i in range(3):
        for k in range(3):
            rate[i] -= stiffness * locked_inertia[i, k] * tilt[k]
    return rate


@compiled(
    "f8[::1](f8, f8[::1], f8[::1], f8[::1], f8[::1], f8[::1], f8, f8, f8[::1], f8[::1], "
    "f8[:, :], f8[:, :], f8[:, :], f8, f8)"
)
def _momentum_rate(
    mass: float,
    desired_acceleration: np.ndarray,
    desired_velocity: np.ndarray,
    velocity: np.ndarray,
    desired: np.ndarray,
    com: np.ndarray,
    linear_damping: float,
    linear_stiffness: float,
    momentum: np.ndarray,
    desired_momentum: np.ndarray,
    locked_inertia: np.ndarray,
    pelvis: np.ndarray,
    desired_pelvis: np.ndarray,
    angular_damping: float,
    pelvis_stiffness: float,
) -> np.ndarray:
    rate = np.empty(6)
    rate[:3] = _linear_rate(
        mass, desired_acceleration, desired_velocity, velocity, desired, com, linear_damping, linear_stiffness
    )
    rate[3:] = _angular_rate(
        momentum, desired_momentum, locked_inertia, pelvis, desired_pelvis, angular_damping, pelvis_stiffness
    )
    return rate
