"""The bounds that every controller of a standing robot shares: contact, soles, torques, joints."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from momentum_lab.control.qp import QuadraticProgram
from momentum_lab.control.stance_motion import Affine, StanceMotion
from momentum_lab.control.wrench_cone import ROWS, wrench_cone
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.momentum.support import inset_rectangle
from momentum_lab.momentum.wrench import wrench_shift_map
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics

# Joints are to turn back this far before their mechanical stops, rad.
_BEFORE_THE_STOP = 0.03


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
        self._centers = [(robot.soles[foot].lower + robot.soles[foot].upper) / 2.0 for foot in carrying]
        equalities, cones = 6 * (len(stance) - 1), ROWS * len(carrying)
        self._soft = np.ones(robot.na + self._free + equalities + cones + robot.na, dtype=bool)
        self._soft[robot.na : -robot.na] = False
        self._labels = _labels(robot, stance, carrying)

    def problem(
        self,
        hessian: np.ndarray,
        gradient: np.ndarray,
        dynamics: Dynamics,
        motion: StanceMotion,
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
            bounds: what ground and joints are trusted with.
        """
        cone, cone_bound = self._cones(dynamics, motion.wrench, bounds)
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
        """
        matrix, offset = np.empty_like(wrench.matrix), np.empty_like(wrench.offset)
        for i, to_center in enumerate(self._to_centers(dynamics)):
            at = slice(6 * i, 6 * i + 6)
            matrix[at], offset[at] = to_center @ wrench.matrix[at], to_center @ wrench.offset[at]
        offset[2::6] -= self._weight / len(self.carrying)
        return Affine(matrix / self._weight, offset / self._weight)

    def _cones(
        self, dynamics: Dynamics, wrench: Affine, bounds: StanceBounds
    ) -> tuple[np.ndarray, np.ndarray]:
        """Rows (17 C, n) and bounds (17 C,) of the admissible wrenches, in parts of the weight."""
        count = ROWS * len(self.carrying)
        matrix, limit = np.empty((count, wrench.matrix.shape[1])), np.empty(count)
        for i, (foot, to_center) in enumerate(zip(self.carrying, self._to_centers(dynamics), strict=True)):
            sole = self.robot.soles[foot]
            lower, upper = inset_rectangle(sole.lower, sole.upper, bounds.border)
            x_half, y_half = ((upper - lower) / 2.0).tolist()
            cone, bound = wrench_cone(x_half, y_half, bounds.friction, bounds.least_force * self._weight)
            rows, at = slice(ROWS * i, ROWS * (i + 1)), slice(6 * i, 6 * i + 6)
            local = cone @ to_center
            matrix[rows], limit[rows] = local @ wrench.matrix[at], bound - local @ wrench.offset[at]
        return matrix / self._weight, limit / self._weight

    def _to_centers(self, dynamics: Dynamics) -> list[np.ndarray]:
        """From wrenches about the sole origins, world axes, to those about the soles' centres, sole axes."""
        maps = []
        for foot, center in zip(self.carrying, self._centers, strict=True):
            turn = np.zeros((6, 6))
            turn[:3, :3] = turn[3:, 3:] = dynamics.sole_rotation[foot].T
            maps.append(wrench_shift_map(np.zeros(3), np.append(center, 0.0)) @ turn)
        return maps


def joint_bounds(robot: RobotModel, dynamics: Dynamics, rate: float) -> tuple[np.ndarray, np.ndarray]:
    """Accelerations (na,), rad/s^2, between which joints brake critically damped before their limits."""
    angle, braking = dynamics.state.q[7:], -2.0 * rate * dynamics.state.v[6:]
    low = rate**2 * (robot.position_lower + _BEFORE_THE_STOP - angle) + braking
    high = rate**2 * (robot.position_upper - _BEFORE_THE_STOP - angle) + braking
    return low, high


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
