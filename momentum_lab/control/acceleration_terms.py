"""The terms of Eq. 34 as matrices: what is wanted of the accelerations, and what bounds them.

nv accelerations, na = nv - 6 of them at joints, S stance feet.
"""

from __future__ import annotations

import numpy as np

from momentum_lab.compiled import compiled
from momentum_lab.momentum.foot_ground import acceleration_at, distance_above, velocity_at
from momentum_lab.momentum.wrench import cross
from momentum_lab.robot.rotation import rotation_error

_MATRIX, _VECTOR = "f8[:, ::1]", "f8[::1]"

BEFORE_THE_STOP = 0.03
"""Joints are to turn back this far before their mechanical stops, rad."""


@compiled(f"UniTuple({_VECTOR}, 2)({_VECTOR}, {_VECTOR}, {_VECTOR}, {_VECTOR}, f8, f8, f8, f8)")
def posture(
    q: np.ndarray,
    v: np.ndarray,
    home: np.ndarray,
    free: np.ndarray,
    weight: float,
    ridge: float,
    stiffness: float,
    damping: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Weight and wanted value of every acceleration (nv,): w (theta''_d - theta'')^2 + e theta''^2 as one square.

    theta''_d = k (theta_0 - theta) - d theta', and e keeps the program strictly convex.

    Args:
        q: configuration (nq,).
        v: velocity (nv,).
        home: theta_0 (na,), rad.
        free: 1 for joints that follow the posture, 0 for everything else (nv,).
        weight: w, of those joints.
        ridge: e, for every acceleration.
        stiffness: k, 1/s^2.
        damping: d, 1/s.
    """
    wanted = np.zeros(v.size)
    wanted[6:] = free[6:] * (stiffness * (home - q[7:]) - damping * v[6:]) * (weight / (weight + ridge))
    return weight * free + ridge, wanted


@compiled(f"Tuple(({_MATRIX}, {_VECTOR}))({_MATRIX}, {_VECTOR}, {_VECTOR}, {_VECTOR})")
def least_squares(
    rows: np.ndarray, target: np.ndarray, weight: np.ndarray, wanted: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Hessian P (nv, nv) and gradient c (nv,) of |E a - e|^2 / 2 + sum_j w_j (a_j - d_j)^2 / 2.

    P = E^T E + diag(w),  c = -(E^T e + w d).

    Args:
        rows: E (k, nv).
        target: e (k,).
        weight: w (nv,).
        wanted: d (nv,).
    """
    size = weight.size
    hessian, gradient = np.zeros((size, size)), np.empty(size)
    for i in range(size):
        total = weight[i] * wanted[i]
        for row in range(len(target)):
            part = rows[row, i]
            total += part * target[row]
            for j in range(size):
                hessian[i, j] += part * rows[row, j]
        hessian[i, i] += weight[i]
        gradient[i] = -total
    return hessian, gradient


@compiled(
    f"Tuple(({_MATRIX}, {_VECTOR}))"
    f"(f8, f8, f8, {_MATRIX}, {_VECTOR}, f8[:, :], f8[:, :], {_VECTOR}, {_VECTOR}, {_VECTOR}, f8, f8)"
)
def momentum_and_pelvis(
    mass: float,
    momentum_weight: float,
    pelvis_weight: float,
    centroidal_map: np.ndarray,
    missing_rate: np.ndarray,
    locked_inertia: np.ndarray,
    pelvis_jacobian: np.ndarray,
    pelvis_bias: np.ndarray,
    tilt: np.ndarray,
    velocity: np.ndarray,
    stiffness: float,
    damping: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Rows E (9, nv) and targets e (9,) of the tasks, each times the root of its weight.

    W (A_G a - (dh_a - dA_G v)) with W = diag(1 / m, I_G^-1), which makes momentum rates into accelerations and
    turns with the robot, so that its heading does not matter; then J_p a - (omega'_d - dJ_p v) for the
    pelvis, with omega'_d = -k e_R - d omega.

    Args:
        mass: m, kg.
        momentum_weight: w_b.
        pelvis_weight: (1 - w_b) w_p.
        centroidal_map: A_G (6, nv).
        missing_rate: dh_a - dA_G v (6,), N and N m.
        locked_inertia: I_G (3, 3), kg m^2.
        pelvis_jacobian: J_p (6, nv), of which the angular part counts.
        pelvis_bias: dJ_p v (6,), likewise, rad/s^2.
        tilt: e_R = log(R R_d^T) of the pelvis (3,), rad.
        velocity: v (nv,).
        stiffness: k, 1/s^2.
        damping: d, 1/s.
    """
    size = centroidal_map.shape[1]
    inverse = np.linalg.inv(np.ascontiguousarray(locked_inertia))
    root, pelvis_root = np.sqrt(momentum_weight), np.sqrt(pelvis_weight)
    rows, targets = np.zeros((9, size)), np.zeros(9)
    for i in range(3):
        targets[i] = root / mass * missing_rate[i]
        targets[6 + i] = -pelvis_root * (stiffness * tilt[i] + pelvis_bias[3 + i])
        for k in range(3):
            targets[3 + i] += root * inverse[i, k] * missing_rate[3 + k]
        for j in range(size):
            rows[i, j] = root / mass * centroidal_map[i, j]
            rows[6 + i, j] = pelvis_root * pelvis_jacobian[3 + i, j]
            targets[6 + i] -= damping * rows[6 + i, j] * velocity[j]
            for k in range(3):
                rows[3 + i, j] += root * inverse[i, k] * centroidal_map[3 + k, j]
    return rows, targets


@compiled(
    f"Tuple(({_MATRIX}, {_VECTOR}))"
    f"(i8[::1], f8[:, :, ::1], {_MATRIX}, {_MATRIX}, f8[:, :, ::1], "
    f"{_MATRIX}, f8[:, :, ::1], {_MATRIX}, {_MATRIX}, {_VECTOR}, f8)"
)
def standing_feet(
    stance: np.ndarray,
    sole_jacobian: np.ndarray,
    sole_bias: np.ndarray,
    sole_position: np.ndarray,
    sole_rotation: np.ndarray,
    plate_position: np.ndarray,
    plate_rotation: np.ndarray,
    plate_velocity: np.ndarray,
    plate_acceleration: np.ndarray,
    velocity: np.ndarray,
    rate: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Rows J_c (6 S, nv) and values dv_c - dJ_c v (6 S,) that keep feet at rest and flat on their plates (Eq. 31).

    dv_c = dv_p - 2 kappa (J_c v - v_p) - kappa^2 e, with the motion v_p, dv_p of the plate where the sole is, and
    the error e in distance and tilt only: a foot that has slipped stays where it is.

    Args:
        stance: indices of the stance feet (S,).
        sole_jacobian: J of all soles (F, 6, nv).
        sole_bias: dJ v of all soles (F, 6), m/s^2 and rad/s^2.
        sole_position: origins of all soles (F, 3), m.
        sole_rotation: axes of all soles in the world (F, 3, 3).
        plate_position: a point of the plate under each sole (F, 3), m.
        plate_rotation: axes of those plates, normals n last (F, 3, 3).
        plate_velocity: of those points and plates (F, 6), m/s and rad/s.
        plate_acceleration: likewise (F, 6), m/s^2 and rad/s^2.
        velocity: v (nv,).
        rate: kappa, 1/s.
    """
    size = velocity.size
    rows, values = np.empty((6 * len(stance), size)), np.empty(6 * len(stance))
    error = np.zeros(6)
    for place, foot in enumerate(stance):
        sole, plate, normal = sole_position[foot], plate_position[foot], plate_rotation[foot, :, 2]
        error[:3] = distance_above(plate, plate_rotation[foot], sole) * normal
        error[3:] = cross(normal, sole_rotation[foot, :, 2])
        carried = velocity_at(sole, plate, plate_velocity[foot])
        speeding = acceleration_at(sole, plate, plate_velocity[foot], plate_acceleration[foot])
        for i in range(6):
            moving = -carried[i]
            for j in range(size):
                rows[6 * place + i, j] = sole_jacobian[foot, i, j]
                moving += sole_jacobian[foot, i, j] * velocity[j]
            values[6 * place + i] = (
                speeding[i] - 2.0 * rate * moving - rate**2 * error[i] - sole_bias[foot, i]
            )
    return rows, values


@compiled(f"UniTuple({_VECTOR}, 2)({_VECTOR}, {_VECTOR}, {_VECTOR}, {_VECTOR}, f8, f8)")
def braking_bounds(
    angle: np.ndarray, speed: np.ndarray, lower: np.ndarray, upper: np.ndarray, rate: float, margin: float
) -> tuple[np.ndarray, np.ndarray]:
    """Accelerations theta''_l, theta''_u (na,) that brake critically damped before the joint limits, rad/s^2.

    theta''_u = kappa^2 (theta_max - margin - theta) - 2 kappa theta', and likewise below.

    Args:
        angle: theta (na,), rad.
        speed: theta' (na,), rad/s.
        lower: theta_min (na,), rad.
        upper: theta_max (na,), rad.
        rate: kappa, 1/s.
        margin: how far before the limits joints shall turn back, rad.
    """
    braking = -2.0 * rate * speed
    return rate**2 * (lower + margin - angle) + braking, rate**2 * (upper - margin - angle) + braking


@compiled(f"Tuple(({_MATRIX}, {_VECTOR}))({_MATRIX}, {_VECTOR}, f8[:, :, ::1], {_MATRIX}, {_VECTOR})")
def torque_ratio(
    mass_matrix: np.ndarray,
    nonlinear_effects: np.ndarray,
    sole_jacobian: np.ndarray,
    wrench: np.ndarray,
    effort_limit: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Rows (na, nv) and offset (na,) of joint torques as parts of their limits: Eq. 33 is linear in a.

    tau_s / tau_max = (H_s a + C_s v + tau_g,s - J_c,s^T f_c) / tau_max.

    Args:
        mass_matrix: H (nv, nv).
        nonlinear_effects: C v + tau_g (nv,), N m.
        sole_jacobian: J of all soles (F, 6, nv).
        wrench: of the ground on all soles about their origins (F, 6), N and N m.
        effort_limit: tau_max (na,), N m.
    """
    joints, size = effort_limit.size, nonlinear_effects.size
    rows, offset = np.empty((joints, size)), np.empty(joints)
    for joint in range(joints):
        torque = nonlinear_effects[6 + joint]
        for foot in range(len(wrench)):
            for i in range(6):
                torque -= sole_jacobian[foot, i, 6 + joint] * wrench[foot, i]
        offset[joint] = torque / effort_limit[joint]
        for j in range(size):
            rows[joint, j] = mass_matrix[6 + joint, j] / effort_limit[joint]
    return rows, offset


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
    """Eq. 34 as P, c, G, lower and upper bounds: the terms of this file put together in one call.

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
