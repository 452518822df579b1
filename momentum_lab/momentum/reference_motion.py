"""A momentum to aim at that fits the task: that of a kinematic motion (section 5.3.2, Herzog et al. 2014)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from momentum_lab.momentum.directions import directions
from momentum_lab.momentum.resolved import resolved_rates
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics, State

_COM_ONLY = directions("linear")


@dataclass(frozen=True, slots=True)
class ReferenceMotion:
    """A motion by kinematics alone, N ticks; it knows no forces and may be impossible.

    Attributes:
        q: configurations (N, nq), m and rad.
        v: rates (N, nv), m/s and rad/s.
        momentum: h_d = [l_d; k_d] = A_G(q) v about the CoM (N, 6), N s and N m s (Eq. 15).
    """

    q: np.ndarray
    v: np.ndarray
    momentum: np.ndarray


def reference_motion(
    robot: RobotModel,
    q: np.ndarray,
    stance: tuple[int, ...],
    com_velocity: np.ndarray,
    joint_rates: np.ndarray,
    timestep: float,
) -> ReferenceMotion:
    """Integrate the rates nearest to those of a task, with stance feet that stay and a CoM that moves as told.

    Eq. 26 with l_d = m dr_d alone: the angular momentum is whatever the task makes it.

    Args:
        robot: the robot.
        q: where the motion starts (nq,), m and rad.
        stance: the feet that stay, as indices.
        com_velocity: dr_d of every tick (N, 3), m/s.
        joint_rates: what the task asks of the joints in every tick (N, na), rad/s.
        timestep: s.

    Returns:
        The motion and its momentum.
    """
    rest = np.zeros(robot.nv)
    footholds = robot.at(State(q, rest))
    path, rates, momenta = [], [], []
    for velocity, task in zip(com_velocity, joint_rates, strict=True):
        here = robot.at(State(q, rest))
        feet = here.sole_jacobian[list(stance)].reshape(-1, robot.nv)
        back = _way_back(footholds, here, stance) / timestep
        momentum = np.concatenate([robot.mass * velocity, np.zeros(3)])
        wish = np.concatenate([np.zeros(6), task])
        v = resolved_rates(feet, back, here.centroidal_map, momentum, wish, _COM_ONLY)
        path.append(q)
        rates.append(v)
        momenta.append(here.centroidal_map @ v)
        q = robot.integrate(q, v * timestep)
    return ReferenceMotion(np.array(path), np.array(rates), np.array(momenta))


def _way_back(footholds: Dynamics, here: Dynamics, stance: tuple[int, ...]) -> np.ndarray:
    """What brings drifted stance soles back to their footholds, world axes (6 S,), m and rad."""
    return np.concatenate(
        [
            np.concatenate(
                [
                    footholds.sole_position[foot] - here.sole_position[foot],
                    pin.log3(footholds.sole_rotation[foot] @ here.sole_rotation[foot].T),
                ]
            )
            for foot in stance
        ]
    )
