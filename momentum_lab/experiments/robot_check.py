"""Does a robot stand, and does it take a push in each direction that a pendulum would survive on its CoP?"""

from __future__ import annotations

import math
from collections.abc import Callable

import msgspec
import numpy as np

from momentum_lab.headless import Timing, run_headless
from momentum_lab.momentum.pendulum import pendulum_frequency, pendulum_impulse_bound
from momentum_lab.momentum.support import distance_to_edge, support_polygon
from momentum_lab.physics.push import MAX_FORCE, Push
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.posture import standing_posture
from momentum_lab.robot.state import State
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session
from momentum_lab.summary import Summary, summarize

RATIO = 0.7
"""Impulse of each push over what an inverted pendulum survives with its CoP alone."""

DIRECTIONS = {"forward": 0.0, "left": 90.0, "backward": 180.0, "right": 270.0}
"""Where the robot is pushed to, degrees about the vertical."""

_START, _DURATION, _SECONDS = 0.2, 0.1, 3.0
# A motor that gives this part of its torque for longer than this is at its limit, s.
_FULL, _LONG = 0.999, 0.02
# So many of them are named.
_FEW = 3


class Trial(msgspec.Struct, frozen=True, kw_only=True):
    """One run of a robot that stands and is pushed.

    Attributes:
        direction: where the push points; `none` for standing alone.
        force: N.
        impulse_ratio: impulse over what an inverted pendulum survives with its CoP alone.
        stands: whether the robot has not fallen after 3 s.
        settled: and is still.
        why: in words; empty for a robot that stands still.
        peak_com_excursion: largest horizontal distance of the CoM from its start before a fall, m.
        min_cop_margin: smallest distance of the CoP from the edge of the support, m; None without support.
        peak_torque_ratio: largest torque asked for before a fall, as a part of its motor's limit.
        saturated: motors that were at their limit for more than 20 ms, the first first.
    """

    direction: str
    force: float
    impulse_ratio: float
    stands: bool
    settled: bool
    why: str
    peak_com_excursion: float
    min_cop_margin: float | None
    peak_torque_ratio: float
    saturated: tuple[str, ...]


def push_force(robot: RobotModel, direction_deg: float, ratio: float = RATIO) -> float:
    """Force of a push of 0.1 s on the standing robot for an impulse ratio, N.

    F T = ratio * m omega delta * omega T / (1 - exp(-omega T)).

    Args:
        robot: the robot.
        direction_deg: 0 forward, 90 left.
        ratio: impulse over what an inverted pendulum survives with its CoP alone.

    Raises:
        RobotError: the robot has no standing posture.
    """
    dynamics = robot.at(State(standing_posture(robot), np.zeros(robot.nv)))
    corners = [
        sole.corners @ rotation.T + position
        for sole, rotation, position in zip(
            robot.soles, dynamics.sole_rotation, dynamics.sole_position, strict=True
        )
    ]
    angle = math.radians(direction_deg)
    com = dynamics.com_in_world
    edge = distance_to_edge(
        com[:2], np.array([math.cos(angle), math.sin(angle)]), support_polygon(np.vstack(corners))
    )
    omega = pendulum_frequency(float(com[2]))
    return ratio * pendulum_impulse_bound(robot.mass, omega, edge, _DURATION) / _DURATION


def trials(robot: RobotModel, proceed: Callable[[float], bool]) -> list[Trial]:
    """The robot standing alone, then pushed in four directions.

    A robot that falls on its own is not pushed.

    Args:
        robot: the robot.
        proceed: asked before every tick with the fraction of all runs that is done; False ends them.

    Raises:
        RobotError: the robot has no standing posture.
    """
    forces = {"none": 0.0} | {name: push_force(robot, angle) for name, angle in DIRECTIONS.items()}
    done: list[Trial] = []
    for i, (direction, force) in enumerate(forces.items()):
        session = Session(_scenario(robot, direction, force), robot)
        timing = run_headless(session, lambda part, i=i: proceed((i + part) / len(forces)))  # type: ignore[misc]
        if not len(session.recording):
            break
        done.append(_trial(session, timing, direction, force))
        if not done[0].stands:
            break
    return done


def _scenario(robot: RobotModel, direction: str, force: float) -> Scenario:
    pushes: tuple[Push, ...] = ()
    if direction in DIRECTIONS:
        angle = DIRECTIONS[direction]
        push = Push(force=min(force, MAX_FORCE), duration=_DURATION, direction_deg=angle, start=_START)
        pushes = (push,)
    return Scenario(f"robot-check {direction}", robot=robot.spec.name, pushes=pushes, seconds=_SECONDS)


def _trial(session: Session, timing: Timing, direction: str, force: float) -> Trial:
    summary, recording = summarize(session, timing), session.recording
    standing = recording.column("time") < (math.inf if summary.fall_time is None else summary.fall_time)
    saturated = _saturated(session, standing)
    away = np.linalg.norm(recording.column("com")[:, :2] - recording.column("com")[0, :2], axis=1)
    return Trial(
        direction=direction,
        force=force,
        impulse_ratio=summary.impulse_ratio,
        stands=not summary.fell,
        settled=summary.settled,
        why=_why(summary, saturated),
        peak_com_excursion=float(away[standing].max(initial=0.0)),
        min_cop_margin=summary.min_cop_margin,
        peak_torque_ratio=float(recording.column("torque_ratio")[standing].max(initial=0.0)),
        saturated=saturated,
    )


def _saturated(session: Session, standing: np.ndarray) -> tuple[str, ...]:
    """Motors at their limit for more than 20 ms of the rows (n,) in which the robot stands, the first first."""
    robot = session.robot
    full = np.abs(session.recording.column("torque")[standing]) >= _FULL * robot.effort_limit
    if not len(full):
        return ()
    long = full.sum(axis=0) * session.scenario.timestep > _LONG
    first = np.argmax(full, axis=0)
    return tuple(robot.joint_names[i] for i in sorted(np.flatnonzero(long), key=lambda i: (first[i], i)))


def _why(summary: Summary, saturated: tuple[str, ...]) -> str:
    parts = []
    if summary.fell:
        parts.append(f"at {summary.fall_time:.2f} s {summary.fall_reason}")
    elif not summary.settled:
        parts.append("still moving at the end")
    if saturated and not summary.settled:
        more = f" and {len(saturated) - _FEW} more" if len(saturated) > _FEW else ""
        parts.append(f"motors at their limit: {', '.join(saturated[:_FEW])}{more}")
    if summary.qp_failures:
        parts.append(f"no solution on {summary.qp_failures} ticks")
    return "; ".join(parts)
