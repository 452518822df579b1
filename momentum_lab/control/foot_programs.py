"""The two quadratic programs of double support as matrices, and what their answers amount to.

S stance feet. Stage 1 finds forces at the ankles, stage 2 a CoP and a normal moment for each foot.
"""

from __future__ import annotations

import numpy as np

from momentum_lab.compiled import compiled
from momentum_lab.control.optimality import judged_minimum
from momentum_lab.momentum.foot_ground import distance_above
from momentum_lab.momentum.polygon import convex_hull
from momentum_lab.momentum.wrench import cross

_MATRIX, _VECTOR, _STACK = "f8[:, ::1]", "f8[::1]", "f8[:, :, ::1]"


@compiled(
    f"Tuple(({_MATRIX}, {_MATRIX}, {_STACK}, {_MATRIX}, f8))"
    f"(i8[::1], {_MATRIX}, {_STACK}, {_VECTOR}, {_MATRIX}, {_STACK})"
)
def placed_feet(
    stance: np.ndarray,
    position: np.ndarray,
    rotation: np.ndarray,
    com: np.ndarray,
    ankles: np.ndarray,
    corners: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, float]:
    """Where the stance feet are, seen from the CoM.

    Args:
        stance: indices of the stance feet (S,).
        position: all sole origins in the world (F, 3), m.
        rotation: axes of all soles in the world (F, 3, 3).
        com: r_G (3,), m.
        ankles: the stance feet's ankles in the sole frames (S, 3), m.
        corners: corners of their safe rectangles in the sole frames (S, 4, 2), m.

    Returns:
        From the CoM to the soles and to the ankles (S, 3), axes (S, 3, 3), convex hull of the safe corners in the
        world, seen from above (K, 2), mean height of the soles, m.
    """
    count = len(stance)
    to_sole, to_ankle, axes = np.empty((count, 3)), np.empty((count, 3)), np.empty((count, 3, 3))
    placed, height = np.empty((4 * count, 2)), 0.0
    for place, foot in enumerate(stance):
        turn = rotation[foot]
        axes[place] = turn
        to_sole[place] = position[foot] - com
        to_ankle[place] = to_sole[place] + turn @ ankles[place]
        height += position[foot, 2] / count
        for corner in range(4):
            x, y = corners[place, corner]
            for i in range(2):
                placed[4 * place + corner, i] = position[foot, i] + turn[i, 0] * x + turn[i, 1] * y
    return to_sole, to_ankle, axes, convex_hull(placed), height


@compiled(f"b1[::1]({_MATRIX}, {_STACK}, {_MATRIX}, {_MATRIX}, {_MATRIX}, {_STACK}, f8)")
def near_the_ground(
    position: np.ndarray,
    rotation: np.ndarray,
    lower: np.ndarray,
    upper: np.ndarray,
    plate_position: np.ndarray,
    plate_rotation: np.ndarray,
    margin: float,
) -> np.ndarray:
    """Whether the lowest corner of each sole is less than a margin (m) above its plate (F,).

    Args:
        position: sole origins in the world (F, 3), m.
        rotation: axes of the soles in the world (F, 3, 3).
        lower: rear right corners in the sole frames (F, 2), m.
        upper: front left corners likewise (F, 2), m.
        plate_position: a point of the plate under each sole (F, 3), m.
        plate_rotation: axes of those plates, normals last (F, 3, 3).
        margin: m.
    """
    near = np.empty(len(position), dtype=np.bool_)
    for foot in range(len(position)):
        normal = plate_rotation[foot, :, 2]
        height = distance_above(plate_position[foot], plate_rotation[foot], position[foot])
        for k in range(2):
            slope = 0.0
            for i in range(3):
                slope += normal[i] * rotation[foot, i, k]
            height += min(slope * lower[foot, k], slope * upper[foot, k])
        near[foot] = height < margin
    return near


@compiled(f"{_MATRIX}({_MATRIX})")
def levers_of(arms: np.ndarray) -> np.ndarray:
    """The map [S(a_1) ... S(a_S)] (3, 3 S) from forces at arms (S, 3) to their moment."""
    levers = np.zeros((3, 3 * len(arms)))
    for foot in range(len(arms)):
        x, y, z = arms[foot]
        levers[0, 3 * foot + 1], levers[0, 3 * foot + 2] = -z, y
        levers[1, 3 * foot], levers[1, 3 * foot + 2] = z, -x
        levers[2, 3 * foot], levers[2, 3 * foot + 1] = -y, x
    return levers


@compiled(
    f"Tuple(({_MATRIX}, {_VECTOR}, {_MATRIX}))({_MATRIX}, {_STACK}, {_VECTOR}, {_VECTOR}, {_MATRIX}, f8, f8)"
)
def force_program(
    arms: np.ndarray,
    rotation: np.ndarray,
    force: np.ndarray,
    angular_rate: np.ndarray,
    pyramid: np.ndarray,
    angular_weight: float,
    small_force_weight: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Hessian, gradient and rows of |f - sum f_i|^2 + w^2 |dk/dt - sum a_i x f_i|^2 + e^2 sum |f_i|^2, halved.

    Args:
        arms: a_i from the CoM to the ankles (S, 3), m.
        rotation: axes of the soles in the world (S, 3, 3).
        force: f (3,), N.
        angular_rate: dk/dt (3,), N m.
        pyramid: rows that bound a force in sole axes (m, 3).
        angular_weight: w, 1/m.
        small_force_weight: e.

    Returns:
        P (3 S, 3 S), c (3 S,), and the rows in world axes (S m, 3 S).
    """
    count, facets = len(rotation), len(pyramid)
    size, levers = 3 * count, levers_of(arms)
    hessian, gradient, rows = np.zeros((size, size)), np.zeros(size), np.zeros((count * facets, size))
    for i in range(size):
        gradient[i] = -force[i % 3]
        for k in range(3):
            gradient[i] -= angular_weight**2 * levers[k, i] * angular_rate[k]
            for j in range(size):
                hessian[i, j] += angular_weight**2 * levers[k, i] * levers[k, j]
        for j in range(i % 3, size, 3):
            hessian[i, j] += 1.0
        hessian[i, i] += small_force_weight**2
    for foot in range(count):
        for facet in range(facets):
            for i in range(3):
                for k in range(3):
                    rows[foot * facets + facet, 3 * foot + i] += pyramid[facet, k] * rotation[foot, i, k]
    return hessian, gradient, rows


@compiled(
    f"Tuple(({_MATRIX}, {_VECTOR}, {_VECTOR}, {_VECTOR}))"
    f"({_MATRIX}, {_STACK}, {_MATRIX}, {_VECTOR}, {_MATRIX}, {_MATRIX}, {_MATRIX}, f8, f8, f8)"
)
def cop_program(
    forces: np.ndarray,
    rotation: np.ndarray,
    arms: np.ndarray,
    angular_rate: np.ndarray,
    ankle_in_sole: np.ndarray,
    lower: np.ndarray,
    upper: np.ndarray,
    normal_moment: float,
    shift_weight: float,
    moment_weight: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Hessian, gradient and bounds of |Psi eta - kappa|^2 + |e (eta - eta_d)|^2, halved.

    eta = (d_x, d_y, tau_n) per foot: CoP from the ankle in sole axes and moment about the sole's normal. Its
    columns of Psi are those of -S(f) R for the shifts and the normal for the moment; kappa is what is left of
    the angular rate by forces that pass h below the ankles; eta_d lets the ankles feel no torque.

    Args:
        forces: f_i (S, 3), N.
        rotation: axes R of the soles in the world (S, 3, 3).
        arms: a_i from the CoM to the ankles (S, 3), m.
        angular_rate: dk/dt (3,), N m.
        ankle_in_sole: ankles in the sole frames, h_i their heights (S, 3), m.
        lower: least shifts (S, 2), m.
        upper: largest shifts (S, 2), m.
        normal_moment: largest normal moment per normal force, m.
        shift_weight: e of the shifts, N.
        moment_weight: e of the moments.

    Returns:
        P (3 S, 3 S), c (3 S,), lower and upper bounds (3 S,).
    """
    count = len(forces)
    size = 3 * count
    levers, easy, remaining = np.zeros((3, size)), np.zeros(size), angular_rate.copy()
    low, high = np.empty(size), np.empty(size)
    for foot in range(count):
        fx, fy, fz = forces[foot]
        turn, height, at = rotation[foot], ankle_in_sole[foot, 2], 3 * foot
        remaining -= cross(arms[foot], forces[foot])
        for k in range(3):
            x, y, z = turn[0, k], turn[1, k], turn[2, k]
            column = (fz * y - fy * z, fx * z - fz * x, fy * x - fx * y)
            for i in range(3):
                if k < 2:
                    levers[i, at + k] = column[i]
                else:
                    remaining[i] += height * column[i]
                    levers[i, at + 2] = turn[i, 2]
        normal = fx * turn[0, 2] + fy * turn[1, 2] + fz * turn[2, 2]
        for k in range(2):
            along = fx * turn[0, k] + fy * turn[1, k] + fz * turn[2, k]
            easy[at + k] = -height * along / normal
            low[at + k], high[at + k] = lower[foot, k], upper[foot, k]
        high[at + 2] = normal_moment * normal
        low[at + 2] = -high[at + 2]
    hessian, gradient = np.zeros((size, size)), np.zeros(size)
    for i in range(size):
        cost = (moment_weight if i % 3 == 2 else shift_weight) ** 2
        hessian[i, i] = cost
        gradient[i] = -cost * easy[i]
        for k in range(3):
            gradient[i] -= levers[k, i] * remaining[k]
            for j in range(size):
                hessian[i, j] += levers[k, i] * levers[k, j]
    return hessian, gradient, low, high


@compiled(f"Tuple(({_MATRIX}, {_VECTOR}))({_MATRIX}, {_MATRIX}, {_STACK}, {_MATRIX}, {_MATRIX}, f8)")
def foot_wrenches(
    forces: np.ndarray,
    sole_moments: np.ndarray,
    rotation: np.ndarray,
    ankle_in_sole: np.ndarray,
    com_to_sole: np.ndarray,
    weight: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Wrenches about the sole origins (S, 6) and the momentum rate that they and the weight cause (Eqs. 1, 2).

    Args:
        forces: f_i (S, 3), N.
        sole_moments: (d_x, d_y, tau_n) of each foot (S, 3), m and N m.
        rotation: axes of the soles in the world (S, 3, 3).
        ankle_in_sole: ankles in the sole frames (S, 3), m.
        com_to_sole: from the CoM to the sole origins, world axes (S, 3), m.
        weight: m g, N.
    """
    wrenches, rate = np.zeros((len(forces), 6)), np.zeros(6)
    rate[2] = -weight
    for foot in range(len(forces)):
        turn = rotation[foot]
        fx, fy, fz = forces[foot]
        px, py = (
            ankle_in_sole[foot, 0] + sole_moments[foot, 0],
            ankle_in_sole[foot, 1] + sole_moments[foot, 1],
        )
        arm = (
            turn[0, 0] * px + turn[0, 1] * py,
            turn[1, 0] * px + turn[1, 1] * py,
            turn[2, 0] * px + turn[2, 1] * py,
        )
        moment = (arm[1] * fz - arm[2] * fy, arm[2] * fx - arm[0] * fz, arm[0] * fy - arm[1] * fx)
        x, y, z = com_to_sole[foot]
        about_com = (y * fz - z * fy, z * fx - x * fz, x * fy - y * fx)
        for i in range(3):
            wrenches[foot, i] = forces[foot, i]
            wrenches[foot, 3 + i] = moment[i] + sole_moments[foot, 2] * turn[i, 2]
            rate[i] += forces[foot, i]
            rate[3 + i] += about_com[i] + wrenches[foot, 3 + i]
    return wrenches, rate


@compiled(
    f"Tuple(({_MATRIX}, {_VECTOR}, b1))("
    # the feet: from the CoM to ankles and soles, axes, ankles, safe soles
    f"{_MATRIX}, {_MATRIX}, {_STACK}, {_MATRIX}, {_MATRIX}, {_MATRIX}, "
    # what is asked for, and the bounds
    f"{_VECTOR}, {_VECTOR}, {_MATRIX}, {_VECTOR}, {_VECTOR}, "
    # largest normal moment, the four weights, the robot's weight, what residuals may be
    f"f8, f8, f8, f8, f8, f8, f8)"
)
def quiet_share(
    arms: np.ndarray,
    com_to_sole: np.ndarray,
    rotation: np.ndarray,
    ankle_in_sole: np.ndarray,
    lower: np.ndarray,
    upper: np.ndarray,
    force: np.ndarray,
    angular_rate: np.ndarray,
    pyramid: np.ndarray,
    least: np.ndarray,
    largest: np.ndarray,
    normal_moment: float,
    angular_weight: float,
    small_force_weight: float,
    shift_weight: float,
    moment_weight: float,
    weight: float,
    tolerance: float,
) -> tuple[np.ndarray, np.ndarray, bool]:
    """Both stages in one call, for the feet of a quiet tick, which press against no bound.

    Args:
        arms: a_i from the CoM to the ankles (S, 3), m.
        com_to_sole: from the CoM to the sole origins (S, 3), m.
        rotation: axes of the soles in the world (S, 3, 3).
        ankle_in_sole: ankles in the sole frames (S, 3), m.
        lower: least shifts of the CoP (S, 2), m.
        upper: largest shifts (S, 2), m.
        force: f (3,), N.
        angular_rate: dk/dt (3,), N m.
        pyramid: rows that bound a force in sole axes (m, 3).
        least: lower bounds of stage 1 (3 S + S m,), N.
        largest: upper bounds likewise.
        normal_moment: largest normal moment per normal force, m.
        angular_weight: of stage 1, 1/m.
        small_force_weight: of stage 1.
        shift_weight: of stage 2, N.
        moment_weight: of stage 2.
        weight: m g, N.
        tolerance: what the residuals of optimality may be.

    Returns:
        What `foot_wrenches` returns, and whether both programs are certified to have their answer in it.
    """
    nothing, no_rows = np.zeros(0, dtype=np.bool_), np.zeros((0, 3 * len(rotation)))
    hessian, gradient, rows = force_program(
        arms, rotation, force, angular_rate, pyramid, angular_weight, small_force_weight
    )
    forces, _, primal, dual, gap = judged_minimum(hessian, gradient, rows, least, largest, nothing)
    certified = primal <= tolerance and dual <= tolerance and gap <= tolerance
    shared = forces.reshape(-1, 3)
    hessian, gradient, low, high = cop_program(
        shared,
        rotation,
        arms,
        angular_rate,
        ankle_in_sole,
        lower,
        upper,
        normal_moment,
        shift_weight,
        moment_weight,
    )
    shifts, _, primal, dual, gap = judged_minimum(hessian, gradient, no_rows, low, high, nothing)
    certified = certified and primal <= tolerance and dual <= tolerance and gap <= tolerance
    wrenches, rate = foot_wrenches(
        shared, shifts.reshape(-1, 3), rotation, ankle_in_sole, com_to_sole, weight
    )
    return wrenches, rate, certified
