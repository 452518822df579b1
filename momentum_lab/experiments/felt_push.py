"""What a push does at the feet before any controller can notice it."""

from __future__ import annotations

import numpy as np

from momentum_lab.experiments.measured import foot_cops, times
from momentum_lab.physics.push import apply_pushes
from momentum_lab.robot.state import Dynamics, State
from momentum_lab.session import Session

# A push smaller than this is the rounding of its last instant, N or N m.
_PUSHED = 1e-6


def passed_on(dynamics: Dynamics, generalized: np.ndarray) -> np.ndarray:
    """What feet that stay where they are feel of generalized forces (nv,) at given joint torques (F, 6), N and N m.

    Between the push and the soles are joints that keep their torques and have inertia: with J of all soles and
    J a = 0 before and after, the ground's wrenches change by -(J H^-1 J^T)^-1 J H^-1 tau.
    """
    jacobian = dynamics.sole_jacobian.reshape(-1, generalized.size)
    freely = np.linalg.solve(dynamics.mass_matrix, jacobian.T)
    return -np.linalg.solve(jacobian @ freely, freely.T @ generalized).reshape(-1, 6)


def cop_with_the_push(session: Session) -> np.ndarray:
    """CoP x of each foot from its sole origin (n, F), m: the admissible one with what the push adds.

    NaN on ticks without a push, and from the first on which it is beyond a sole: then the soles lie flat no more.
    """
    column, robot = session.recording.column, session.robot
    data = robot.model.createData()
    cops = np.full((len(times(session)), len(robot.soles)), np.nan)
    for tick, time in enumerate(times(session)):
        if np.abs(column("push_wrench")[tick]).max() < _PUSHED:
            continue
        dynamics = robot.at(State(column("q")[tick], column("v")[tick]))
        push = apply_pushes(robot, data, dynamics, session.pushes, time, session.scenario.timestep)
        if push is None:
            continue
        wrench = column("foot_wrench_admissible")[tick] + passed_on(dynamics, push.generalized)
        cops[tick] = -wrench[:, 4] / wrench[:, 2]
    back, front = np.array([(sole.lower[0], sole.upper[0]) for sole in robot.soles]).T
    cops[np.logical_or.accumulate(((cops < back) | (cops > front)).any(axis=1))] = np.nan
    return cops


def off_the_push(session: Session) -> float:
    """How far the measured CoP is from the one with the push at most, while it lasts, m."""
    off = foot_cops(session, "foot_wrench_measured")[:, :, 0] - cop_with_the_push(session)
    return float(np.nanmax(np.abs(off))) if np.isfinite(off).any() else float("nan")
