"""What a robot does, and what it asks of the ground, when its feet are taken for glued to it."""

from __future__ import annotations

import numpy as np

from momentum_lab.momentum.foot_ground import FootGround
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.momentum.wrench import wrench_shift_map
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics

# A newton metre at a foot counts like this many newtons when the weight is shared, 1/m.
_MOMENT_PRICE = 20.0
# Softness of the glue, 1/kg: straight knees take a direction from both legs at once.
_SOFTNESS = 1e-9


def motion_of_held_feet(
    dynamics: Dynamics, torque: np.ndarray, stance: tuple[int, ...], ground: FootGround
) -> tuple[np.ndarray, np.ndarray]:
    """Accelerations and foot wrenches that torques cause while the stance feet speed up like their plates.

    H a + C v + tau_g = S^T tau + J_c^T f_c (Eq. 28) with J_c a + dJ_c v = dv_c (Eq. 31). Nothing keeps the wrenches
    within the friction cone, or the CoP within the soles.

    Args:
        dynamics: the state with everything computed.
        torque: joint torques tau (na,), N m.
        stance: the feet, as indices.
        ground: the plates under the feet.

    Returns:
        a (nv,), and the wrenches about the sole origins, world axes (F, 6), N and N m; zero for other feet.
    """
    feet = list(stance)
    jacobian = dynamics.sole_jacobian[feet].reshape(-1, dynamics.state.v.size)
    size, rows = jacobian.shape[1], jacobian.shape[0]
    system = np.zeros((size + rows, size + rows))
    system[:size, :size] = dynamics.mass_matrix
    system[:size, size:] = -jacobian.T
    system[size:, :size] = jacobian
    system[size:, size:].flat[:: rows + 1] = _SOFTNESS
    force = -dynamics.nonlinear_effects
    force[6:] += torque
    wanted = ground.carried_acceleration(dynamics.sole_position)[feet] - dynamics.sole_bias[feet]
    answer = np.linalg.solve(system, np.concatenate([force, wanted.ravel()]))
    wrench = np.zeros((len(dynamics.sole_position), 6))
    wrench[feet] = answer[size:].reshape(-1, 6)
    return answer[:size], wrench


def weight_on_feet(robot: RobotModel, dynamics: Dynamics, stance: tuple[int, ...]) -> np.ndarray:
    """The robot's weight shared among its feet, with the smallest wrenches that hold its CoM.

    min sum |f_i|^2 + (20 / m)^2 |n_i|^2 subject to sum f_i = m g e_z and sum (n_i + (p_i - r_G) x f_i) = 0.

    Args:
        robot: the robot.
        dynamics: the state with everything computed.
        stance: the feet that carry, as indices; at least one.

    Returns:
        Wrenches about the sole origins, world axes (F, 6), N and N m; zero for other feet.
    """
    feet = list(stance)
    price = np.tile((1.0, 1.0, 1.0, *(_MOMENT_PRICE,) * 3), len(feet))
    total = np.hstack([wrench_shift_map(dynamics.sole_position[i], dynamics.com_in_world) for i in feet])
    weight = np.array([0.0, 0.0, robot.mass * GRAVITY, 0.0, 0.0, 0.0])
    cheap = total / price**2
    wrench = np.zeros((len(robot.soles), 6))
    wrench[feet] = (cheap.T @ np.linalg.solve(cheap @ total.T, weight)).reshape(-1, 6)
    return wrench


def holding_torque(dynamics: Dynamics, wrench: np.ndarray) -> np.ndarray:
    """Joint torques of a body at rest under gravity and foot wrenches (na,), N m.

    tau = tau_g - J_c^T f_c, with C v for what moves.

    Args:
        dynamics: the state with everything computed.
        wrench: about the sole origins, world axes (F, 6), N and N m.
    """
    return dynamics.nonlinear_effects[6:] - np.einsum("fi,fij->j", wrench, dynamics.sole_jacobian[:, :, 6:])
