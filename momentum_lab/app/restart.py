"""Runs to begin anew with: another robot, the same pushes under other choices, a scenario by its name."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from momentum_lab.app.chosen import chosen_of, values_of
from momentum_lab.beside import Beside
from momentum_lab.control.motion import motions_of
from momentum_lab.control.registry import controller_entry
from momentum_lab.events import SessionEvent
from momentum_lab.robot.catalog import load_spec
from momentum_lab.run_file import Run
from momentum_lab.scenario import Scenario, changed, load_scenario
from momentum_lab.session import Session

# When the first push of a run that is done again comes, if it did not come sooner, s.
_BEFORE_PUSH = 0.5


def once_more(session: Session, waiting: Sequence[SessionEvent], beside: Beside | None) -> Scenario:
    """The present choices and pushes from the start, the first push soon after it."""
    pushes = session.pushes
    early = max(0.0, min((push.start for push in pushes), default=0.0) - _BEFORE_PUSH)
    again = tuple(msgspec.structs.replace(push, start=push.start - early) for push in pushes)
    return changed(with_robot(session.scenario.robot, session, waiting, beside), pushes=again)


def with_robot(
    name: str, session: Session, waiting: Sequence[SessionEvent], beside: Beside | None
) -> Scenario:
    """The same scenario and choices with the robot of a name."""
    chosen = chosen_of(session, waiting)
    defaults = values_of(controller_entry(chosen.controller).gains)
    return changed(
        session.scenario,
        robot=name,
        controller=chosen.controller,
        priority=chosen.priority,
        controlled=chosen.controlled,
        planner=chosen.planner,
        motion=chosen.motion if chosen.motion in motions_of(load_spec(name)) else "",
        angular_goal=chosen.angular_goal,
        ground_sense=chosen.ground_sense,
        gains={gain: value for gain, value in chosen.gains.items() if value != defaults[gain]},
        mismatch=chosen.mismatch,
        beside=beside,
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
