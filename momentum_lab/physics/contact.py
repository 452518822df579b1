"""Frictional unilateral contact of rigid bodies, solved as one impulse problem per step.

For every contact point with velocity u = W lambda + g against its ground, in the axes of that ground, the
impulse lambda obeys Signorini's and Coulomb's laws: it lies in the friction cone, the normal velocity does not
close the gap, and a point that slides is braked against its sliding. W = J H^-1 J^T is the Delassus matrix and g
the velocity without contact, less that of a moving ground, plus gap / dt along the normals.

The points of one body move with its frame, so J = S J_f with the Jacobians J_f of few frames, and W is
S (J_f H^-1 J_f^T) S^T: on two feet 12 columns go through the Cholesky factor of H instead of 24. Pinocchio's own
contact Cholesky needs twice the time for the same, and projected Gauss-Seidel was 4 % off after 2000 iterations,
so the dense form with Pinocchio's ADMM is used (exact second-order cones, 5 iterations while standing,
velocities right to 1e-10 m/s). The many points of a robot that lies share its weight in no definite way, and ADMM
needs a thousand iterations: there it is the fallback of an interior point method. Both start cold every step: a step
depends on nothing but its arguments.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import pinocchio as pin

from momentum_lab.cholesky import factorize
from momentum_lab.errors import SimulationError
from momentum_lab.physics.contact_terms import closing_speed, contact_problem, moved, resting
from momentum_lab.physics.interior_point import cone_impulses

# Velocities are right to this, m/s: a foot that stands for a minute creeps by less than a micrometre.
_PRECISION = 1e-9
# With more points than two soles have, ADMM would take ten times as long to converge as far, to no one's benefit.
_POINTS_OF_SOLES = 8
_PRECISION_OF_MANY = 1e-6
_MAX_ITERATIONS = 2000
# Velocities of a robot that lies are right to this, m/s: in a minute it creeps by less than a micrometre.
_PRECISION_LYING = 1e-8

# Impulses (3 n,) in the friction cones with W lambda + g complementary to them, from W, g and the friction (n,), how
# far they are from that, and how many iterations they took.
_Solver = Callable[[np.ndarray, np.ndarray, np.ndarray], tuple[np.ndarray, float, int]]


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
    return _solved(mass_matrix, free_impulse, velocity, contacts, timestep, _by_admm)


def solve_lying(
    mass_matrix: np.ndarray,
    free_impulse: np.ndarray,
    velocity: np.ndarray,
    contacts: Contacts,
    timestep: float,
) -> ContactSolution:
    """The same as `solve_contact`, fast for points on many bodies, which are never all at rest."""
    return _solved(mass_matrix, free_impulse, velocity, contacts, timestep, _by_interior_point)


def _solved(
    mass_matrix: np.ndarray,
    free_impulse: np.ndarray,
    velocity: np.ndarray,
    contacts: Contacts,
    timestep: float,
    solver: _Solver,
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
    spread = contacts.spread
    drift = spread @ drift
    drift[2::3] += closing_speed(contacts.gap, timestep)
    impulse, residual, iterations = solver(spread @ coupling @ spread.T, drift, contacts.friction)
    velocity, frame_impulse = moved(factor, half, free_velocity, spread, impulse)
    return ContactSolution(velocity, impulse.reshape(-1, 3), frame_impulse, residual, iterations)


def _by_interior_point(
    delassus: np.ndarray, drift: np.ndarray, friction: np.ndarray
) -> tuple[np.ndarray, float, int]:
    answer = cone_impulses(delassus, drift, friction, _PRECISION_LYING)
    return answer if answer[1] <= _PRECISION_LYING else _by_admm(delassus, drift, friction)


def _by_admm(delassus: np.ndarray, drift: np.ndarray, friction: np.ndarray) -> tuple[np.ndarray, float, int]:
    solver = pin.ADMMContactSolver(drift.size)
    precision = _PRECISION if friction.size <= _POINTS_OF_SOLES else _PRECISION_OF_MANY
    solver.setAbsolutePrecision(precision)
    solver.setRelativePrecision(1e-3 * precision)
    solver.setMaxIterations(_MAX_ITERATIONS)
    cones = _cones(tuple(friction.tolist()))
    solver.solve(pin.DelassusOperatorDense(delassus), drift, cones, _no_compliance(drift.size))
    impulse = solver.getPrimalSolution().copy()  # read-only
    return impulse, float(solver.getAbsoluteConvergenceResidual()), int(solver.getIterationCount())


@lru_cache(maxsize=64)
def _cones(friction: tuple[float, ...]) -> pin.StdVec_CoulombFrictionCone:
    cones = pin.StdVec_CoulombFrictionCone()
    for coefficient in friction:
        cones.append(pin.CoulombFrictionCone(coefficient))
    return cones


@lru_cache(maxsize=64)
def _no_compliance(size: int) -> np.ndarray:
    return np.zeros(size)
