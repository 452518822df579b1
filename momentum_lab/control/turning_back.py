"""When linear momentum has been kept for long enough: the body has to stop turning before its joints end.

With priority 0 the missing moment of Fig. 7 (left) turns the body for as long as the law of the CoM asks for more
than the CoP can give. That is longer than balance needs, and legs, waist and ankles let the body turn only so far.
Angular momentum can be brought back as soon as what that costs leaves the capture point inside the feet.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from momentum_lab.compiled import compiled
from momentum_lab.control.controller import Reference
from momentum_lab.control.footing import StanceFeet
from momentum_lab.control.planner import OWN
from momentum_lab.control.priority import Compromise, compromise
from momentum_lab.momentum.directions import ALL
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.momentum.pendulum import capture_coordinates, pendulum_frequency
from momentum_lab.momentum.polygon import depth
from momentum_lab.robot.rotation import rotation_error
from momentum_lab.robot.state import Dynamics

# A body that will have turned so far sideways, rad, begins to need its angular momentum back, and then needs
# nothing more urgently: TALOS' hips end at 0.4, G1's ankles before 0.6.
# Sideways TALOS then stands 1.09 times what its CoP can catch; with 0.4/0.7 1.08, with 0.8/1.1 1.05.
_LITTLE_ROOM, _NO_ROOM = 0.25, 0.45
# Legs fold forward and backward, where bodies turn by 0.7 and stand: such a turn counts this part of one sideways.
# At 0.4 it already cut into the linear momentum that Fig. 7 (left) keeps.
_PITCH = 0.25
# Braking begins this far before its cost is covered, m: within so long the capture point still moves inward.
# With 0.02 TALOS stands 1.09 and not 1.10 times what its CoP can catch.
_EARLY = 0.03
# Damping that is switched off does not make the turn endless, 1/s.
_LEAST_DAMPING = 1.0


@compiled("f8(f8, f8, f8)")
def _ramp(value: float, none: float, full: float) -> float:
    return min(1.0, max(0.0, (value - none) / (full - none)))


@compiled("UniTuple(f8, 2)(f8[:], f8[:], f8, f8[::1], f8[::1], f8, f8, f8)")
def point_to_hold(
    com: np.ndarray,
    com_velocity: np.ndarray,
    ground_height: float,
    momentum: np.ndarray,
    turned: np.ndarray,
    damping: float,
    stiffness: float,
    mass: float,
) -> tuple[float, float]:
    """The capture point, and as much farther as bringing angular momentum back will drive it.

    While k follows Eq. 37, dk/dt = -Gamma k - K I theta with k = I dtheta/dt, the CMP stays behind the CoP by
    |dk/dt| / (m g), and the capture point xi runs away from the CMP at the rate omega. It ends inside the feet if

        xi + c,  c = omega / (m g) (K omega I theta + (Gamma omega + K) k) / (omega^2 + Gamma omega + K)

    is inside: c is the integral of omega exp(-omega t) |dk/dt| / (m g), turned from an axis into a direction.

    Args:
        com: r_G (3,), m.
        com_velocity: against the ground (3,), m/s.
        ground_height: z_0, m.
        momentum: k to be brought back (3,), N m s.
        turned: I theta of the pelvis (3,), kg m^2.
        damping: Gamma_11, 1/s.
        stiffness: K_theta, 1/s^2.
        mass: m, kg.

    Returns:
        (x, y) in the world, m.
    """
    omega = pendulum_frequency(com[2] - ground_height)
    x, y = capture_coordinates(com, com_velocity, ground_height)
    share = omega / (mass * GRAVITY) / (omega * omega + damping * omega + stiffness)
    by_turn, by_momentum = share * stiffness * omega, share * (damping * omega + stiffness)
    back_x = by_turn * turned[1] + by_momentum * momentum[1]
    back_y = -by_turn * turned[0] - by_momentum * momentum[0]
    return x + back_x, y + back_y


@compiled(
    "f8(f8[::1], f8[::1], f8[::1], f8[::1], f8[::1], f8[::1], "
    "f8[:, :], f8[:, :], f8[:, :], f8[:, ::1], f8, f8, f8, f8)"
)
def _urgency(
    missing: np.ndarray,
    com: np.ndarray,
    com_velocity: np.ndarray,
    goal_velocity: np.ndarray,
    momentum: np.ndarray,
    goal_momentum: np.ndarray,
    locked_inertia: np.ndarray,
    pelvis: np.ndarray,
    desired_pelvis: np.ndarray,
    polygon: np.ndarray,
    ground_height: float,
    damping: float,
    stiffness: float,
    mass: float,
) -> float:
    """From 0 to 1; see `urgency_to_turn_back`."""
    distance = np.hypot(missing[0], missing[1])
    if not distance > 0.0:
        return 0.0
    inertia = np.ascontiguousarray(locked_inertia)
    tilt, spin = rotation_error(pelvis, desired_pelvis), momentum[3:] - goal_momentum
    to_turn = tilt + np.linalg.solve(inertia, spin) / max(damping, _LEAST_DAMPING)
    turning = 0.0
    for axis, counts in ((0, 1.0), (1, _PITCH)):
        along = desired_pelvis[:, axis]
        turns = along[1] * missing[0] - along[0] * missing[1]
        turning += counts * turns / distance * (to_turn[0] * along[0] + to_turn[1] * along[1])
    if not turning > _LITTLE_ROOM:
        return 0.0
    held = point_to_hold(
        com, com_velocity - goal_velocity, ground_height, spin, inertia @ tilt, damping, stiffness, mass
    )
    affordable = _ramp(depth(np.array(held), polygon), -_EARLY, 0.0)
    return affordable * _ramp(turning, _LITTLE_ROOM, _NO_ROOM)


class Gains(Protocol):
    """Those of `ComputedTorqueGains` that count here."""

    @property
    def angular_damping(self) -> float:
        """Gamma_11, 1/s."""
        ...

    @property
    def pelvis_stiffness(self) -> float:
        """K_theta, 1/s^2."""
        ...

    @property
    def friction(self) -> float:
        """Coulomb coefficient to count on."""
        ...


def balanced(
    mass: float,
    dynamics: Dynamics,
    desired: np.ndarray,
    reference: Reference,
    stance: StanceFeet,
    gains: Gains,
    priority: float,
) -> Compromise:
    """The net force and angular rate to ask the ground for (section 5.1.2).

    An extension: where the laws of Eqs. 37 and 38 alone decide, angular momentum gets more than its priority once
    the body has to stop turning; see `urgency_to_turn_back`.

    Args:
        mass: m, kg.
        dynamics: the state with everything computed.
        desired: [dl_d; dk_d] (6,), N and N m.
        reference: what the robot shall do.
        stance: the feet that carry the robot.
        gains: Gamma_11, K_theta and the friction to count on.
        priority: from 0 to 1.
    """

    def weighed(priority: float) -> Compromise:
        return compromise(
            desired,
            dynamics.com_in_world,
            mass,
            stance.safe_polygon,
            stance.height,
            gains.friction,
            priority,
        )

    balance = weighed(priority)
    if reference.controlled != ALL or reference.planner != OWN:
        return balance
    missing = balance.cop_desired - balance.cop_admissible
    urgency = urgency_to_turn_back(
        missing, dynamics, reference, stance, mass, gains.angular_damping, gains.pelvis_stiffness
    )
    return weighed(urgency) if urgency > priority else balance


def urgency_to_turn_back(
    missing: np.ndarray,
    dynamics: Dynamics,
    reference: Reference,
    stance: StanceFeet,
    mass: float,
    damping: float,
    stiffness: float,
) -> float:
    """How much priority angular momentum needs, whoever else has it: 0 while the body has room, 1 without.

    It counts how far the body will have turned when its angular momentum is gone, theta + I_G^-1 k / Gamma_11, in
    the direction in which the missing CoP turns it; and only as far as `point_to_hold` is inside the feet: what
    catches the fall comes first.

    Args:
        missing: from the CoP that can be to the one that is asked for (2,), m.
        dynamics: the state with everything computed.
        reference: what the robot shall do.
        stance: the feet that carry the robot.
        mass: m, kg.
        damping: Gamma_11, 1/s.
        stiffness: K_theta, 1/s^2.

    Returns:
        From 0 to 1.
    """
    return _urgency(
        missing,
        dynamics.com_in_world,
        dynamics.com_velocity,
        reference.com_velocity,
        dynamics.momentum,
        reference.angular_momentum,
        dynamics.locked_inertia,
        dynamics.pelvis_rotation,
        reference.pelvis_rotation,
        stance.safe_polygon,
        stance.height,
        damping,
        stiffness,
        mass,
    )
