"""Quantities over time that several figures look at, from what a run has recorded."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from momentum_lab.session import Session

# The desired CoP lies outside what the ground can give when it is farther than this from the granted one, m.
OUTSIDE = 1e-4


def times(session: Session) -> np.ndarray:
    """Simulated time (n,), s."""
    return session.recording.column("time")


def push_start(session: Session) -> float:
    """When the first push begins, s; 0 without a push."""
    return min((push.start for push in session.pushes), default=0.0)


def push_end(session: Session) -> float:
    """When the last push is over, s; 0 without a push."""
    return max((push.start + push.duration for push in session.pushes), default=0.0)


def upright(session: Session) -> np.ndarray:
    """The ticks (n,) before a fall."""
    return session.recording.column("fallen") == 0.0


def saturated(session: Session) -> np.ndarray:
    """The ticks (n,) on which the desired CoP is not admissible."""
    column = session.recording.column
    return np.linalg.norm(column("cop_desired") - column("cop_admissible"), axis=1) > OUTSIDE


def rate_gap(session: Session) -> np.ndarray:
    """Desired minus admissible momentum rate (n, 6), N and N m."""
    column = session.recording.column
    return column("momentum_rate_desired") - column("momentum_rate_admissible")


def foot_cops(session: Session, wrench: str) -> np.ndarray:
    """CoP of each foot along the world axes, from its sole origin (n, F, 2), m: p = (-m_y, m_x) / f_z."""
    wrenches = session.recording.column(wrench)
    force = np.where(wrenches[..., 2] > 1.0, wrenches[..., 2], np.nan)
    return np.stack([-wrenches[..., 4], wrenches[..., 3]], axis=-1) / force[..., None]


def momentum_slope(session: Session) -> np.ndarray:
    """Differences of the recorded momentum over a tick (n - 1, 6), N and N m: a rate that knows no forces."""
    return np.diff(session.recording.column("momentum"), axis=0) / session.scenario.timestep


def ground_force(session: Session) -> np.ndarray:
    """Net ground reaction force (n, 3), N."""
    return session.recording.column("foot_wrench_measured")[..., :3].sum(axis=1)


def com_moved(session: Session) -> np.ndarray:
    """Horizontal way of the CoM from its start (n, 2), m."""
    com = session.recording.column("com")[:, :2]
    return com - com[0]


def pelvis_turn(session: Session) -> np.ndarray:
    """Rotation vector of the pelvis from where it started, world axes (n, 3), rad."""
    axes = [pin.Quaternion(q).toRotationMatrix() for q in session.recording.column("q")[:, 3:7]]
    return np.array([pin.log3(rotation @ axes[0].T) for rotation in axes])


def motion_done(session: Session) -> np.ndarray:
    """How far the joints of the scenario's motion are on their way (n, joints): 1 is all of it."""
    reach = session.steering.motion_reach
    moving = np.flatnonzero(reach)
    angles = session.recording.column("q")[:, 7 + moving]
    return np.asarray((angles - angles[0]) / reach[moving])


def com_outside_goal(session: Session) -> np.ndarray:
    """CoM minus the mean of the stance soles' centres, horizontal (n, 2), m: minus the error of Eq. 42.

    The stance soles lie flat, so that only their heading turns the centres.
    """
    column, stance = session.recording.column, list(session.stance)
    poses = column("sole_pose")[:, stance]
    local = np.array(
        [(session.robot.soles[foot].lower + session.robot.soles[foot].upper) / 2.0 for foot in stance]
    )
    yaw = 2.0 * np.arctan2(poses[..., 5], poses[..., 6])
    x = np.cos(yaw) * local[:, 0] - np.sin(yaw) * local[:, 1]
    y = np.sin(yaw) * local[:, 0] + np.cos(yaw) * local[:, 1]
    centers = poses[..., :2] + np.stack([x, y], axis=-1)
    return column("com")[:, :2] - centers.mean(axis=1)
