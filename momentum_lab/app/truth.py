"""What is the case in a session that is played, put into the words of the wire."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import msgspec
import numpy as np

from momentum_lab.app.beginnings import beginnings
from momentum_lab.app.chosen import told
from momentum_lab.app.wire import Fallen, Opened, RunTaken, Truth
from momentum_lab.beside import Beside
from momentum_lab.effects import feet_named
from momentum_lab.events import SessionEvent, SetFriction
from momentum_lab.finished import com_speed
from momentum_lab.physics.push import Push
from momentum_lab.recording import Sample
from momentum_lab.run_file import run_of
from momentum_lab.session import Session


@dataclass(frozen=True, slots=True)
class Clock:
    """How the time of a session runs.

    Attributes:
        run: counts every new session and every standing up.
        playing: whether simulated time runs.
        speed: the fraction of real time it is asked to run at.
        real_time_factor: simulated seconds per second.
        stopped: why the simulation cannot go on; None while it can.
        behind: how long before the end of the run the sample is that is looked at, s.
    """

    run: int
    playing: bool
    speed: float
    real_time_factor: float
    stopped: str | None
    behind: float


def truth_of(
    session: Session,
    waiting: Sequence[SessionEvent],
    shown: Sample,
    clock: Clock,
    beside: Beside | None,
    opened: Opened | None,
    forgotten: tuple[float, ...] = (),
) -> Truth:
    """What is the case; what waits for the next tick counts as done.

    Args:
        session: the session.
        waiting: what it will do at the start of its next tick.
        shown: the sample that is looked at.
        clock: how its time runs.
        beside: what a robot beside this one does differently.
        opened: the opened run that plays.
        forgotten: pushes that going on from what is looked at would not repeat, s.
    """
    time = shown.number("time")
    return Truth(
        run=clock.run,
        scenario=session.scenario.name,
        robot=session.scenario.robot,
        playing=clock.playing,
        speed=clock.speed,
        real_time_factor=clock.real_time_factor,
        fall=_fallen(session, time),
        failure=session.last_failure,
        failures=session.solver_failures,
        stopped=clock.stopped,
        push=max(_begun(session, time), key=_start, default=None),
        friction=_friction(session, waiting, time),
        uneven=not session.ground.is_floor,
        floor=float(session.ground.floor.origin[2]),
        behind=clock.behind,
        first_push=min(_begun(session, time), key=_start, default=None),
        beside=beside,
        opened=opened,
        pushed=beginnings(session.pushes, session.recording.latest.number("time")),
        forgotten=forgotten,
        **told(session.choices_after(waiting)),
    )


def taken_of(session: Session, waiting: Sequence[SessionEvent], beside: Beside | None) -> RunTaken:
    """The run as it is now, without samples; what waits for the next tick counts as done.

    A robot beside the first is in its scenario.
    """
    run = run_of(session, waiting)
    scenario = msgspec.structs.replace(run.scenario, beside=beside)
    return RunTaken(
        run=msgspec.structs.replace(run, scenario=scenario),
        rows=b"",
        time=session.time,
        pushes=session.pushes_after(waiting),
        fall=_fallen(session, session.time),
        failures=session.solver_failures,
        com_speed=com_speed(session),
    )


def recorded_of(session: Session, waiting: Sequence[SessionEvent], beside: Beside | None) -> RunTaken:
    """The run as it is now, with all samples that are kept."""
    rows = session.recording.rows().tobytes()
    return msgspec.structs.replace(taken_of(session, waiting, beside), rows=rows)


def _fallen(session: Session, time: float) -> Fallen | None:
    """The fall, unless it is still to come at a time of the run, s."""
    fall = session.fall
    return None if fall is None or fall.time > time else Fallen(fall.time, fall.reason)


def _begun(session: Session, time: float) -> list[Push]:
    """The pushes that have begun by a time of the run, s."""
    return [push for push in session.pushes if push.start <= time]


def _start(push: Push) -> float:
    return push.start


def _friction(session: Session, waiting: Sequence[SessionEvent], time: float) -> tuple[float, ...]:
    """Friction under each foot at a time of the run, s; what waits for the next tick counts as done."""
    friction = session.ground.friction(time).copy()
    for event in waiting:
        if isinstance(event, SetFriction):
            friction[list(feet_named(event.foot, session.robot))] = event.value
    return tuple(np.asarray(friction).tolist())
