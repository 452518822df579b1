"""Which accelerations give an admissible momentum rate: the chapter's Eq. 34 as one quadratic program."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from momentum_lab.control.controller import Reference
from momentum_lab.control.foot_forces import FootForces
from momentum_lab.control.qp import QuadraticProgram, solve
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics

# Keeps the program strictly convex where neither momentum nor posture decides.
_RIDGE = 1e-6
# Joints are to turn back this far before their mechanical stops, rad.
_BEFORE_THE_STOP = 0.03


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
        lifted = [sole.joints for foot, sole in enumerate(robot.soles) if foot not in stance]
        self._posture_joints = np.concatenate([robot.upper_body, *lifted])
        self._unbounded = np.full(6, np.inf)
        bounds = 6 + robot.na + 6 * len(stance) + robot.na
        self._soft = np.ones(bounds, dtype=bool)
        self._soft[:6] = False
        self._soft[6 + robot.na : 6 + robot.na + 6 * len(stance)] = False
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
            reference: the posture, the pelvis axes and the height of the ground.
            weights: what matters how much.

        Returns:
            Accelerations a (nv,), m/s^2 and rad/s^2.

        Raises:
            SolverError: no acceleration keeps the feet still.
        """
        hessian, gradient = _momentum_objective(
            self.robot.mass, dynamics, feet.momentum_rate, weights.momentum
        )
        _add_posture(hessian, gradient, dynamics, reference, self._posture_joints, weights)
        _add_pelvis(hessian, gradient, dynamics, reference, weights)
        hessian.flat[:: self.robot.nv + 1] += _RIDGE
        still, target = contact_constraint(dynamics, self.stance, reference, weights.contact_rate)
        low, high = _joint_bounds(self.robot, dynamics, weights.joint_limit_rate)
        torque_rows, torque_offset = _torque_ratio(self.robot, dynamics, feet.wrench, self.stance)
        problem = QuadraticProgram(
            hessian,
            gradient,
            np.concatenate([still, torque_rows]),
            np.concatenate([-self._unbounded, low, target, -1.0 - torque_offset]),
            np.concatenate([self._unbounded, high, target, 1.0 - torque_offset]),
            self._labels,
            self._soft,
        )
        return solve(problem).x


def contact_constraint(
    dynamics: Dynamics, stance: tuple[int, ...], reference: Reference, contact_rate: float
) -> tuple[np.ndarray, np.ndarray]:
    """Rows J_c (6 S, nv) and values dv_c - dJ_c v (6 S,) that keep S stance feet still, flat and on the ground.

    Eq. 31 with dv_c = -2 kappa J_c v - kappa^2 e. The error e holds height and tilt only: a foot that has
    slipped stays where it is.
    """
    feet = list(stance)
    jacobian = dynamics.sole_jacobian[feet]
    target = -2.0 * contact_rate * (jacobian @ dynamics.state.v) - dynamics.sole_bias[feet]
    pull = contact_rate**2
    target[:, 2] -= pull * (dynamics.sole_position[feet, 2] - reference.sole_height[feet])
    normal = dynamics.sole_rotation[feet, :, 2]
    target[:, 3] += pull * normal[:, 1]
    target[:, 4] -= pull * normal[:, 0]
    return jacobian.reshape(-1, jacobian.shape[2]), target.ravel()


def _momentum_objective(
    mass: float, dynamics: Dynamics, rate: np.ndarray, weight: float
) -> tuple[np.ndarray, np.ndarray]:
    """w_b |W (dh_a - A_G a - dA_G v)|^2; W turns with the robot, so that its heading does not matter."""
    scale = np.zeros((6, 6))
    scale[(0, 1, 2), (0, 1, 2)] = 1.0 / mass
    scale[3:, 3:] = np.linalg.inv(dynamics.locked_inertia)
    scaled = scale @ dynamics.centroidal_map
    weighted = weight * scaled.T
    return weighted @ scaled, -weighted @ (scale @ (rate - dynamics.centroidal_bias))


def _add_posture(
    hessian: np.ndarray,
    gradient: np.ndarray,
    dynamics: Dynamics,
    reference: Reference,
    joints: np.ndarray,
    weights: MotionWeights,
) -> None:
    """theta''_d = k (theta_0 - theta) - d theta' for the joints that do not carry."""
    angle, speed = dynamics.state.q[7 + joints], dynamics.state.v[6 + joints]
    wanted = weights.stiffness * (reference.posture[joints] - angle) - weights.damping * speed
    weight = 1.0 - weights.momentum
    hessian[6 + joints, 6 + joints] += weight
    gradient[6 + joints] -= weight * wanted


def _add_pelvis(
    hessian: np.ndarray,
    gradient: np.ndarray,
    dynamics: Dynamics,
    reference: Reference,
    weights: MotionWeights,
) -> None:
    """omega'_d = -k log(R R_d^T) - d omega for the pelvis."""
    jacobian = dynamics.pelvis_jacobian[3:]
    tilt = pin.log3(dynamics.pelvis_rotation @ reference.pelvis_rotation.T)
    spin = jacobian @ dynamics.state.v
    wanted = -weights.stiffness * tilt - weights.damping * spin - dynamics.pelvis_bias[3:]
    weighted = (1.0 - weights.momentum) * weights.pelvis * jacobian.T
    hessian += weighted @ jacobian
    gradient -= weighted @ wanted


def _joint_bounds(robot: RobotModel, dynamics: Dynamics, rate: float) -> tuple[np.ndarray, np.ndarray]:
    """Accelerations theta''_l, theta''_u (na,) that brake critically damped before the joint limits."""
    angle, braking = dynamics.state.q[7:], -2.0 * rate * dynamics.state.v[6:]
    low = rate**2 * (robot.position_lower + _BEFORE_THE_STOP - angle) + braking
    high = rate**2 * (robot.position_upper - _BEFORE_THE_STOP - angle) + braking
    return low, high


def _torque_ratio(
    robot: RobotModel, dynamics: Dynamics, wrench: np.ndarray, stance: tuple[int, ...]
) -> tuple[np.ndarray, np.ndarray]:
    """Rows (na, nv) and offset (na,) of the joint torques as parts of their limits (Eq. 33)."""
    offset = dynamics.nonlinear_effects[6:].copy()
    for foot in stance:
        offset -= wrench[foot] @ dynamics.sole_jacobian[foot, :, 6:]
    return dynamics.mass_matrix[6:] / robot.effort_limit[:, None], offset / robot.effort_limit


def _labels(robot: RobotModel, stance: tuple[int, ...]) -> tuple[tuple[int, str], ...]:
    joints = ((1, f"limit of joint {name}") for name in robot.joint_names)
    feet = ((6, f"contact of the {robot.foot_names[foot]} foot") for foot in stance)
    torques = ((1, f"torque limit of {name}") for name in robot.joint_names)
    return ((6, "free base"), *joints, *feet, *torques)
