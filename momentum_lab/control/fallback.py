"""Torques for when there is no control law to follow: in the air, after a failed solve, after a fall."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from momentum_lab.control.controller import ControlOutput, JointMotion, Reference
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics

# A joint this far from its posture gets its full torque, rad.
_FULL_TORQUE_ANGLE = 0.3
# Ratio of damping to stiffness, s.
_DAMPING_TIME = 0.05

HOLD_IN_WORDS = "holding the posture with joint springs"
NO_FOOT = "no foot is on the ground"


def in_words(reference: Reference, reason: str) -> str | None:
    """Why the posture is held; None in the air, for a reference that is made for it: then nothing has failed."""
    if reason == NO_FOOT and reference.in_the_air is not None:
        return None
    return f"{reason}; {HOLD_IN_WORDS}"


def hold_posture(robot: RobotModel, dynamics: Dynamics, reference: Reference) -> np.ndarray:
    """Springs and dampers at the joints (na,), N m: the torque of a tick whose controller has no answer.

    tau = k (theta_d - theta) + d (theta_d' - theta'), with k the torque limit over 0.3 rad and d = 0.05 s k. What
    the reference has for the air is a motion that nothing but the joints can cause: there they do it.
    """
    if reference.in_the_air is not None:
        return follow_in_the_air(robot, dynamics, reference.in_the_air)
    return _springs(robot, dynamics, reference.posture_ahead(_DAMPING_TIME))


def follow_in_the_air(robot: RobotModel, dynamics: Dynamics, motion: JointMotion) -> np.ndarray:
    """Torques (na,), N m, for joints that move as told while nothing outside holds the robot.

    With a = (a_b, theta_d''), H_bb a_b = -H_bj theta_d'' - (C v + tau_g)_b says how the free base gives way, and
    tau = (H a + C v + tau_g)_j takes it into account; springs and dampers correct what remains.
    """
    mass_matrix, other = dynamics.mass_matrix, dynamics.nonlinear_effects
    base = np.linalg.solve(mass_matrix[:6, :6], -mass_matrix[:6, 6:] @ motion.acceleration - other[:6])
    needed = mass_matrix[6:, :6] @ base + mass_matrix[6:, 6:] @ motion.acceleration + other[6:]
    return np.asarray(needed + _springs(robot, dynamics, motion.angle + _DAMPING_TIME * motion.rate))


def _springs(robot: RobotModel, dynamics: Dynamics, ahead: np.ndarray) -> np.ndarray:
    """Springs and dampers towards the angles that the joints shall have 0.05 s later (na,), N m."""
    stiffness = robot.effort_limit / _FULL_TORQUE_ANGLE
    state = dynamics.state
    return np.asarray(stiffness * (ahead - state.q[7:] - _DAMPING_TIME * state.v[6:]))


def hold(
    robot: RobotModel, dynamics: Dynamics, reference: Reference, reason: str, memory: Any
) -> ControlOutput:
    """The answer of a controller that has none: the posture held by joint springs, and why."""
    return replace(
        without_ground(robot, dynamics, memory),
        torque=hold_posture(robot, dynamics, reference),
        failure=in_words(reference, reason),
    )


def limp(robot: RobotModel, dynamics: Dynamics, memory: Any) -> ControlOutput:
    """The answer for a robot that has fallen: dampers at the joints, tau = - d theta' with d as above."""
    damping = _DAMPING_TIME * robot.effort_limit / _FULL_TORQUE_ANGLE
    return replace(without_ground(robot, dynamics, memory), torque=-damping * dynamics.state.v[6:])


def without_ground(robot: RobotModel, dynamics: Dynamics, memory: Any) -> ControlOutput:
    """An answer with no torque that asks nothing of the ground: what then remains is the weight."""
    nowhere = np.full(2, np.nan)
    weight = np.array([0.0, 0.0, -robot.mass * GRAVITY, 0.0, 0.0, 0.0])
    return ControlOutput(
        torque=np.zeros(robot.na),
        acceleration=np.zeros(robot.nv),
        momentum_rate_desired=weight,
        momentum_rate_admissible=weight,
        foot_wrench_admissible=np.zeros((len(robot.soles), 6)),
        cop_desired=nowhere,
        cop_admissible=nowhere,
        failure=None,
        memory=memory,
    )
