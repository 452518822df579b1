"""The bounds that every controller of a standing robot shares: contact, soles, torques, joints."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from momentum_lab.control.acceleration_terms import BEFORE_THE_STOP, braking_bounds
from momentum_lab.control.qp import QuadraticProgram
from momentum_lab.control.stance_motion import Affine, StanceMotion
from momentum_lab.control.wrench_cone import ROWS, wrench_cone
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.momentum.support import inset_rectangle
from momentum_lab.momentum.wrench import skew
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics


@dataclass(frozen=True, slots=True)
class StanceBounds:
    """What ground and joints are trusted with.

    Attributes:
        border: how far inside the edge of the sole the CoP stays, m.
        friction: Coulomb coefficient.
        least_force: least normal force of each carrying foot, as a part of the weight.
        joint_limit_rate: at which joints brake before their limits, 1/s.
    """

    border: float
    friction: float
    least_force: float
    joint_limit_rate: float


class StanceProgram:
    """The bounds of one robot on some of its feet; what does not change from tick to tick is built once.

    Args:
        robot: the robot.
        stance: the feet that stay where they are, as indices.
        carrying: those of them that are on the ground.
    """

    def __init__(self, robot: RobotModel, stance: tuple[int, ...], carrying: tuple[int, ...]) -> None:
        self.robot = robot
        self.carrying = carrying
        self._weight = robot.mass * GRAVITY
        self._free = 6 * (len(carrying) - 1)
        centers = ((robot.soles[foot].lower + robot.soles[foot].upper) / 2.0 for foot in carrying)
        self._to_center = [-skew(np.append(center, 0.0)) for center in centers]
        self._even = np.zeros(6 * len(carrying))
        self._even[2::6] = 1.0 / len(carrying)
        equalities, cones = 6 * (len(stance) - 1), ROWS * len(carrying)
        self._soft = np.ones(robot.na + self._free + equalities + cones + robot.na, dtype=bool)
        self._soft[robot.na : -robot.na] = False
        self._labels = _labels(robot, stance, carrying)
        self._known_cone: tuple[StanceBounds | None, np.ndarray, np.ndarray] = None, self._even, self._even

    def problem(
        self,
        hessian: np.ndarray,
        gradient: np.ndarray,
        dynamics: Dynamics,
        motion: StanceMotion,
        centered: Affine,
        bounds: StanceBounds,
    ) -> QuadraticProgram:
        """An objective in x = [theta''; wrenches] under all bounds.

        Feet at rest and admissible wrenches are firm. Limits of joints and torques yield where nothing else is
        possible.

        Args:
            hessian: P (n, n).
            gradient: c (n,).
            dynamics: the state with everything computed.
            motion: what x makes of the robot.
            centered: its wrenches, as `centered` gives them.
            bounds: what ground and joints are trusted with.
        """
        cone, cone_bound = self._cones(centered, bounds)
        low, high = joint_bounds(self.robot, dynamics, bounds.joint_limit_rate)
        limit = self.robot.effort_limit
        ratio, ratio_offset = motion.torque.matrix / limit[:, None], motion.torque.offset / limit
        unbounded, still = np.full(self._free, np.inf), -motion.still.offset
        return QuadraticProgram(
            hessian,
            gradient,
            np.concatenate([motion.still.matrix, cone, ratio]),
            np.concatenate([low, -unbounded, still, np.full(len(cone_bound), -np.inf), -1.0 - ratio_offset]),
            np.concatenate([high, unbounded, still, cone_bound, 1.0 - ratio_offset]),
            self._labels,
            self._soft,
        )

    def centered(self, dynamics: Dynamics, wrench: Affine) -> Affine:
        """Wrenches about the soles' centres, sole axes, less an even share of the weight.

        Zero for a robot at rest above the middle of its feet. In parts of the weight, moments per metre
        (6 C,).

        Args:
            dynamics: the state with everything computed.
            wrench: of the carrying feet about their sole origins, world axes (6 C from n).
        """
        size = 6 * len(self.carrying)
        to_centers = np.zeros((size, size))
        for i, foot in enumerate(self.carrying):
            turn = dynamics.sole_rotation[foot].T / self._weight
            force, moment = slice(6 * i, 6 * i + 3), slice(6 * i + 3, 6 * i + 6)
            to_centers[force, force] = to_centers[moment, moment] = turn
            to_centers[moment, force] = self._to_center[i] @ turn
        local = wrench.then(to_centers)
        return Affine(local.matrix, local.offset - self._even)

    def _cones(self, centered: Affine, bounds: StanceBounds) -> tuple[np.ndarray, np.ndarray]:
        """Rows (17 C, n) and bounds (17 C,) of the admissible wrenches, in parts of the weight."""
        if self._known_cone[0] != bounds:
            self._known_cone = bounds, *self._cone(bounds)
        _, cone, limit = self._known_cone
        return cone @ centered.matrix, limit - cone @ (centered.offset + self._even)

    def _cone(self, bounds: StanceBounds) -> tuple[np.ndarray, np.ndarray]:
        """The cones of all carrying feet about their centres (17 C, 6 C) and (17 C,)."""
        count = len(self.carrying)
        matrix, limit = np.zeros((ROWS * count, 6 * count)), np.zeros(ROWS * count)
        for i, foot in enumerate(self.carrying):
            sole = self.robot.soles[foot]
            lower, upper = inset_rectangle(sole.lower, sole.upper, bounds.border)
            x_half, y_half = ((upper - lower) / 2.0).tolist()
            rows = slice(ROWS * i, ROWS * (i + 1))
            matrix[rows, 6 * i : 6 * i + 6], limit[rows] = wrench_cone(
                x_half, y_half, bounds.friction, bounds.least_force
            )
        return matrix, limit


def joint_bounds(robot: RobotModel, dynamics: Dynamics, rate: float) -> tuple[np.ndarray, np.ndarray]:
    """Accelerations (na,), rad/s^2, between which joints brake critically damped before their limits."""
    return braking_bounds(
        dynamics.state.q[7:],
        dynamics.state.v[6:],
        robot.position_lower,
        robot.position_upper,
        rate,
        BEFORE_THE_STOP,
    )


def _labels(
    robot: RobotModel, stance: tuple[int, ...], carrying: tuple[int, ...]
) -> tuple[tuple[int, str], ...]:
    names = robot.foot_names
    return (
        *((1, f"limit of joint {name}") for name in robot.joint_names),
        *((6, f"wrench of the {names[foot]} foot") for foot in carrying[:-1]),
        *((6, f"contact of the {names[foot]} foot") for foot in stance if foot != carrying[0]),
        *((ROWS, f"force, friction and CoP of the {names[foot]} foot") for foot in carrying),
        *((1, f"torque limit of {name}") for name in robot.joint_names),
    )
