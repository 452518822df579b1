"""How the robot of a new session stands: it can be drawn while the session's own process still starts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from momentum_lab.session import Session


@dataclass(frozen=True, slots=True)
class FirstPose:
    """How the robot of a session stands as it begins.

    Attributes:
        robot: its name.
        q: its configuration (nq,).
        com_height: of its CoM, m.
    """

    robot: str
    q: np.ndarray
    com_height: float

    @classmethod
    def of(cls, session: Session) -> FirstPose:
        """Of a session that has not begun."""
        return cls(session.scenario.robot, session.state.q, float(session.dynamics.com_in_world[2]))
