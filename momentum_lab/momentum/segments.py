"""How every link moves when the joints accelerate: positions of the links' CoMs and Eq. 60."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from momentum_lab.momentum.wrench import cross, skew
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import State

_WORLD_ALIGNED = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED


@dataclass(frozen=True, slots=True)
class Segments:
    """All N links with mass in one state, world axes; links welded together count as one.

    Attributes:
        mass: m_i (N,), kg.
        position: CoM of each link r_i (N, 3), m.
        spin: angular velocity omega_i (N, 3), rad/s.
        inertia: about the link's own CoM, I_i = R I R^T (N, 3, 3), kg m^2.
        linear_jacobian: velocities of the links' CoMs from v (N, 3, nv).
        angular_jacobian: angular velocities from v (N, 3, nv).
        linear_bias: accelerations of the links' CoMs at zero joint acceleration (N, 3), m/s^2.
        angular_bias: angular accelerations at zero joint acceleration (N, 3), rad/s^2.
    """

    mass: np.ndarray
    position: np.ndarray
    spin: np.ndarray
    inertia: np.ndarray
    linear_jacobian: np.ndarray
    angular_jacobian: np.ndarray
    linear_bias: np.ndarray
    angular_bias: np.ndarray

    def stacked_jacobian(self) -> np.ndarray:
        """J_r of Eq. 60 (6 N, nv), rows in the order of `stacked_acceleration`."""
        per_axis = np.concatenate([self.linear_jacobian, self.angular_jacobian], axis=1)
        return per_axis.transpose(1, 0, 2).reshape(6 * len(self.mass), -1)

    def stacked_bias(self) -> np.ndarray:
        """Psi_r of Eq. 60 (6 N,)."""
        return np.concatenate([self.linear_bias, self.angular_bias], axis=1).T.ravel()

    def stacked_acceleration(self, acceleration: np.ndarray) -> np.ndarray:
        """y_r'' = J_r a + Psi_r (Eq. 60), in the order of Eq. 54 with omega_z' added.

        Args:
            acceleration: generalized acceleration a (nv,).

        Returns:
            [r_x''; r_y''; r_z''; omega_x'; omega_y'; omega_z'], each of N links (6 N,), m/s^2 and rad/s^2.
        """
        return self.stacked_jacobian() @ acceleration + self.stacked_bias()


def segments(robot: RobotModel, state: State) -> Segments:
    """All links with mass in a state.

    Args:
        robot: the robot.
        state: configuration and velocity.

    Returns:
        Their masses, positions, inertias and the maps of Eq. 60 from joint to link accelerations.
    """
    model, data = robot.model, robot.model.createData()
    pin.computeJointJacobians(model, data, state.q)
    pin.forwardKinematics(model, data, state.q, state.v, np.zeros(robot.nv))
    links = [
        _link(model, data, joint) for joint in range(1, model.njoints) if model.inertias[joint].mass > 0.0
    ]
    return Segments(*(np.array(column) for column in zip(*links, strict=True)))


def _link(model: pin.Model, data: pin.Data, joint: int) -> tuple[float | np.ndarray, ...]:
    """One link's entries of `Segments`, in their order."""
    body, rotation = model.inertias[joint], data.oMi[joint].rotation
    lever = rotation @ body.lever
    jacobian = pin.getJointJacobian(model, data, joint, _WORLD_ALIGNED)
    spin = rotation @ data.v[joint].angular
    turning = rotation @ data.a[joint].angular
    origin = pin.getClassicalAcceleration(model, data, joint, _WORLD_ALIGNED).linear
    return (
        body.mass,
        data.oMi[joint].translation + lever,
        spin,
        rotation @ body.inertia @ rotation.T,
        jacobian[:3] - skew(lever) @ jacobian[3:],
        jacobian[3:],
        origin + cross(turning, lever) + cross(spin, cross(spin, lever)),
        turning,
    )
