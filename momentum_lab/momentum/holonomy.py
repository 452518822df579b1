"""Turning without angular momentum: what a loop of the joints does to a body that nothing holds."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from momentum_lab.robot.model import RobotModel


def floating_base_rates(centroidal_map: np.ndarray, joint_rates: np.ndarray) -> np.ndarray:
    """Rates of the base (6,) for joint rates at zero momentum: A_G v = 0 (Eq. 15), A_b v_b = -A_j theta'.

    Args:
        centroidal_map: A_G (6, nv).
        joint_rates: theta' (na,), rad/s.

    Returns:
        Linear and angular velocity of the base in its own axes (6,), m/s and rad/s.
    """
    return np.asarray(np.linalg.solve(centroidal_map[:, :6], -centroidal_map[:, 6:] @ joint_rates))


def floating_path(robot: RobotModel, q: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """Configurations (N, nq), m and rad, of a robot that goes through joint angles with h_G = 0 throughout.

    No forces, no masses beyond A_G, no time: only the order of the angles counts, not how fast they pass. k = 0 is
    a rate that has no integral, so a loop of the angles that ends where it began leaves the body turned, by an
    angle that depends on the loop alone (a geometric phase). Each step takes A_G at its middle, errors are of the
    second order in the step.

    Args:
        robot: the robot.
        q: where it starts (nq,), m and rad; its joint angles are `angles[0]`.
        angles: the path of the joints (N, na), rad.
    """
    model, data = robot.model, robot.model.createData()
    path = [q]
    for step in np.diff(angles, axis=0):
        here = path[-1]
        start = _step(model, data, here, step)
        middle = pin.integrate(model, here, 0.5 * start)
        path.append(pin.integrate(model, here, _step(model, data, middle, step)))
    return np.array(path)


def _step(model: pin.Model, data: pin.Data, q: np.ndarray, joints: np.ndarray) -> np.ndarray:
    """What base and joints do (nv,), m and rad, in a step of the joints, with A_G at a configuration."""
    base = floating_base_rates(pin.computeCentroidalMap(model, data, q), joints)
    return np.concatenate([base, joints])


def turn_between(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Rotation vector in the world (3,), rad, that takes the base of one configuration (nq,) to that of another."""
    first, last = (pin.Quaternion(q[3:7]).toRotationMatrix() for q in (start, end))
    return np.asarray(pin.log3(last @ first.T))
