"""A controller's answer, once a quadratic program has decided how the robot moves on its feet."""

from __future__ import annotations

from typing import Any

import numpy as np

from momentum_lab.control.controller import ControlOutput
from momentum_lab.control.stance_motion import StanceMotion
from momentum_lab.momentum.ground import GRAVITY, cop_from_momentum_rate
from momentum_lab.momentum.wrench import sum_wrenches
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics


def stance_output(
    robot: RobotModel,
    dynamics: Dynamics,
    motion: StanceMotion,
    x: np.ndarray,
    carrying: tuple[int, ...],
    desired: np.ndarray,
    slack: dict[str, float],
    memory: Any = None,
) -> ControlOutput:
    """Torques, wrenches and momentum rates of a minimiser.

    Args:
        robot: the robot.
        dynamics: the state with everything computed.
        motion: what x makes of the robot.
        x: the minimiser (n,).
        carrying: the feet whose wrenches x decides.
        desired: [dl_d; dk_d] (6,), N and N m.
        slack: what the outputs have to do without, by name.
        memory: what the controller wants to be given at the next tick.
    """
    wrench = np.zeros((len(robot.soles), 6))
    wrench[list(carrying)] = motion.wrench.at(x).reshape(-1, 6)
    admissible = sum_wrenches(wrench, dynamics.sole_position, dynamics.com_in_world)
    admissible[2] -= robot.mass * GRAVITY
    height = float(dynamics.sole_position[list(carrying), 2].mean())
    com = dynamics.com_in_world
    return ControlOutput(
        torque=motion.torque.at(x),
        acceleration=motion.acceleration.at(x),
        momentum_rate_desired=desired,
        momentum_rate_admissible=admissible,
        foot_wrench_admissible=wrench,
        cop_desired=cop_from_momentum_rate(desired, com, robot.mass, height),
        cop_admissible=cop_from_momentum_rate(admissible, com, robot.mass, height),
        failure=None,
        memory=memory,
        slack=slack,
    )
