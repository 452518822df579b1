"""The linear inverted pendulum: how the CoM falls away from the CMP, and how much push can be caught.

With the CoM at a constant height z_c the chapter's Eqs. 1 and 2 reduce to d2r/dt2 = omega^2 (r - s): the CoM
is repelled by the CMP s, which is the CoP while the angular momentum is constant. The rate omega comes from
`pendulum_frequency`.
"""

from __future__ import annotations

import math

import numpy as np

from momentum_lab.compiled import compiled
from momentum_lab.errors import InputError
from momentum_lab.momentum.ground import GRAVITY


@compiled("f8(f8)")
def pendulum_frequency(com_height: float) -> float:
    """The rate at which a linear inverted pendulum falls.

    omega = sqrt(g / z_c).

    Args:
        com_height: z_c, of the CoM above the ground, m.

    Returns:
        omega, 1/s; NaN unless the CoM is above the ground.
    """
    return math.sqrt(GRAVITY / com_height) if com_height > 0.0 else math.nan


def capture_point(
    com_in_world: np.ndarray, com_velocity: np.ndarray, ground_height: float = 0.0
) -> np.ndarray:
    """Where the CMP has to be at once for the CoM to come to rest above it (also: DCM).

    xi = r + dr/dt / omega, omega = sqrt(g / (r_z - z_0)) (Pratt et al. 2006).

    Args:
        com_in_world: r_G (3,), m.
        com_velocity: dr_G/dt (3,), m/s.
        ground_height: z_0, m.

    Returns:
        (xi_x, xi_y) in the world (2,), m; NaN with the CoM below the ground.
    """
    return np.array(capture_coordinates(com_in_world, com_velocity, ground_height))


@compiled("UniTuple(f8, 2)(f8[:], f8[:], f8)")
def capture_coordinates(
    com_in_world: np.ndarray, com_velocity: np.ndarray, ground_height: float
) -> tuple[float, float]:
    """See `capture_point`."""
    rx, ry, rz = com_in_world
    vx, vy, _ = com_velocity
    omega = pendulum_frequency(rz - ground_height)
    return rx + vx / omega, ry + vy / omega


def predict_dcm(dcm: np.ndarray, cmp: np.ndarray, omega: float, duration: float) -> np.ndarray:
    """Where the capture point (DCM) is after a while with the CMP held still.

    xi(t) = s + (xi_0 - s) exp(omega t), from dxi/dt = omega (xi - s): the CMP drives it away.

    Args:
        dcm: xi_0 (2,), m.
        cmp: s, equal to the CoP while the angular momentum is constant (2,), m.
        omega: 1/s.
        duration: t, s.

    Returns:
        xi(t) (2,), m.
    """
    return cmp + (dcm - cmp) * math.exp(omega * duration)


def orbital_energy(
    com_in_world: np.ndarray, com_velocity: np.ndarray, cop_in_world: np.ndarray, omega: float
) -> np.ndarray:
    """The energy of the linear inverted pendulum per mass, one number per horizontal axis.

    E = 1/2 (dr/dt)^2 - 1/2 omega^2 (r - p)^2: constant while p stays; the CoM moving towards p passes over it
    if E > 0, turns back if E < 0, and comes to rest above it if E = 0.

    Args:
        com_in_world: r_G (3,), m.
        com_velocity: dr_G/dt (3,), m/s.
        cop_in_world: p (2,), m.
        omega: 1/s.

    Returns:
        (E_x, E_y) (2,), m^2/s^2.
    """
    rx, ry, _ = com_in_world.tolist()
    vx, vy, _ = com_velocity.tolist()
    px, py = cop_in_world.tolist()
    stiffness = omega * omega
    x, y = rx - px, ry - py
    return np.array((0.5 * (vx * vx - stiffness * x * x), 0.5 * (vy * vy - stiffness * y * y)))


def flywheel_reach(torque: float, duration: float, omega: float, mass: float) -> float:
    """How much farther than the CoP the capture point may be if the body spins up and stops again.

    Delta = tau / (m g) (1 - exp(-omega T))^2, for a torque tau during T and -tau during the next T (Pratt et
    al. 2006). For a short lurch through an angle theta = tau T^2 / I it tends to I theta / (m z_c).

    Args:
        torque: tau, N m.
        duration: T, of each half, s.
        omega: 1/s.
        mass: m, kg.

    Returns:
        Delta, m.
    """
    fraction = -math.expm1(-omega * duration)
    return torque / (mass * GRAVITY) * fraction * fraction


def pendulum_impulse_bound(mass: float, omega: float, distance: float, duration: float) -> float:
    """The largest push that a linear inverted pendulum survives with its CoP alone, without a step.

    J = m omega delta * omega T / (1 - exp(-omega T)); m omega delta for an instantaneous push. The CoP goes
    to the edge at once, the force is constant during T, and the capture point ends on the edge.

    Args:
        mass: m, kg.
        omega: sqrt(g / z_c), 1/s.
        distance: delta, from the CoM's ground projection to the edge along the push, m.
        duration: T, s.

    Returns:
        J, N s.

    Raises:
        InputError: the duration is negative or not a number.
    """
    if not duration >= 0.0:
        raise InputError("duration", duration, "0 s or more")
    instantaneous = mass * omega * distance
    phase = omega * duration
    return instantaneous * phase / -math.expm1(-phase) if phase > 0.0 else instantaneous
