"""The contact problem in the space of few frames: its terms, and the step in which all points come to rest.

The points of one body move with its frame, so W = S (J_f H^-1 J_f^T) S^T, see `contact`.
"""

from __future__ import annotations

import math

import numpy as np

from momentum_lab.cholesky import backward_substitute, factorize, forward_substitute, gram, solved
from momentum_lab.compiled import compiled

_MATRIX, _VECTOR = "f8[:, ::1]", "f8[::1]"

# A penetration is undone within a step if this speed is enough, m/s; a deeper one at this rate, 1/s, and never
# faster than this, m/s.
_GENTLE_SPEED = 0.01
_RECOVERY_RATE = 50.0
_RECOVERY_SPEED = 0.2


@compiled(f"Tuple(({_VECTOR}, {_MATRIX}, {_MATRIX}, {_VECTOR}))({_MATRIX}, {_VECTOR}, {_VECTOR}, {_MATRIX})")
def contact_problem(
    factor: np.ndarray, free_impulse: np.ndarray, velocity: np.ndarray, frame_jacobian: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Velocity without contact, J_f L^-T, and C and d of the frames' velocities C w + d under impulses w.

    Args:
        factor: L with L L^T = H (nv, nv).
        free_impulse: p of everything but contact (nv,), N s and N m s.
        velocity: generalized velocity at the start of the step (nv,).
        frame_jacobian: J_f (6 B, nv).

    Returns:
        v + H^-1 p (nv,), J_f L^-T (6 B, nv), C = J_f H^-1 J_f^T (6 B, 6 B), d = J_f (v + H^-1 p) (6 B,).
    """
    rows = np.concatenate((frame_jacobian, free_impulse.copy().reshape(1, -1)))
    forward_substitute(factor, rows)
    half, free_velocity = rows[:-1], rows[-1].copy()
    backward_substitute(factor, free_velocity)
    free_velocity += velocity
    return free_velocity, half, gram(half), frame_jacobian @ free_velocity


@compiled(f"Tuple(({_VECTOR}, {_MATRIX}))({_MATRIX}, {_MATRIX}, {_VECTOR}, {_MATRIX}, {_VECTOR})")
def moved(
    factor: np.ndarray,
    half: np.ndarray,
    free_velocity: np.ndarray,
    spread: np.ndarray,
    impulse: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Velocity v + H^-1 (p + J_f^T w) (nv,) under point impulses lambda, and w = S^T lambda (B, 6).

    Args:
        factor: L with L L^T = H (nv, nv).
        half: J_f L^-T (6 B, nv).
        free_velocity: v + H^-1 p (nv,).
        spread: S (3 n, 6 B).
        impulse: lambda (3 n,), N s.
    """
    frame_impulse = impulse @ spread
    change = frame_impulse @ half
    backward_substitute(factor, change)
    return free_velocity + change, frame_impulse.reshape(-1, 6)


@compiled(f"Tuple(({_VECTOR}, f8))({_MATRIX}, {_VECTOR}, {_MATRIX}, {_VECTOR}, {_VECTOR})")
def sticking_impulse(
    coupling: np.ndarray, drift: np.ndarray, spread: np.ndarray, closing: np.ndarray, friction: np.ndarray
) -> tuple[np.ndarray, float]:
    """The smallest impulses that bring every point to rest on its ground, if they are in the friction cones.

    S (C w + d) + c = 0 with w = S^T lambda: then w = -C^-1 (d + G^-1 S^T c) and lambda = S G^-1 w, G = S^T S. A
    robot that stands has such impulses, and points at rest under impulses in their cones obey all laws of
    contact. Other impulses may do when these do not; that is for a solver to find.

    Args:
        coupling: C (6 B, 6 B).
        drift: d (6 B,).
        spread: S (3 n, 6 B).
        closing: speed at which each gap may close, for the normals (n,), m/s.
        friction: Coulomb coefficient of each point (n,).

    Returns:
        lambda (3 n,), N s, and the largest entry of S (C S^T lambda + d) + c, m/s; NaN if lambda does not do.
        Where G is singular, as for one or two points, it is the residual that says so.
    """
    rows, frames = spread.shape
    columns = np.ascontiguousarray(spread.T)
    square, factor, mean = gram(columns), coupling.copy(), np.zeros(frames)
    if not (factorize(square) and factorize(factor)):
        return np.zeros(rows), np.nan
    for j in range(frames):
        for point in range(rows // 3):
            mean[j] += columns[j, 3 * point + 2] * closing[point]
    frame_impulse = solved(factor, -drift - solved(square, mean))
    impulse = spread @ solved(square, frame_impulse)
    left = coupling @ (impulse @ spread) + drift
    residual = 0.0
    for point in range(rows // 3):
        x, y, normal = impulse[3 * point : 3 * point + 3]
        if not (normal >= 0.0 and math.hypot(x, y) <= friction[point] * normal):
            return impulse, np.nan
        for axis in range(3):
            speed = closing[point] if axis == 2 else 0.0
            for j in range(frames):
                speed += spread[3 * point + axis, j] * left[j]
            residual = max(residual, abs(speed))
    return impulse, residual


@compiled(f"{_VECTOR}({_VECTOR}, f8)")
def closing_speed(gap: np.ndarray, timestep: float) -> np.ndarray:
    """Speed at which gaps (n,) may close within a step, or (negative) at which penetrations must open, m/s.

    Linear through zero: the corners of a flat foot, nanometres up or down, then ask for one rigid motion. With
    a kink there the solver needs up to twenty times the iterations.
    """
    speed = np.empty_like(gap)
    for i in range(gap.size):
        deep = min(max(_RECOVERY_RATE * gap[i], -_RECOVERY_SPEED), -_GENTLE_SPEED)
        speed[i] = max(gap[i] / timestep, deep)
    return speed


@compiled(
    f"Tuple(({_VECTOR}, {_MATRIX}, {_MATRIX}, f8))"
    f"({_MATRIX}, {_VECTOR}, {_VECTOR}, {_MATRIX}, {_MATRIX}, {_VECTOR}, {_VECTOR}, {_VECTOR}, f8)"
)
def resting(
    mass_matrix: np.ndarray,
    free_impulse: np.ndarray,
    velocity: np.ndarray,
    frame_jacobian: np.ndarray,
    spread: np.ndarray,
    gap: np.ndarray,
    friction: np.ndarray,
    ground_velocity: np.ndarray,
    timestep: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """The end of a step in which all points come to rest, or in which there are none: all in one call.

    Shapes and units of the arguments are those of `solve_contact` and `Contacts`.

    Returns:
        Velocity (nv,), point impulses (n, 3), frame impulses (B, 6) and residual, see `ContactSolution`; the
        residual is NaN if H is not positive definite or the points do not come to rest so.
    """
    points = len(gap)
    factor = mass_matrix.copy()
    if not factorize(factor):
        return velocity, np.zeros((points, 3)), np.zeros((len(frame_jacobian) // 6, 6)), np.nan
    free_velocity, half, coupling, drift = contact_problem(factor, free_impulse, velocity, frame_jacobian)
    if not points:
        return free_velocity, np.zeros((0, 3)), np.zeros((0, 6)), 0.0
    drift -= ground_velocity
    closing = closing_speed(gap, timestep)
    impulse, residual = sticking_impulse(coupling, drift, spread, closing, friction)
    end, frame_impulse = moved(factor, half, free_velocity, spread, impulse)
    return end, impulse.reshape(-1, 3), frame_impulse, residual
