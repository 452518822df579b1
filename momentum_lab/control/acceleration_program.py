"""Eq. 34 put together: the terms of the accelerations as one quadratic program, in one call.

nv accelerations, na = nv - 6 of them at joints, S stance feet.
"""

from __future__ import annotations

import numpy as np

from momentum_lab.compiled import compiled
from momentum_lab.control.acceleration_terms import (
    braking_bounds,
    least_squares,
    momentum_and_pelvis,
    posture,
    standing_feet,
    torque_ratio,
)
from momentum_lab.robot.rotation import rotation_error

_MATRIX, _VECTOR = "f8[:, ::1]", "f8[::1]"


@compiled(
    f"Tuple(({_MATRIX}, {_VECTOR}, {_VECTOR}))({_MATRIX}, {_VECTOR}, {_MATRIX}, {_VECTOR}, {_VECTOR}, {_VECTOR})"
)
def stacked_bounds(
    still: np.ndarray,
    rest: np.ndarray,
    torques: np.ndarray,
    offset: np.ndarray,
    low: np.ndarray,
    high: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """All rows G and the bounds of [a; G a]: free base, braking joints, feet at rest, torques within limits.

    Args:
        still: J_c (6 S, nv).
        rest: dv_c - dJ_c v (6 S,).
        torques: rows of the torque ratios (na, nv).
        offset: of the torque ratios (na,).
        low: least joint accelerations (na,), rad/s^2.
        high: largest joint accelerations (na,), rad/s^2.

    Returns:
        G (6 S + na, nv), lower and upper bounds (nv + 6 S + na,).
    """
    feet, joints = len(rest), len(offset)
    matrix = np.concatenate((still, torques))
    lower, upper = np.empty(6 + 2 * joints + feet), np.empty(6 + 2 * joints + feet)
    lower[:6], upper[:6] = -np.inf, np.inf
    lower[6 : 6 + joints], upper[6 : 6 + joints] = low, high
    lower[6 + joints : 6 + joints + feet] = upper[6 + joints : 6 + joints + feet] = rest
    lower[6 + joints + feet :], upper[6 + joints + feet :] = -1.0 - offset, 1.0 - offset
    return matrix, lower, upper


@compiled(
    f"Tuple(({_MATRIX}, {_VECTOR}, {_MATRIX}, {_VECTOR}, {_VECTOR}))("
    # the state: q, v, A_G, dh_a - dA_G v, I_G, H, C v + tau_g
    f"{_VECTOR}, {_VECTOR}, {_MATRIX}, {_VECTOR}, f8[:, :], {_MATRIX}, {_VECTOR}, "
    # the pelvis: J_p, dJ_p v, R_p, R_d
    f"f8[:, :], {_VECTOR}, f8[:, :], f8[:, :], "
    # the soles: stance, J, dJ v, positions, axes
    f"i8[::1], f8[:, :, ::1], {_MATRIX}, {_MATRIX}, f8[:, :, ::1], "
    # the plates under them: positions, axes, velocities, accelerations; and the wrenches
    f"{_MATRIX}, f8[:, :, ::1], {_MATRIX}, {_MATRIX}, {_MATRIX}, "
    # the joints: posture, free joints, limits of position and torque
    f"{_VECTOR}, {_VECTOR}, {_VECTOR}, {_VECTOR}, {_VECTOR}, "
    # what matters: mass, w_b, w_p, ridge, k, d, kappa of contact and of joint limits, margin of joint limits
    f"f8, f8, f8, f8, f8, f8, f8, f8, f8)"
)
def acceleration_program(
    q: np.ndarray,
    v: np.ndarray,
    centroidal_map: np.ndarray,
    missing_rate: np.ndarray,
    locked_inertia: np.ndarray,
    mass_matrix: np.ndarray,
    nonlinear_effects: np.ndarray,
    pelvis_jacobian: np.ndarray,
    pelvis_bias: np.ndarray,
    pelvis_rotation: np.ndarray,
    desired_pelvis: np.ndarray,
    stance: np.ndarray,
    sole_jacobian: np.ndarray,
    sole_bias: np.ndarray,
    sole_position: np.ndarray,
    sole_rotation: np.ndarray,
    plate_position: np.ndarray,
    plate_rotation: np.ndarray,
    plate_velocity: np.ndarray,
    plate_acceleration: np.ndarray,
    wrench: np.ndarray,
    home: np.ndarray,
    free: np.ndarray,
    position_lower: np.ndarray,
    position_upper: np.ndarray,
    effort_limit: np.ndarray,
    mass: float,
    momentum_weight: float,
    pelvis_weight: float,
    ridge: float,
    stiffness: float,
    damping: float,
    contact_rate: float,
    limit_rate: float,
    limit_margin: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Eq. 34 as P, c, G, lower and upper bounds: all terms put together in one call.

    Shapes and units of the arguments are those of `momentum_and_pelvis`, `posture`, `standing_feet`,
    `torque_ratio` and `braking_bounds`.

    Returns:
        P (nv, nv), c (nv,), G (6 S + na, nv), bounds of [a; G a] (nv + 6 S + na,), lower and upper.
    """
    rest_weight = 1.0 - momentum_weight
    rows, target = momentum_and_pelvis(
        mass,
        momentum_weight,
        rest_weight * pelvis_weight,
        centroidal_map,
        missing_rate,
        locked_inertia,
        pelvis_jacobian,
        pelvis_bias,
        rotation_error(pelvis_rotation, desired_pelvis),
        v,
        stiffness,
        damping,
    )
    weight, wanted = posture(q, v, home, free, rest_weight, ridge, stiffness, damping)
    hessian, gradient = least_squares(rows, target, weight, wanted)
    still, rest = standing_feet(
        stance,
        sole_jacobian,
        sole_bias,
        sole_position,
        sole_rotation,
        plate_position,
        plate_rotation,
        plate_velocity,
        plate_acceleration,
        v,
        contact_rate,
    )
    torques, offset = torque_ratio(mass_matrix, nonlinear_effects, sole_jacobian, wrench, effort_limit)
    low, high = braking_bounds(q[7:], v[6:], position_lower, position_upper, limit_rate, limit_margin)
    matrix, lower, upper = stacked_bounds(still, rest, torques, offset, low, high)
    return hessian, gradient, matrix, lower, upper
