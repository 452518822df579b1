"""Coulomb friction in the joints, regularised: a damper that is the stronger the slower its joint turns."""

from __future__ import annotations

import numpy as np

from momentum_lab.physics.implicit_torque import ImplicitTorque
from momentum_lab.robot.state import Dynamics

# Below this speed a joint creeps instead of sticking, rad/s: half a degree per second.
_CREEPING = 0.01


def joint_friction(friction: np.ndarray, dynamics: Dynamics, timestep: float) -> ImplicitTorque:
    """The friction of all joints in a step of a length (s).

    tau = -D v+ with D = c / max(|v|, v0): of the size c above v0, never against the sense of braking, and the
    joint moves as if it had the inertia H_jj + dt D.

    Args:
        friction: c (na,), N m.
        dynamics: the state with everything computed.
        timestep: dt, s.
    """
    speed = dynamics.state.v[6:]
    damping = friction / np.maximum(np.abs(speed), _CREEPING)
    return ImplicitTorque(np.arange(6, 6 + len(friction)), -damping * speed, timestep * damping)
