"""A drop with a push in the air: what the push gives is kept, while the pose changes."""

from __future__ import annotations

import numpy as np

from momentum_lab.experiments.choice import chosen
from momentum_lab.experiments.claims import Claim, at_least, at_most, largest
from momentum_lab.experiments.measured import momentum_slope, pelvis_turn, push_end, push_start, times
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.scenario import Scenario, changed
from momentum_lab.session import Session

PUSHED, PUSHED_FINER = "pushed", "pushed, half the tick"


def scenarios(robot: str | None) -> dict[str, Scenario]:
    """The drop, and the same with half the tick, to tell the integrator's error from a leak."""
    scenario = chosen("flight-push", robot)
    return {PUSHED: scenario, PUSHED_FINER: changed(scenario, timestep=0.5 * scenario.timestep)}


def spin(session: Session) -> np.ndarray:
    """Angular momentum about the CoM (n, 3), N m s."""
    return session.recording.column("momentum")[:, 3:]


def given(session: Session) -> np.ndarray:
    """Angular momentum that the push gives (3,), N m s: the sum of its moments about the CoM (Eq. 1)."""
    push, com = session.recording.column("push_wrench"), session.recording.column("com")
    moment = push[:, 3:] - np.cross(com, push[:, :3])
    return moment.sum(axis=0) * session.scenario.timestep


def drift(session: Session) -> float:
    """How far the angular momentum strays from what it is when the push ends, N m s."""
    after = spin(session)[times(session) > push_end(session) + 1e-9]
    return largest(after - after[0]) if len(after) else float("nan")


def claims(session: Session, finer: Session) -> list[Claim]:
    """In the air only weight acts, and it has no moment about the CoM.

    What is kept is kept by the integrator, to first order in the tick: half the tick, half the drift.
    """
    column, clock, weight = session.recording.column, times(session), session.robot.mass * GRAVITY
    size = float(np.linalg.norm(given(session)))
    falling = clock[:-1] > push_end(session)
    after = clock > push_end(session)
    joints = column("q")[after, 7:]
    return [
        at_most("pushed: nothing touches the ground", largest(column("foot_wrench_measured")), 0.0, "N"),
        at_most(
            "pushed: before the push there is no angular momentum",
            largest(spin(session)[clock < push_start(session)]) / size,
            0.01,
            "of the push's",
        ),
        at_most(
            "pushed: the push gives what its moment says, within",
            largest(_after_push(session) - given(session)) / size,
            0.02,
            "of it",
        ),
        at_most(
            "pushed: after it the angular momentum is kept, within", drift(session) / size, 0.01, "of it"
        ),
        at_most(
            "pushed: half the tick strays less: this part of it",
            drift(finer) / drift(session),
            0.7,
            "of the drift",
        ),
        at_least("pushed: meanwhile a joint moves by", largest(joints - joints[:1]), 0.03, "rad"),
        at_least("pushed: and the pelvis turns by", largest(pelvis_turn(session)[after]), 0.2, "rad"),
        at_most(
            "pushed: the linear momentum falls with the weight, within",
            abs(float(momentum_slope(session)[falling, 2].mean()) / weight + 1.0)
            if falling.any()
            else float("nan"),
            0.005,
            "m g",
        ),
    ]


def _after_push(session: Session) -> np.ndarray:
    """Angular momentum at the first tick after the push (3,), N m s."""
    after = spin(session)[times(session) > push_end(session) - 1e-9]
    return after[0] if len(after) else np.full(3, np.nan)
