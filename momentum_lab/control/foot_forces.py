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

from momentum_lab.control.qp import QuadraticProgram, solve
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.momentum.support import inset_rectangle, support_polygon
from momentum_lab.momentum.wrench import cross, shift_wrench, skew
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics

_COM = np.zeros(3)
# A sole this far above the ground, m, is no longer counted on; contact itself lifts less.
_IN_THE_AIR = 0.005
_FACETS = 8
# Stage 1: weights of the angular rate against the force, and of small forces against both.
_ANGULAR_WEIGHT = 0.02
_SMALL_FORCE_WEIGHT = 1e-4
# Stage 2: what a metre of CoP shift and a newton metre of normal moment cost, against a newton metre of error.
_COP_SHIFT_WEIGHT = 0.03
_NORMAL_MOMENT_WEIGHT = 0.003


@dataclass(frozen=True, slots=True)
class StanceFoot:
    """A foot that carries the robot, as the controller sees it.

    Attributes:
        index: which foot.
        com_to_ankle: from the CoM to the ankle, world axes (3,), m.
        rotation: axes of the sole in the world (3, 3).
        lower: rear right corner of the safe rectangle, from the ankle, sole axes (2,), m.
        upper: front left corner, likewise (2,), m.
        ankle_in_sole: the ankle in the sole frame (3,), m.
    """

    index: int
    com_to_ankle: np.ndarray
    rotation: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    ankle_in_sole: np.ndarray


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


class Footing:
    """The feet of a robot as places where the ground can push back.

    Args:
        robot: the robot.
    """

    def __init__(self, robot: RobotModel) -> None:
        self.mass = robot.mass
        self.soles = robot.soles
        self.ankles = [
            robot.model.frames[sole.frame].placement.inverse().translation.copy() for sole in robot.soles
        ]

    def safe_polygon(self, dynamics: Dynamics, stance: tuple[int, ...], border: float) -> np.ndarray:
        """Support polygon of the stance soles without a border (m), counter-clockwise (K, 2), m."""
        corners = [
            dynamics.sole_position[foot] + self._safe_corners(foot, border) @ dynamics.sole_rotation[foot].T
            for foot in stance
        ]
        return support_polygon(np.concatenate(corners))

    def stance_feet(self, dynamics: Dynamics, stance: tuple[int, ...], border: float) -> list[StanceFoot]:
        """The stance feet with their safe rectangles."""
        feet = []
        for foot in stance:
            ankle, rotation = self.ankles[foot], dynamics.sole_rotation[foot]
            lower, upper = inset_rectangle(self.soles[foot].lower, self.soles[foot].upper, border)
            to_ankle = dynamics.sole_position[foot] + rotation @ ankle - dynamics.com_in_world
            feet.append(StanceFoot(foot, to_ankle, rotation, lower - ankle[:2], upper - ankle[:2], ankle))
        return feet

    def on_the_ground(
        self, dynamics: Dynamics, stance: tuple[int, ...], sole_height: np.ndarray
    ) -> tuple[int, ...]:
        """The stance feet whose soles are near the ground: a foot in the air carries nothing.

        Args:
            dynamics: the state with everything computed.
            stance: the feet that are meant to carry, as indices.
            sole_height: height of the ground under each sole (F,), m.
        """
        return tuple(
            foot
            for foot in stance
            if _lowest_corner(self.soles[foot].corners, dynamics, foot) - sole_height[foot] < _IN_THE_AIR
        )

    def _safe_corners(self, foot: int, border: float) -> np.ndarray:
        """Corners of the safe rectangle in the sole frame (4, 3), m."""
        (rear, right), (front, left) = inset_rectangle(self.soles[foot].lower, self.soles[foot].upper, border)
        return np.array(((rear, right, 0.0), (front, right, 0.0), (front, left, 0.0), (rear, left, 0.0)))

    def share(
        self, feet: list[StanceFoot], force: np.ndarray, angular_rate: np.ndarray, bounds: ForceBounds
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
        if len(feet) == 1:
            forces = force.reshape(1, 3)
            sole_moments = _single_cop(feet[0], force, angular_rate, bounds)
        else:
            forces = _forces(feet, force, angular_rate, bounds, self._labels(feet))
            sole_moments = _cops(feet, forces, angular_rate, bounds)
        return self._recombine(feet, forces, sole_moments)

    def _recombine(self, feet: list[StanceFoot], forces: np.ndarray, sole_moments: np.ndarray) -> FootForces:
        """Wrenches about the sole origins and the momentum rate they cause (Eqs. 1, 2)."""
        wrench = np.zeros((len(self.soles), 6))
        rate = np.array([0.0, 0.0, -self.mass * GRAVITY, 0.0, 0.0, 0.0])
        for foot, force, (x, y, normal) in zip(feet, forces, sole_moments, strict=True):
            com_to_cop = foot.com_to_ankle + foot.rotation @ np.array((x, y, -foot.ankle_in_sole[2]))
            com_to_sole = foot.com_to_ankle - foot.rotation @ foot.ankle_in_sole
            at_cop = np.concatenate((force, normal * foot.rotation[:, 2]))
            wrench[foot.index] = shift_wrench(at_cop, com_to_cop, com_to_sole)
            rate += shift_wrench(at_cop, com_to_cop, _COM)
        return FootForces(wrench, rate)

    def _labels(self, feet: list[StanceFoot]) -> tuple[tuple[int, str], ...]:
        per_foot = [
            ((_FACETS, f"friction of the {name} foot"), (1, f"least force of the {name} foot"))
            for name in (self.soles[foot.index].name for foot in feet)
        ]
        return ((3 * len(feet), "unbounded"), *(label for labels in per_foot for label in labels))


def _lowest_corner(corners: np.ndarray, dynamics: Dynamics, foot: int) -> float:
    """Height of the lowest corner of a sole in the world, m."""
    return float(dynamics.sole_position[foot, 2] + (corners @ dynamics.sole_rotation[foot, 2]).min())


def _single_cop(
    foot: StanceFoot, force: np.ndarray, angular_rate: np.ndarray, bounds: ForceBounds
) -> np.ndarray:
    """CoP offset from the ankle and normal moment (1, 3) of the only foot: Eqs. 40, 41 in sole axes, clipped."""
    local = foot.rotation.T @ force
    moment = foot.rotation.T @ (angular_rate - cross(foot.com_to_ankle, force))
    fx, fy, fn = local.tolist()
    height = foot.ankle_in_sole[2]
    x = min(max((-moment[1] - height * fx) / fn, foot.lower[0]), foot.upper[0])
    y = min(max((moment[0] - height * fy) / fn, foot.lower[1]), foot.upper[1])
    limit = bounds.normal_moment * fn
    normal = min(max(moment[2] - (x * fy - y * fx), -limit), limit)
    return np.array([[x, y, normal]])


def _forces(
    feet: list[StanceFoot],
    force: np.ndarray,
    angular_rate: np.ndarray,
    bounds: ForceBounds,
    labels: tuple[tuple[int, str], ...],
) -> np.ndarray:
    """Stage 1: forces at the ankles (F, 3), N.

    min |f - sum f_i|^2 + w^2 |dk/dt - sum (a_i - r_G) x f_i|^2 + e^2 sum |f_i|^2, each f_i in a pyramid inside
    its friction cone and pressing with at least the least force.
    """
    count = len(feet)
    levers = np.hstack([skew(foot.com_to_ankle) for foot in feet])
    weight = _ANGULAR_WEIGHT**2
    hessian = weight * (levers.T @ levers) + _summing(count)
    gradient = -(weight * (angular_rate @ levers))
    gradient -= np.concatenate((force,) * count)
    rows = _FACETS + 1
    matrix, upper = np.zeros((count * rows, 3 * count)), np.zeros(count * (3 + rows))
    pyramid = _pyramid(bounds.friction)
    for i, foot in enumerate(feet):
        matrix[i * rows : (i + 1) * rows, 3 * i : 3 * i + 3] = pyramid @ foot.rotation.T
    upper[: 3 * count] = np.inf
    upper[3 * count + _FACETS :: rows] = -bounds.least_force
    problem = QuadraticProgram(hessian, gradient, matrix, np.full(upper.size, -np.inf), upper, labels)
    return solve(problem).x.reshape(count, 3)


@lru_cache(maxsize=8)
def _summing(count: int) -> np.ndarray:
    """Quadratic form |sum f_i|^2 + e^2 sum |f_i|^2 (3 count, 3 count)."""
    return np.tile(np.eye(3), (count, count)) + _SMALL_FORCE_WEIGHT**2 * np.eye(3 * count)


@lru_cache(maxsize=64)
def _pyramid(friction: float) -> np.ndarray:
    """Rows n with n . f <= 0 inside a pyramid within the friction cone, then one with -f_n (facets + 1, 3)."""
    angle = 2.0 * math.pi * np.arange(_FACETS) / _FACETS
    inscribed = friction * math.cos(math.pi / _FACETS)
    facets = np.column_stack([np.cos(angle), np.sin(angle), np.full(_FACETS, -inscribed)])
    return np.vstack([facets, [0.0, 0.0, -1.0]])


def _cops(
    feet: list[StanceFoot], forces: np.ndarray, angular_rate: np.ndarray, bounds: ForceBounds
) -> np.ndarray:
    """Stage 2: CoP offsets from the ankles and normal moments (F, 3), m and N m.

    min |Psi eta - kappa|^2 + |e (eta - eta_d)|^2 within the safe soles, eta = (d_x, d_y, tau_n) per foot and
    eta_d the point below which the ankle feels no torque.
    """
    count = len(feet)
    levers = np.zeros((3, 3 * count))
    remaining = angular_rate.copy()
    lower, upper, easy = np.zeros(3 * count), np.zeros(3 * count), np.zeros(3 * count)
    for i, (foot, force) in enumerate(zip(feet, forces, strict=True)):
        turned = -skew(force) @ foot.rotation
        at = slice(3 * i, 3 * i + 3)
        levers[:, at] = turned
        levers[:, 3 * i + 2] = foot.rotation[:, 2]
        height = foot.ankle_in_sole[2]
        remaining -= cross(foot.com_to_ankle, force) - height * turned[:, 2]
        fx, fy, fn = (foot.rotation.T @ force).tolist()
        limit = bounds.normal_moment * fn
        lower[at] = foot.lower[0], foot.lower[1], -limit
        upper[at] = foot.upper[0], foot.upper[1], limit
        easy[at] = -height * fx / fn, -height * fy / fn, 0.0
    cost = np.array((_COP_SHIFT_WEIGHT, _COP_SHIFT_WEIGHT, _NORMAL_MOMENT_WEIGHT) * count) ** 2
    hessian = levers.T @ levers
    hessian.flat[:: 3 * count + 1] += cost
    gradient = -remaining @ levers - cost * easy
    problem = QuadraticProgram(hessian, gradient, np.zeros((0, 3 * count)), lower, upper)
    return solve(problem).x.reshape(count, 3)
