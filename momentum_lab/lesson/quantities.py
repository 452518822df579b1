"""Quantities that many lessons show, ready to stand in an equation: x forward, y left, z up, in the world."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from momentum_lab.experiments.measured import ground_force, momentum_slope, push_end
from momentum_lab.lesson.equation import Symbol
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.session import Session


def recorded(name: str, *place: int) -> Callable[[Session], np.ndarray]:
    """A recorded quantity over time (n,), or one component of it.

    Args:
        name: a column of the recording.
        place: indices of the component.
    """
    component: Any = (..., *place)
    return lambda session: session.recording.column(name)[component]


def weight(session: Session) -> float:
    """M g, N."""
    return session.robot.mass * GRAVITY


def granted_force_up(session: Session) -> np.ndarray:
    """The vertical force that the controller counts on (n,), N: f_z = dl_z + m g (Eq. 2)."""
    return recorded("momentum_rate_admissible", 2)(session) + weight(session)


def push_force(session: Session) -> float:
    """Force of the first push, N."""
    return session.pushes[0].force or 0.0


def toes(session: Session) -> float:
    """The front edge of the feet where they stood first, x, m."""
    return float(session.recording.column("sole_pose")[0, :, 0].mean() + session.robot.soles[0].upper[0])


def pendulum_rate(session: Session) -> np.ndarray:
    """How fast a pendulum as high as the CoM falls (n,), 1/s: omega = sqrt(g / r_z)."""
    return np.asarray(np.sqrt(GRAVITY / session.recording.column("com")[:, 2]))


def capture_rate(session: Session) -> np.ndarray:
    """Rate of the capture point from differences over a tick, m/s, until the ground carries less than 0.9 m g."""
    rate = np.diff(session.recording.column("capture_point")[:, 0]) / session.scenario.timestep
    light = ground_force(session)[:, 2] <= 0.9 * weight(session)
    after = np.flatnonzero(light & (session.recording.column("time") > push_end(session)))
    return np.asarray(rate[: int(after[0])] if len(after) else rate)


COM_X = Symbol(recorded("com", 0), "m", "CoM, forward", ".4f")
COM_Y = Symbol(recorded("com", 1), "m", "CoM, to the left", ".4f")
COM_Z = Symbol(recorded("com", 2), "m", "CoM, height", ".4f")
COM_SPEED_X = Symbol(recorded("com_velocity", 0), "m/s", "speed of the CoM", ".3f")
COP_X = Symbol(recorded("cop_measured", 0), "m", "CoP, forward", ".4f")
COP_Y = Symbol(recorded("cop_measured", 1), "m", "CoP, to the left", ".4f")
COP_WANTED_X = Symbol(recorded("cop_desired", 0), "m", "CoP, desired", ".4f")
COP_GRANTED_X = Symbol(recorded("cop_admissible", 0), "m", "CoP, granted", ".4f")
CMP_X = Symbol(recorded("cmp", 0), "m", "CMP, forward", ".4f")
CMP_Y = Symbol(recorded("cmp", 1), "m", "CMP, to the left", ".4f")
CAPTURE_X = Symbol(recorded("capture_point", 0), "m", "capture point, forward", ".4f")
FORCE_X = Symbol(lambda session: ground_force(session)[:, 0], "N", "force of the ground, forward")
FORCE_Z = Symbol(lambda session: ground_force(session)[:, 2], "N", "force of the ground, up")
FORCE_GRANTED_Z = Symbol(granted_force_up, "N", "force of the ground, up")
BRAKING_GRANTED = Symbol(recorded("momentum_rate_admissible", 0), "N", "rate of linear momentum, granted")
TURNING_WANTED = Symbol(
    recorded("momentum_rate_desired", 4), "N m", "rate of angular momentum, desired", ".1f"
)
TURNING_GRANTED = Symbol(
    recorded("momentum_rate_admissible", 4), "N m", "rate of angular momentum, granted", ".1f"
)
# The motion of all links, differenced over a tick: rates that know no forces.
BRAKING = Symbol(
    lambda session: momentum_slope(session)[:, 0], "N", "rate of linear momentum, from the links"
)
TURNING = Symbol(
    lambda session: momentum_slope(session)[:, 4], "N m", "rate of angular momentum, from the links", ".1f"
)
ROLLING = Symbol(
    lambda session: momentum_slope(session)[:, 3],
    "N m",
    "rate of angular momentum about x, from the links",
    ".1f",
)
PENDULUM_RATE = Symbol(pendulum_rate, "1/s", "the pendulum's rate", ".2f")
CAPTURE_RATE = Symbol(capture_rate, "m/s", "rate of the capture point", ".3f")
