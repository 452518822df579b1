"""The ends of the joints' ranges: springs and dampers that act only beyond them."""

from __future__ import annotations

import numpy as np

from momentum_lab.compiled import compiled
from momentum_lab.physics.implicit_torque import ImplicitTorque
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics

# A joint that has passed its limit is brought back with this time constant, s.
_TIME = 0.01
# No motor presses its joint further than this beyond the limit, rad.
_GIVES_WAY = 0.02


def joint_stops(robot: RobotModel, dynamics: Dynamics, timestep: float) -> ImplicitTorque | None:
    """The stops that act in a step of a length (s); None when every joint is within its limits.

    With k = I / T^2, d = 2 I / T and I the larger of H_jj and what makes the spring as strong as the motor at
    0.02 rad, tau = -k (excess + dt v+) - d v+, so the joint moves as if it had the inertia H_jj + dt d + dt^2 k.
    H_jj alone would be the inertia of a light foot under the weight of the whole robot.
    """
    if within_limits(dynamics.state.q, robot.position_lower, robot.position_upper):
        return None
    angle = dynamics.state.q[7:]
    excess = angle - np.minimum(np.maximum(angle, robot.position_lower), robot.position_upper)
    beyond = np.flatnonzero(excess)
    rows = beyond + 6
    as_strong = robot.effort_limit[beyond] * _TIME**2 / _GIVES_WAY
    inertia = np.maximum(dynamics.mass_matrix[rows, rows], as_strong)
    stiffness, damping = inertia / _TIME**2, 2.0 * inertia / _TIME
    torque = -stiffness * excess[beyond] - (damping + timestep * stiffness) * dynamics.state.v[rows]
    return ImplicitTorque(rows, torque, timestep * damping + timestep**2 * stiffness)


@compiled("boolean(f8[::1], f8[::1], f8[::1])")
def within_limits(q: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> bool:
    """Whether no joint angle of a configuration q (nq,) is beyond its limits (na,), rad; NaN is not beyond."""
    for joint in range(lower.size):  # noqa: SIM110 - numba compiles no all()
        if q[7 + joint] < lower[joint] or q[7 + joint] > upper[joint]:
            return False
    return True
