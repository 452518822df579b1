"""Output tasks: what shall move how, as y'' = J a + Psi against y''_d (Eqs. 42 to 45)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from momentum_lab.control.controller import Reference
from momentum_lab.control.stance_motion import Affine
from momentum_lab.momentum.directions import Directions
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics

AXES = ("x", "y", "z")


@dataclass(frozen=True, slots=True)
class Spring:
    """The feedback law of an output, Eq. 42: y''_d = Gamma_p (y_d - y) + Gamma_d (y'_d - y').

    Attributes:
        stiffness: Gamma_p, 1/s^2.
        damping: Gamma_d, 1/s.
    """

    stiffness: float
    damping: float


@dataclass(frozen=True, slots=True)
class Output:
    """One output y of the robot in one state.

    Attributes:
        name: what it is.
        jacobian: J, with y' = J v (k, nv).
        bias: Psi = dJ/dt v (k,).
        desired: y''_d (k,), m/s^2 or rad/s^2.
        weight: of its slack in Eq. 62.
        parts: what its k components are called, where each of them is told by itself.
    """

    name: str
    jacobian: np.ndarray
    bias: np.ndarray
    desired: np.ndarray
    weight: float
    parts: tuple[str, ...] = ()

    def slack(self, acceleration: np.ndarray) -> np.ndarray:
        """y''_slack = y''_d - (J a + Psi) (k,): what an acceleration (nv,) leaves undone (Eq. 61)."""
        return self.desired - self.jacobian @ acceleration - self.bias


def com_output(
    mass: float, dynamics: Dynamics, reference: Reference, spring: Spring, weight: float
) -> Output:
    """Position of the CoM along the axes that are asked for; J = A_lin / m."""
    axes = [axis for axis in range(3) if reference.controlled[axis]]
    desired = reference.com_acceleration + spring.damping * (reference.com_velocity - dynamics.com_velocity)
    desired += spring.stiffness * (reference.com - dynamics.com_in_world)
    return Output(
        "com",
        dynamics.centroidal_map[axes] / mass,
        dynamics.centroidal_bias[axes] / mass,
        desired[axes],
        weight,
        tuple(AXES[axis] for axis in axes),
    )


def momentum_outputs(
    mass: float,
    dynamics: Dynamics,
    rate: np.ndarray,
    controlled: Directions,
    linear_weight: float,
    angular_weight: float,
) -> list[Output]:
    """Linear and angular momentum along the directions that are asked for, as accelerations.

    S dl / m and (S I_G S^T)^-1 S dk, S choosing rows: divided by mass and inertia they weigh alike.

    Args:
        mass: m, kg.
        dynamics: the state with everything computed.
        rate: [dl_d; dk_d] (6,), N and N m.
        controlled: the directions that are asked for (section 5.3.1).
        linear_weight: of the linear part.
        angular_weight: of the angular part.
    """
    linear = [i for i in range(3) if controlled[i]]
    angular = [i for i in range(3) if controlled[3 + i]]
    spinning = [3 + i for i in angular]
    turn = np.linalg.inv(dynamics.locked_inertia[np.ix_(angular, angular)])
    A, bias = dynamics.centroidal_map, dynamics.centroidal_bias
    return [
        Output("linear momentum", A[linear] / mass, bias[linear] / mass, rate[linear] / mass, linear_weight),
        Output(
            "angular momentum",
            turn @ A[spinning],
            turn @ bias[spinning],
            turn @ rate[spinning],
            angular_weight,
        ),
    ]


def pelvis_output(dynamics: Dynamics, reference: Reference, spring: Spring, weight: float) -> Output:
    """Orientation of the pelvis; the error is the rotation vector log(R_d R^T), world axes."""
    jacobian = dynamics.pelvis_jacobian[3:]
    error = pin.log3(reference.pelvis_rotation @ dynamics.pelvis_rotation.T)
    desired = spring.stiffness * error - spring.damping * (jacobian @ dynamics.state.v)
    return Output("pelvis", jacobian, dynamics.pelvis_bias[3:], desired, weight, AXES)


def sole_output(dynamics: Dynamics, foot: int, goal: pin.SE3, spring: Spring, weight: float) -> Output:
    """Pose of a lifted sole: position, then rotation vector, world axes."""
    jacobian = dynamics.sole_jacobian[foot]
    turn = pin.log3(goal.rotation @ dynamics.sole_rotation[foot].T)
    error = np.concatenate([goal.translation - dynamics.sole_position[foot], turn])
    desired = spring.stiffness * error - spring.damping * (jacobian @ dynamics.state.v)
    return Output("swing foot", jacobian, dynamics.sole_bias[foot], desired, weight)


def posture_output(
    dynamics: Dynamics, reference: Reference, joints: np.ndarray, spring: Spring, weight: float
) -> Output:
    """Angles of some joints."""
    error = reference.posture[joints] - dynamics.state.q[7 + joints]
    desired = spring.stiffness * error - spring.damping * dynamics.state.v[6 + joints]
    if reference.posture_rate is not None:
        desired += spring.damping * reference.posture_rate[joints]
    jacobian = np.zeros((len(joints), len(dynamics.state.v)))
    jacobian[np.arange(len(joints)), 6 + joints] = 1.0
    return Output("posture", jacobian, np.zeros(len(joints)), desired, weight)


class LiftedSoles:
    """Where a posture puts the feet that do not carry, seen from a foot that does.

    Args:
        robot: the robot.
    """

    def __init__(self, robot: RobotModel) -> None:
        self._robot = robot
        self._data = robot.model.createData()
        self._base = pin.neutral(robot.model)[:7]
        self._known: tuple[bytes, list[pin.SE3]] = (b"", [])

    def goal(self, dynamics: Dynamics, posture: np.ndarray, foot: int, seen_from: int) -> pin.SE3:
        """The pose of a lifted sole in the world for joint angles `posture` (na,), m and axes."""
        soles = self._soles(posture)
        ground = pin.SE3(dynamics.sole_rotation[seen_from], dynamics.sole_position[seen_from])
        return ground * soles[seen_from].actInv(soles[foot])

    def _soles(self, posture: np.ndarray) -> list[pin.SE3]:
        """All sole poses for a posture; the last answer is kept, goals seldom change."""
        key = posture.tobytes()
        if key != self._known[0]:
            q = np.concatenate([self._base, posture])
            pin.framesForwardKinematics(self._robot.model, self._data, q)
            self._known = key, [self._data.oMf[sole.frame].copy() for sole in self._robot.soles]
        return self._known[1]


def least_squares(outputs: Sequence[Output], acceleration: Affine) -> tuple[np.ndarray, np.ndarray]:
    """The cost sum W |y''_d - y''|^2 / 2 over all outputs as 1/2 x^T P x + c^T x, with a = S x + s.

    Args:
        outputs: the outputs with their weights.
        acceleration: a as a function of x (nv from n).

    Returns:
        P (n, n) and c (n,).
    """
    jacobian = np.concatenate([output.jacobian for output in outputs])
    weight = np.concatenate([np.full(len(output.desired), output.weight) for output in outputs])
    missing = np.concatenate([output.slack(acceleration.offset) for output in outputs])
    rows = jacobian @ acceleration.matrix
    weighted = rows.T * weight
    return weighted @ rows, -weighted @ missing


def lightened(
    hessian: np.ndarray, gradient: np.ndarray, outputs: Sequence[Output]
) -> tuple[np.ndarray, np.ndarray]:
    """The same objective with 1 as its largest weight: no output may outweigh the price of soft bounds."""
    heaviest = max(output.weight for output in outputs)
    return hessian / heaviest, gradient / heaviest
