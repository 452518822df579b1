"""Situations a controller is asked about: standing still, moving, and the moments of a push."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from momentum_lab.control.accelerations import AccelerationProgram, MotionWeights
from momentum_lab.control.controller import Reference
from momentum_lab.control.foot_forces import FootForces, ForceBounds, LoadSharing
from momentum_lab.control.footing import Footing
from momentum_lab.control.standing import StandingGoal
from momentum_lab.momentum.foot_ground import FootGround
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.posture import standing_posture
from momentum_lab.robot.state import Dynamics, State
from tests.runs import forward_push, played

G = 9.81
BOTH = (0, 1)
LEVEL = FootGround.level(2)


def home(robot: RobotModel, stance: tuple[int, ...] = BOTH) -> Dynamics:
    """The standing posture at rest."""
    q = standing_posture(robot, [robot.foot_names[foot] for foot in stance])
    return robot.at(State(q, np.zeros(robot.nv)))


def goal(robot: RobotModel, dynamics: Dynamics, stance: tuple[int, ...] = BOTH) -> Reference:
    """Standing in the home posture of a stance, for a state."""
    return StandingGoal(robot, home(robot, stance), stance).reference(dynamics, LEVEL)


def null_space(matrix: np.ndarray) -> np.ndarray:
    """Orthonormal columns that a matrix maps to zero."""
    _, values, rows = np.linalg.svd(matrix)
    return rows[np.sum(values > 1e-10 * values[0]) :].T


def swaying(
    robot: RobotModel, rng: np.random.Generator, stance: tuple[int, ...] = BOTH, speed: float = 0.3
) -> Dynamics:
    """Near the home posture, moving at random with the stance feet still."""
    at_home = home(robot, stance)
    free = null_space(at_home.sole_jacobian[list(stance)].reshape(-1, robot.nv))
    q = pin.integrate(robot.model, at_home.state.q, free @ rng.normal(scale=0.01, size=free.shape[1]))
    still = robot.at(State(q, np.zeros(robot.nv)))
    free = null_space(still.sole_jacobian[list(stance)].reshape(-1, robot.nv))
    return robot.at(State(q, free @ rng.normal(scale=speed, size=free.shape[1])))


def feet_for(
    robot: RobotModel, dynamics: Dynamics, rate: np.ndarray, stance: tuple[int, ...] = BOTH
) -> FootForces:
    """Admissible foot forces next to a momentum rate (6,)."""
    bounds = ForceBounds(friction=0.6, normal_moment=0.018, least_force=0.02 * robot.mass * G)
    force = rate[:3] + np.array([0.0, 0.0, robot.mass * G])
    stance_feet = Footing(robot).stance_feet(dynamics, stance, 0.005)
    return LoadSharing(robot).share(stance_feet, force, rate[3:], bounds)


def accelerations_for(
    robot: RobotModel, dynamics: Dynamics, feet: FootForces, reference: Reference, weights: MotionWeights
) -> np.ndarray:
    """The answer of Eq. 34 (nv,)."""
    return AccelerationProgram(robot, reference.stance).solve(dynamics, feet, reference, weights)


def moments_of_a_push(robot: RobotModel, every: int = 40) -> list[Dynamics]:
    """States before, in and after the chapter's push."""
    recording = played(robot, forward_push(robot)).recording
    rows = zip(recording.column("q")[150:900:every], recording.column("v")[150:900:every], strict=True)
    return [robot.at(State(q, v)) for q, v in rows]
