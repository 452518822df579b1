"""Runs that several tests look at; those that were looked at last are kept."""

from __future__ import annotations

import msgspec
import numpy as np

from momentum_lab.physics.push import Push
from momentum_lab.robot.model import RobotModel
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session

# The chapter's push of Fig. 8 (120 N on 50 kg, 0.1 s) at the same velocity change of the CoM, N.
CHAPTER_PUSH = {"talos": 217.0, "g1": 80.0}
PUSH_START = 0.2
PUSH_END = 0.3

# A second of a run takes 2 MB.
_KEPT = 24
_played: dict[tuple[int, bytes], Session] = {}


def forward_push(robot: RobotModel, seconds: float = 2.5, **changes: object) -> Scenario:
    """The chapter's push from behind."""
    push = Push(force=CHAPTER_PUSH[robot.spec.name], duration=PUSH_END - PUSH_START, start=PUSH_START)
    return Scenario("forward", robot=robot.spec.name, seconds=seconds, pushes=(push,), **changes)


def play(robot: RobotModel, scenario: Scenario) -> Session:
    """A session that has run its whole scenario, on a fall too."""
    session = Session(scenario, robot=robot)
    for _ in range(round(scenario.seconds / scenario.timestep)):
        session.tick()
    return session


def played(robot: RobotModel, scenario: Scenario) -> Session:
    """The same, from memory when it has been played before; look, do not tick."""
    key = (id(robot), msgspec.json.encode(scenario))
    _played[key] = session = _played.pop(key, None) or play(robot, scenario)
    while len(_played) > _KEPT:
        del _played[next(iter(_played))]
    return session


def settled_after(session: Session, speed: float = 0.02) -> float:
    """When the CoM was faster than a speed (m/s) for the last time, s."""
    speeds = np.linalg.norm(session.recording.column("com_velocity"), axis=1)
    fast = np.flatnonzero(speeds > speed)
    return float(session.recording.column("time")[fast[-1]]) if fast.size else 0.0
