"""Runs to begin anew with: another robot, the same pushes under other choices, a scenario by its name."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import takewhile

import msgspec

from momentum_lab.app.chosen import told
from momentum_lab.beside import Beside
from momentum_lab.control.gains import values_of
from momentum_lab.control.motion import motions_of
from momentum_lab.control.registry import controller_entry
from momentum_lab.events import (
    ApplyPush,
    ApplyPushes,
    HoldPush,
    LetGo,
    LoggedEvent,
    MoveGround,
    Reset,
    SessionEvent,
    SetFriction,
    StopGround,
)
from momentum_lab.robot.catalog import load_spec
from momentum_lab.run_file import Run
from momentum_lab.scenario import Scenario, changed, load_scenario
from momentum_lab.session import Session

# When the first push of a run that is done again comes, if it did not come sooner, s.
_BEFORE_PUSH = 0.5
# Times are sums of time steps, in time steps.
_ROUNDING = 1e-6
_OF_GROUND = (MoveGround, StopGround, SetFriction)
# What does something to the robot or its ground, and is no choice.
_ACTING = (ApplyPush, ApplyPushes, *_OF_GROUND)
# Of an opened run only: a hand that holds something now lets go at no known tick of the new run.
_OF_A_HAND = (HoldPush, LetGo)


def once_more(
    session: Session,
    waiting: Sequence[SessionEvent],
    coming: Sequence[LoggedEvent],
    beside: Beside | None,
) -> Run:
    """The present choices from the start, and the same pushes and changes of the ground, the first of them soon.

    Nothing comes sooner where the scenario's own ground moves or changes: it would come upon another ground.

    Args:
        session: the session.
        waiting: what it will do at the start of its next tick.
        coming: what an opened run has it do later.
        beside: what a robot beside it does differently.
    """
    scenario, timestep = session.scenario, session.scenario.timestep
    now = round(session.time / timestep)
    zero = session.ticks - now
    # What has been done to the robot is in its pushes already.
    done = [
        (entry.tick - zero, entry.event) for entry in _done(session) if isinstance(entry.event, _OF_GROUND)
    ]
    next_ones = [(now, event) for event in waiting if isinstance(event, _ACTING)]
    later = [
        (entry.tick - zero, entry.event)
        for entry in _until_reset(coming)
        if isinstance(entry.event, _ACTING + _OF_A_HAND)
    ]
    acting = [*done, *next_ones, *later]
    ticks = _too_late(scenario, [push.start for push in session.pushes], [tick for tick, _ in acting])
    pushes = [msgspec.structs.replace(push, start=push.start - ticks * timestep) for push in session.pushes]
    again = changed(with_robot(scenario.robot, session, waiting, beside), pushes=pushes)
    return Run(again, tuple(LoggedEvent(tick - ticks, event) for tick, event in acting))


def _too_late(scenario: Scenario, starts: Sequence[float], ticks: Sequence[int]) -> int:
    """By how many ticks all that is done can come sooner, given starts of pushes (s) and ticks of events."""
    if any(plate.motions or plate.changes for plate in scenario.ground):
        return 0
    first = min([*starts, *(tick * scenario.timestep for tick in ticks)], default=0.0)
    return max(0, math.floor((first - _BEFORE_PUSH) / scenario.timestep + _ROUNDING))


def _done(session: Session) -> Sequence[LoggedEvent]:
    """What was done since the robot last stood up."""
    resets = [i for i, entry in enumerate(session.log) if isinstance(entry.event, Reset)]
    return session.log[resets[-1] + 1 :] if resets else session.log


def _until_reset(coming: Sequence[LoggedEvent]) -> Iterable[LoggedEvent]:
    return takewhile(lambda entry: not isinstance(entry.event, Reset), coming)


def with_robot(
    name: str, session: Session, waiting: Sequence[SessionEvent], beside: Beside | None
) -> Scenario:
    """The same scenario and choices with the robot of a name."""
    chosen = told(session.choices_after(waiting))
    defaults = values_of(controller_entry(chosen["controller"]).gains)
    return changed(
        session.scenario,
        robot=name,
        beside=beside,
        **chosen
        | {
            "motion": chosen["motion"] if chosen["motion"] in motions_of(load_spec(name)) else "",
            "gains": {gain: value for gain, value in chosen["gains"].items() if value != defaults[gain]},
        },
    )


def named_run(name: str, first: Run, robot: str) -> Run:
    """The scenario of a name with a robot; what was opened under that name is played again.

    Args:
        name: of the scenario.
        first: what the lab was opened with.
        robot: name of the robot.
    """
    if name != first.scenario.name:
        return Run(changed(load_scenario(name), robot=robot))
    if robot == first.scenario.robot:
        return first
    return Run(changed(first.scenario, robot=robot))
