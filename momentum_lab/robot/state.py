"""What is known about a robot at one instant.

A `State` is a point in state space. A `Dynamics` is that point with everything the tick needs already
computed: whoever holds one never has to ask whether kinematics has run.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from momentum_lab.compiled import compiled


@compiled("boolean(f8[::1], f8[::1])")
def both_finite(q: np.ndarray, v: np.ndarray) -> bool:
    """Whether no number of a configuration (nq,) and a velocity (nv,) is infinite or NaN."""
    for number in q:
        if not math.isfinite(number):
            return False
    for number in v:  # noqa: SIM110 - numba compiles no all()
        if not math.isfinite(number):
            return False
    return True


@dataclass(frozen=True, slots=True)
class State:
    """Configuration and velocity in Pinocchio's convention, free-flyer first.

    Attributes:
        q: configuration (nq,), m and rad: base position, base quaternion xyzw, joint angles.
        v: velocity (nv,), m/s and rad/s: base linear and angular velocity in the base frame, joint rates.
    """

    q: np.ndarray
    v: np.ndarray

    def is_finite(self) -> bool:
        """Whether every number of the state is finite."""
        return both_finite(self.q, self.v)


@dataclass(frozen=True, slots=True)
class Dynamics:
    """Every quantity of one state that control and physics share; world axes, linear before angular.

    F is the number of feet. Arrays belong to this object and are not overwritten by later states.

    Attributes:
        state: the state all of this was computed from.
        com_in_world: centre of mass (3,), m.
        com_velocity: velocity of the centre of mass (3,), m/s.
        centroidal_map: A_G (6, nv), with h_G = A_G v.
        centroidal_bias: dA_G/dt v (6,), N and N m.
        momentum: h_G = [l; k] about the CoM (6,), N s and N m s.
        locked_inertia: rotational inertia about the CoM with all joints locked (3, 3), kg m^2.
        mass_matrix: H (nv, nv), armature included.
        nonlinear_effects: C v + tau_g (nv,), N and N m.
        sole_position: sole frame origins (F, 3), m.
        sole_rotation: sole frame axes in the world (F, 3, 3).
        sole_jacobian: velocity of the sole origins, world-aligned (F, 6, nv).
        sole_bias: classical acceleration of the soles at zero joint acceleration (F, 6), m/s^2, rad/s^2.
        pelvis_rotation: pelvis axes in the world (3, 3).
        pelvis_jacobian: velocity of the pelvis origin, world-aligned (6, nv).
        pelvis_bias: classical acceleration of the pelvis at zero joint acceleration (6,).
    """

    state: State
    com_in_world: np.ndarray
    com_velocity: np.ndarray
    centroidal_map: np.ndarray
    centroidal_bias: np.ndarray
    momentum: np.ndarray
    locked_inertia: np.ndarray
    mass_matrix: np.ndarray
    nonlinear_effects: np.ndarray
    sole_position: np.ndarray
    sole_rotation: np.ndarray
    sole_jacobian: np.ndarray
    sole_bias: np.ndarray
    pelvis_rotation: np.ndarray
    pelvis_jacobian: np.ndarray
    pelvis_bias: np.ndarray
