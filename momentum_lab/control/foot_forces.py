"""Which foot carries what: a net force and an angular momentum rate as one wrench per foot.

In single support the closed form applies. In double support two small quadratic programs answer one after the
other, following the structure of Lee and Goswami (2012): first the forces, as if they acted at the ankles, so
that ankles have little left to do; then the CoP of each foot, as close to a torque-free ankle as the angular
momentum rate allows.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from momentum_lab.control.foot_programs import (
    cop_program,
    foot_wrenches,
    force_program,
    quiet_share,
)
from momentum_lab.control.footing import StanceFeet
from momentum_lab.control.qp import CERTIFIED, QuadraticProgram, solve
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.momentum.wrench import cross
from momentum_lab.robot.model import RobotModel

FACETS = 8
# Stage 1: weights of the angular rate against the force, and of small forces against both.
_ANGULAR_WEIGHT = 0.02
_SMALL_FORCE_WEIGHT = 1e-4
# Stage 2: what a metre of CoP shift and a newton metre of normal moment cost, against a newton metre of error.
_COP_SHIFT_WEIGHT = 0.03
_NORMAL_MOMENT_WEIGHT = 0.003


@dataclass(frozen=True, slots=True)
class ForceBounds:
    """What the controller takes for granted about the ground.

    Attributes:
        friction: Coulomb coefficient.
        normal_moment: largest normal moment per normal force, m.
        least_force: least normal force of each stance foot, N.
    """

    friction: float
    normal_moment: float
    least_force: float


@dataclass(frozen=True, slots=True)
class FootForces:
    """Admissible wrenches of the ground on the feet, and what they do.

    Attributes:
        wrench: about each sole origin, world axes (F, 6), N and N m; zero for feet that do not carry.
        momentum_rate: [dl_a/dt; dk_a/dt] about the CoM (6,), N and N m.
    """

    wrench: np.ndarray
    momentum_rate: np.ndarray


class LoadSharing:
    """The load of a robot shared out among its feet.

    Args:
        robot: the robot.
    """

    def __init__(self, robot: RobotModel) -> None:
        self._weight = robot.mass * GRAVITY
        self._every_foot = tuple(range(len(robot.soles)))

    def share(
        self, feet: StanceFeet, force: np.ndarray, angular_rate: np.ndarray, bounds: ForceBounds
    ) -> FootForces:
        """Wrenches per foot that give a net force and an angular momentum rate, as far as the soles allow.

        Args:
            feet: the feet that carry the robot; a single foot has nothing to share.
            force: net ground reaction force (3,), N.
            angular_rate: dk/dt about the CoM (3,), N m.
            bounds: what the ground is trusted with.

        Raises:
            SolverError: a quadratic program has no certified answer.
        """
        if len(feet.index) == 1:
            forces = force.reshape(1, 3)
            return self._recombine(feet, forces, _single_cop(feet, force, angular_rate, bounds))
        wrenches, rate, certified = self._quietly(feet, force, angular_rate, bounds)
        if certified:
            return self._of_all(feet, wrenches, rate)
        forces = _forces(feet, force, angular_rate, bounds)
        return self._recombine(feet, forces, _cops(feet, forces, angular_rate, bounds))

    def _quietly(
        self, feet: StanceFeet, force: np.ndarray, angular_rate: np.ndarray, bounds: ForceBounds
    ) -> tuple[np.ndarray, np.ndarray, bool]:
        """Wrenches and momentum rate as if no bound stood in the way, and whether none does."""
        return quiet_share(
            feet.com_to_ankle,
            feet.com_to_sole,
            feet.rotation,
            feet.safe.ankles,
            feet.safe.lower,
            feet.safe.upper,
            force,
            angular_rate,
            _pyramid(bounds.friction),
            *_pressing(len(feet.index), bounds.least_force),
            bounds.normal_moment,
            _ANGULAR_WEIGHT,
            _SMALL_FORCE_WEIGHT,
            _COP_SHIFT_WEIGHT,
            _NORMAL_MOMENT_WEIGHT,
            self._weight,
            CERTIFIED,
        )

    def _recombine(self, feet: StanceFeet, forces: np.ndarray, sole_moments: np.ndarray) -> FootForces:
        """Wrenches about the sole origins and the momentum rate they cause (Eqs. 1, 2)."""
        carried, rate = foot_wrenches(
            forces, sole_moments, feet.rotation, feet.safe.ankles, feet.com_to_sole, self._weight
        )
        return self._of_all(feet, carried, rate)

    def _of_all(self, feet: StanceFeet, carried: np.ndarray, rate: np.ndarray) -> FootForces:
        """With zero wrenches for the feet that do not carry."""
        if feet.index == self._every_foot:
            return FootForces(carried, rate)
        wrench = np.zeros((len(self._every_foot), 6))
        wrench[list(feet.index)] = carried
        return FootForces(wrench, rate)


def _single_cop(
    feet: StanceFeet, force: np.ndarray, angular_rate: np.ndarray, bounds: ForceBounds
) -> np.ndarray:
    """CoP offset from the ankle and normal moment (1, 3) of the only foot: Eqs. 40, 41 in sole axes, clipped."""
    ankle_moment = angular_rate - cross(feet.com_to_ankle[0], force)
    fx, fy, fn = (force @ feet.rotation[0]).tolist()
    mx, my, mz = (ankle_moment @ feet.rotation[0]).tolist()
    (lower_x, lower_y), (upper_x, upper_y) = feet.safe.lower[0].tolist(), feet.safe.upper[0].tolist()
    height = feet.safe.ankles[0, 2]
    x = min(max((-my - height * fx) / fn, lower_x), upper_x)
    y = min(max((mx - height * fy) / fn, lower_y), upper_y)
    limit = bounds.normal_moment * fn
    return np.array([[x, y, min(max(mz - (x * fy - y * fx), -limit), limit)]])


def _forces(feet: StanceFeet, force: np.ndarray, angular_rate: np.ndarray, bounds: ForceBounds) -> np.ndarray:
    """Stage 1: forces at the ankles (S, 3), N.

    min |f - sum f_i|^2 + w^2 |dk/dt - sum (a_i - r_G) x f_i|^2 + e^2 sum |f_i|^2, each f_i in a pyramid inside
    its friction cone and pressing with at least the least force.
    """
    hessian, gradient, rows = force_program(
        feet.com_to_ankle,
        feet.rotation,
        force,
        angular_rate,
        _pyramid(bounds.friction),
        _ANGULAR_WEIGHT,
        _SMALL_FORCE_WEIGHT,
    )
    lower, upper = _pressing(len(feet.index), bounds.least_force)
    problem = QuadraticProgram(hessian, gradient, rows, lower, upper, _labels(feet.safe.names))
    return solve(problem).x.reshape(-1, 3)


@lru_cache(maxsize=64)
def _pyramid(friction: float) -> np.ndarray:
    """Rows n with n . f <= 0 inside a pyramid within the friction cone, then one with -f_n (facets + 1, 3)."""
    angle = 2.0 * math.pi * np.arange(FACETS) / FACETS
    inscribed = friction * math.cos(math.pi / FACETS)
    facets = np.column_stack([np.cos(angle), np.sin(angle), np.full(FACETS, -inscribed)])
    return np.vstack([facets, [0.0, 0.0, -1.0]])


@lru_cache(maxsize=64)
def _pressing(count: int, least_force: float) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper bounds of all forces and of the rows of `_pyramid` for each foot."""
    upper = np.concatenate([np.full(3 * count, np.inf), *[np.zeros(FACETS), [-least_force]] * count])
    return np.full(upper.size, -np.inf), upper


@lru_cache(maxsize=8)
def _labels(names: tuple[str, ...]) -> tuple[tuple[int, str], ...]:
    per_foot = [
        ((FACETS, f"friction of the {name} foot"), (1, f"least force of the {name} foot")) for name in names
    ]
    return ((3 * len(names), "unbounded"), *(label for labels in per_foot for label in labels))


def _cops(feet: StanceFeet, forces: np.ndarray, angular_rate: np.ndarray, bounds: ForceBounds) -> np.ndarray:
    """Stage 2: CoP offsets from the ankles and normal moments (S, 3), m and N m.

    min |Psi eta - kappa|^2 + |e (eta - eta_d)|^2 within the safe soles, eta = (d_x, d_y, tau_n) per foot and
    eta_d the point below which the ankle feels no torque.
    """
    hessian, gradient, lower, upper = cop_program(
        forces,
        feet.rotation,
        feet.com_to_ankle,
        angular_rate,
        feet.safe.ankles,
        feet.safe.lower,
        feet.safe.upper,
        bounds.normal_moment,
        _COP_SHIFT_WEIGHT,
        _NORMAL_MOMENT_WEIGHT,
    )
    problem = QuadraticProgram(hessian, gradient, _no_rows(gradient.size), lower, upper)
    return solve(problem).x.reshape(-1, 3)


@lru_cache(maxsize=8)
def _no_rows(size: int) -> np.ndarray:
    return np.zeros((0, size))
