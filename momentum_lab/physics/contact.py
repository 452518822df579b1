"""Frictional unilateral contact of rigid bodies, solved as one impulse problem per step.

For every contact point with velocity u = W lambda + g against its ground, in the axes of that ground, the
impulse lambda obeys Signorini's and Coulomb's laws: it lies in the friction cone, the normal velocity does not
close the gap, and a point that slides is braked against its sliding. W = J H^-1 J^T is the Delassus matrix and g
the velocity without contact, less that of a moving ground, plus gap / dt along the normals.

The points of one body move with its frame, so J = S J_f with the Jacobians J_f of few frames, and W is
S (J_f H^-1 J_f^T) S^T: on two feet 12 columns go through the Cholesky factor of H instead of 24. Pinocchio's own
contact Cholesky needs twice the time for the same, and projected Gauss-Seidel was 4 % off after 2000 iterations,
so the dense form with Pinocchio's ADMM is used (exact second-order cones, 5 iterations while standing,
velocities right to 1e-10 m/s), started cold every step: a step depends on nothing but its arguments.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import pinocchio as pin

from momentum_lab.cholesky import backward_substitute, factorize, forward_substitute, gram, solved
from momentum_lab.compiled import compiled
from momentum_lab.errors import SimulationError

_MATRIX, _VECTOR = "f8[:, ::1]", "f8[::1]"

# Velocities are right to this, m/s: a foot that stands for a minute creeps by less than a micrometre.
_PRECISION = 1e-9
# With more points than two soles have, a robot lies on the ground: to converge as far would take ten times as
# long, to no one's benefit.
_POINTS_OF_SOLES = 8
_PRECISION_LYING = 1e-6
_MAX_ITERATIONS = 2000
# A penetration is undone within a step if this speed is enough, m/s; a deeper one at this rate, 1/s, and never
# faster than this, m/s.
_GENTLE_SPEED = 0.01
_RECOVERY_RATE = 50.0
_RECOVERY_SPEED = 0.2


@dataclass(frozen=True, slots=True)
class Contacts:
    """Points of the robot that may touch the ground in this step, on B bodies.

    Attributes:
        frame_jacobian: J_f, velocity of each body's frame, world-aligned (6 B, nv).
        spread: S, from those to the velocity of each point in the axes of its ground, normal last (3 n, 6 B).
        gap: height of each point above its ground (n,), m.
        friction: Coulomb coefficient of each point (n,).
        ground_velocity: of the ground that carries each body's frame along, world-aligned (6 B,), m/s and rad/s.
    """

    frame_jacobian: np.ndarray
    spread: np.ndarray
    gap: np.ndarray
    friction: np.ndarray
    ground_velocity: np.ndarray

    @property
    def jacobian(self) -> np.ndarray:
        """J = S J_f, velocity of each point in the axes of its ground, normal last (3 n, nv)."""
        return self.spread @ self.frame_jacobian


@dataclass(frozen=True, slots=True)
class ContactSolution:
    """What the ground does during one step.

    Attributes:
        velocity: generalized velocity at the end of the step (nv,).
        impulse: impulse of the ground on each point in the axes of its ground (n, 3), N s.
        frame_impulse: the same as S^T lambda: linear and angular impulse on each body about the origin of its
            frame, world axes (B, 6), N s and N m s.
        residual: how far velocities and impulses are from the laws of contact, m/s and N s.
        iterations: how many the solver has needed.
    """

    velocity: np.ndarray
    impulse: np.ndarray
    frame_impulse: np.ndarray
    residual: float
    iterations: int


def solve_contact(
    mass_matrix: np.ndarray,
    free_impulse: np.ndarray,
    velocity: np.ndarray,
    contacts: Contacts,
    timestep: float,
) -> ContactSolution:
    """Velocity at the end of a step and the contact impulses that lead there.

    H (v+ - v) = free_impulse + J^T lambda, with lambda in the friction cone and complementary to the motion.

    Args:
        mass_matrix: H (nv, nv).
        free_impulse: impulse of everything but contact (nv,), N s and N m s.
        velocity: generalized velocity at the start of the step (nv,).
        contacts: the points that may touch; none at all is allowed.
        timestep: length of the step, s.

    Raises:
        SimulationError: H is not positive definite, that is: the state is not finite any more.
    """
    answer = resting(
        mass_matrix,
        free_impulse,
        velocity,
        contacts.frame_jacobian,
        contacts.spread,
        contacts.gap,
        contacts.friction,
        contacts.ground_velocity,
        timestep,
    )
    if answer[-1] <= _PRECISION:
        return ContactSolution(*answer, iterations=0)
    return _sliding(mass_matrix, free_impulse, velocity, contacts, closing_speed(contacts.gap, timestep))


def _sliding(
    mass_matrix: np.ndarray,
    free_impulse: np.ndarray,
    velocity: np.ndarray,
    contacts: Contacts,
    closing: np.ndarray,
) -> ContactSolution:
    """The same by a solver, for points that slide, lift, or come to rest under other impulses than the smallest."""
    factor = mass_matrix.copy()
    if not factorize(factor):
        raise SimulationError(
            "the mass matrix is not positive definite: the state has left the finite numbers"
        )
    free_velocity, half, coupling, drift = contact_problem(
        factor, free_impulse, velocity, contacts.frame_jacobian
    )
    drift -= contacts.ground_velocity
    solver = _solve_cones(coupling, drift, closing, contacts)
    impulse = solver.getPrimalSolution().copy()  # read-only
    velocity, frame_impulse = moved(factor, half, free_velocity, contacts.spread, impulse)
    return ContactSolution(
        velocity=velocity,
        impulse=impulse.reshape(-1, 3),
        frame_impulse=frame_impulse,
        residual=float(solver.getAbsoluteConvergenceResidual()),
        iterations=int(solver.getIterationCount()),
    )


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


def _solve_cones(
    coupling: np.ndarray, drift: np.ndarray, closing: np.ndarray, contacts: Contacts
) -> pin.ADMMContactSolver:
    """A solver that has found impulses in the friction cones with W lambda + g complementary to them."""
    spread, size = contacts.spread, 3 * closing.size
    delassus = spread @ coupling @ spread.T
    drift = spread @ drift
    drift[2::3] += closing
    solver = pin.ADMMContactSolver(size)
    precision = _PRECISION if closing.size <= _POINTS_OF_SOLES else _PRECISION_LYING
    solver.setAbsolutePrecision(precision)
    solver.setRelativePrecision(1e-3 * precision)
    solver.setMaxIterations(_MAX_ITERATIONS)
    cones = _cones(tuple(contacts.friction.tolist()))
    solver.solve(pin.DelassusOperatorDense(delassus), drift, cones, _no_compliance(size))
    return solver


@lru_cache(maxsize=64)
def _cones(friction: tuple[float, ...]) -> pin.StdVec_CoulombFrictionCone:
    cones = pin.StdVec_CoulombFrictionCone()
    for coefficient in friction:
        cones.append(pin.CoulombFrictionCone(coefficient))
    return cones


@lru_cache(maxsize=64)
def _no_compliance(size: int) -> np.ndarray:
    return np.zeros(size)
