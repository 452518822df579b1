"""Frictional unilateral contact of rigid bodies, solved as one impulse problem per step.

For every contact point with velocity u = W lambda + g in its ground axes, the impulse lambda obeys Signorini's
and Coulomb's laws: it lies in the friction cone, the normal velocity does not close the gap, and a point that
slides is braked against its sliding. W = J H^-1 J^T is the Delassus matrix and g the velocity without contact
plus gap / dt along the normals.

Measured on TALOS with 8 points (24 rows, rank 12): forming W from one Cholesky factor of H takes about 45 us
and Pinocchio's ADMM solver 4 us for 5 iterations, with exact second-order cones and velocities right to 1e-10
m/s. Pinocchio's own contact Cholesky needs 41 us for the same factorisation and projected Gauss-Seidel was 4 %
off after 2000 iterations, so the dense form with ADMM is used, started cold every step: a step depends on
nothing but its arguments.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import pinocchio as pin
from scipy.linalg import lapack

from momentum_lab.errors import SimulationError

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
    """Points of the robot that may touch the ground in this step.

    Attributes:
        jacobian: velocity of each point in the axes of its ground, normal last (3 n, nv).
        gap: height of each point above its ground (n,), m.
        friction: Coulomb coefficient of each point (n,).
    """

    jacobian: np.ndarray
    gap: np.ndarray
    friction: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class ContactSolution:
    """What the ground does during one step.

    Attributes:
        velocity: generalized velocity at the end of the step (nv,).
        impulse: impulse of the ground on each point in the axes of its ground (n, 3), N s.
        residual: how far velocities and impulses are from the laws of contact, m/s and N s.
        iterations: how many the solver has needed.
    """

    velocity: np.ndarray
    impulse: np.ndarray
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
    factor, failed = lapack.dpotrf(mass_matrix, lower=1)
    # LAPACK lets NaN pass; one anywhere in H reaches the last entry of the factor.
    if failed or not math.isfinite(factor[-1, -1]):
        raise SimulationError(
            "the mass matrix is not positive definite: the state has left the finite numbers"
        )
    free_velocity = velocity + lapack.dpotrs(factor, free_impulse, lower=1)[0]
    if not contacts.gap.size:
        return ContactSolution(free_velocity, np.zeros((0, 3)), 0.0, 0)
    half = lapack.dtrtrs(factor, contacts.jacobian.T, lower=1)[0]
    delassus = half.T @ half
    drift = contacts.jacobian @ free_velocity
    drift[2::3] += _closing_speed(contacts.gap, timestep)
    solver = _solve_cones(delassus, drift, contacts.friction)
    impulse = solver.getPrimalSolution()
    velocity = free_velocity + lapack.dtrtrs(factor, half @ impulse, lower=1, trans=1)[0]
    return ContactSolution(
        velocity,
        impulse.reshape(-1, 3),
        residual=float(solver.getAbsoluteConvergenceResidual()),
        iterations=int(solver.getIterationCount()),
    )


def _closing_speed(gap: np.ndarray, timestep: float) -> np.ndarray:
    """Speed at which a gap may close within the step, or (negative) at which a penetration must open.

    Linear through zero: the corners of a flat foot, nanometres up or down, then ask for one rigid motion. With
    a kink there the solver needs up to twenty times the iterations.
    """
    deep = np.clip(_RECOVERY_RATE * gap, -_RECOVERY_SPEED, -_GENTLE_SPEED)
    return np.maximum(gap / timestep, deep)


def _solve_cones(
    delassus: np.ndarray, drift: np.ndarray, friction: tuple[float, ...]
) -> pin.ADMMContactSolver:
    """A solver that has found impulses in the friction cones with W lambda + g complementary to them."""
    size = drift.size
    solver = pin.ADMMContactSolver(size)
    precision = _PRECISION if len(friction) <= _POINTS_OF_SOLES else _PRECISION_LYING
    solver.setAbsolutePrecision(precision)
    solver.setRelativePrecision(1e-3 * precision)
    solver.setMaxIterations(_MAX_ITERATIONS)
    solver.solve(pin.DelassusOperatorDense(delassus), drift, _cones(friction), _no_compliance(size))
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
