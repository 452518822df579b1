"""Whose angular momentum it is: the part of some joints, and the part of everything else."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from momentum_lab.robot.state import State
from momentum_lab.session import Session


@lru_cache(2)
def of_speeds(session: Session) -> np.ndarray:
    """What every speed adds to the angular momentum about the CoM (n, 3, nv), N m s (Eq. 16)."""
    column = session.recording.column
    return np.array(
        [
            session.robot.at(State(q, v)).centroidal_map[3:] * v
            for q, v in zip(column("q"), column("v"), strict=True)
        ]
    )


def of_motion(session: Session) -> np.ndarray:
    """Angular momentum of the joints that the scenario's motion moves (n, 3), N m s."""
    return np.asarray(of_speeds(session)[:, :, 6 + np.flatnonzero(session.steering.motion_reach)].sum(axis=2))


def of_rest(session: Session) -> np.ndarray:
    """Angular momentum of everything else (n, 3), N m s."""
    return np.asarray(of_speeds(session).sum(axis=2) - of_motion(session))


def of_body(session: Session) -> np.ndarray:
    """Angular momentum of the robot turning as one, its joints still (n, 3), N m s."""
    return np.asarray(of_speeds(session)[:, :, :6].sum(axis=2))


def of_joints(session: Session) -> np.ndarray:
    """Angular momentum that all joints add to that (n, 3), N m s."""
    return np.asarray(of_speeds(session)[:, :, 6:].sum(axis=2))


def taken_back(session: Session, axis: int) -> float:
    """The part of the motion's largest angular momentum about an axis that the rest takes back then, %."""
    moved, rest = of_motion(session)[:, axis], of_rest(session)[:, axis]
    tick = int(np.abs(moved).argmax())
    return 100.0 * float(-rest[tick] / moved[tick])
