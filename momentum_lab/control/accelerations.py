"""Which accelerations give an admissible momentum rate: the chapter's Eq. 34 as one quadratic program."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from momentum_lab.control.acceleration_terms import BEFORE_THE_STOP, acceleration_program, standing_feet
from momentum_lab.control.controller import Reference
from momentum_lab.control.foot_forces import FootForces
from momentum_lab.control.qp import QuadraticProgram, solve
from momentum_lab.momentum.centroidal import momentum_rate
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics

# Keeps the program strictly convex where neither momentum nor posture decides.
_RIDGE = 1e-6


@dataclass(frozen=True, slots=True)
class MotionWeights:
    """What matters in Eq. 34, and how firmly.

    Attributes:
        momentum: w_b, against 1 - w_b for everything else.
        pelvis: weight of the pelvis orientation against one joint of the upper body.
        stiffness: of posture and pelvis, 1/s^2.
        damping: of posture and pelvis, 1/s.
        contact_rate: kappa, at which stance feet come to rest and lie flat, 1/s.
        joint_limit_rate: at which joints brake before their limits, 1/s.
    """

    momentum: float
    pelvis: float
    stiffness: float
    damping: float
    contact_rate: float
    joint_limit_rate: float


class AccelerationProgram:
    """Eq. 34 for one robot on some of its feet; what does not change from tick to tick is built once.

    Args:
        robot: the robot.
        stance: the feet that carry it, as indices.
    """

    def __init__(self, robot: RobotModel, stance: tuple[int, ...]) -> None:
        self.robot = robot
        self.stance = stance
        self._free_joints = _free_joints(robot, stance)
        contact = np.zeros(6 * len(stance), dtype=bool)
        joints = np.ones(robot.na, dtype=bool)
        self._soft = np.concatenate([np.zeros(6, dtype=bool), joints, contact, joints])
        self._labels = _labels(robot, stance)

    def solve(
        self, dynamics: Dynamics, feet: FootForces, reference: Reference, weights: MotionWeights
    ) -> np.ndarray:
        """Generalized accelerations that give a momentum rate, keep the feet still and mind the posture.

        min w_b |W (dh_a - A_G a - dA_G v)|^2 + (1 - w_b) (|theta''_d - theta''|^2 + w_p |omega'_d - omega'|^2)
        subject to J_c a = dv_c - dJ_c v and theta''_l <= theta'' <= theta''_u (Eqs. 31, 32, 34, with squared
        norms). W = diag(1 / m, I_G^-1) makes momentum rates into accelerations. Joints of feet that do not
        carry follow the posture like the upper body.

        Two extensions: the pelvis term, and torque limits. The foot forces are known by now, so torques are
        linear in a, and |H_s a + C_s v + tau_g,s - J_c,s^T f_c| <= tau_max keeps the motors from being asked
        for what they cannot give. Bounds of joints and torques yield where nothing else is possible; the
        contact does not.

        Args:
            dynamics: the state with everything computed.
            feet: admissible wrenches of the feet and the momentum rate dh_a they cause.
            reference: the posture, the pelvis axes and the plates under the feet.
            weights: what matters how much.

        Returns:
            Accelerations a (nv,), m/s^2 and rad/s^2.

        Raises:
            SolverError: no acceleration keeps the feet still.
        """
        program = self._program(
            dynamics,
            dynamics.centroidal_map,
            feet.momentum_rate - dynamics.centroidal_bias,
            feet.wrench,
            reference,
            weights,
        )
        return solve(QuadraticProgram(*program, self._labels, self._soft)).x

    def rate_with_free_directions(
        self, dynamics: Dynamics, desired: np.ndarray, reference: Reference, weights: MotionWeights
    ) -> np.ndarray:
        """The desired momentum rate with what posture and pelvis bring about in directions not asked for.

        dh = A_G a + dA_G v with the a of Eq. 34 when only the rows of the controlled directions count, the feet
        stay still, and the ground gives all: no bound presses, so it is one linear system.

        Args:
            dynamics: the state with everything computed.
            desired: dh_d (6,), N and N m, of which the controlled directions count.
            reference: the posture, the pelvis axes, the plates under the feet, the controlled directions.
            weights: what matters how much.

        Returns:
            The rate (6,), N and N m: dh_d in the controlled directions.
        """
        asked = np.array(reference.controlled)
        hessian, gradient, matrix, lower, _ = self._program(
            dynamics,
            dynamics.centroidal_map * asked[:, None],
            (desired - dynamics.centroidal_bias) * asked,
            np.zeros((len(self.robot.soles), 6)),
            reference,
            weights,
        )
        size, rows = len(gradient), 6 * len(self.stance)
        still, rest = matrix[:rows], lower[size : size + rows]
        system = np.zeros((size + rows, size + rows))
        system[:size, :size], system[size:, :size], system[:size, size:] = hessian, still, still.T
        acceleration = np.linalg.solve(system, np.concatenate([-gradient, rest]))[:size]
        return np.where(asked, desired, momentum_rate(dynamics, acceleration))

    def _program(
        self,
        dynamics: Dynamics,
        centroidal_map: np.ndarray,
        missing_rate: np.ndarray,
        wrench: np.ndarray,
        reference: Reference,
        weights: MotionWeights,
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Eq. 34 as P, c, G, lower and upper bounds: see `acceleration_program`."""
        robot, state = self.robot, dynamics.state
        return acceleration_program(
            state.q,
            state.v,
            centroidal_map,
            missing_rate,
            dynamics.locked_inertia,
            dynamics.mass_matrix,
            dynamics.nonlinear_effects,
            dynamics.pelvis_jacobian,
            dynamics.pelvis_bias,
            dynamics.pelvis_rotation,
            reference.pelvis_rotation,
            _indices(self.stance),
            dynamics.sole_jacobian,
            dynamics.sole_bias,
            dynamics.sole_position,
            dynamics.sole_rotation,
            reference.ground.position,
            reference.ground.rotation,
            reference.ground.velocity,
            reference.ground.acceleration,
            wrench,
            reference.posture_ahead(weights.damping / weights.stiffness if weights.stiffness else 0.0),
            self._free_joints,
            robot.position_lower,
            robot.position_upper,
            robot.effort_limit,
            robot.mass,
            weights.momentum,
            weights.pelvis,
            _RIDGE,
            weights.stiffness,
            weights.damping,
            weights.contact_rate,
            weights.joint_limit_rate,
            BEFORE_THE_STOP,
        )


def contact_constraint(
    dynamics: Dynamics, stance: tuple[int, ...], reference: Reference, contact_rate: float
) -> tuple[np.ndarray, np.ndarray]:
    """Rows J_c (6 S, nv) and values dv_c - dJ_c v (6 S,) that keep S feet on their plates: see `standing_feet`."""
    return standing_feet(
        _indices(stance),
        dynamics.sole_jacobian,
        dynamics.sole_bias,
        dynamics.sole_position,
        dynamics.sole_rotation,
        reference.ground.position,
        reference.ground.rotation,
        reference.ground.velocity,
        reference.ground.acceleration,
        dynamics.state.v,
        contact_rate,
    )


@lru_cache(maxsize=16)
def _indices(stance: tuple[int, ...]) -> np.ndarray:
    return np.array(stance)


def _free_joints(robot: RobotModel, stance: tuple[int, ...]) -> np.ndarray:
    """1 for joints that carry nothing (upper body, legs of lifted feet), 0 for everything else (nv,)."""
    free = np.zeros(robot.nv)
    free[6 + robot.upper_body] = 1.0
    for foot, sole in enumerate(robot.soles):
        if foot not in stance:
            free[6 + sole.joints] = 1.0
    return free


def _labels(robot: RobotModel, stance: tuple[int, ...]) -> tuple[tuple[int, str], ...]:
    joints = ((1, f"limit of joint {name}") for name in robot.joint_names)
    feet = ((6, f"contact of the {robot.foot_names[foot]} foot") for foot in stance)
    torques = ((1, f"torque limit of {name}") for name in robot.joint_names)
    return ((6, "free base"), *joints, *feet, *torques)
