"""The largest push that a robot survives, found by bisection, and what gives out just beyond it."""

from __future__ import annotations

from collections.abc import Callable

import msgspec

from momentum_lab.errors import InputError
from momentum_lab.experiments.giving_out import what_gave_out
from momentum_lab.headless import run_headless
from momentum_lab.physics.push import MAX_FORCE, Push
from momentum_lab.robot.model import RobotModel
from momentum_lab.scenario import Scenario, changed
from momentum_lab.session import Session
from momentum_lab.summary import Summary, summarize

# The push that is tried first gives this velocity to the CoM, m/s; about as much as CoP control alone survives.
_FIRST_SPEED = 0.3
_GROWTH = 1.5
# Survived and not survived are this close in the end, as a part of the push.
PRECISION = 0.01

Proceed = Callable[[float], bool]


class PushLimit(msgspec.Struct, frozen=True, kw_only=True):
    """The largest push in one direction that was survived; SI units.

    Attributes:
        direction_deg: where it points: 0 forward, 90 left, degrees.
        force: N; 0 if even the smallest push was too much.
        impulse: N s.
        impulse_ratio: over the impulse that a pendulum survives with its CoP alone.
        beyond: the smallest force that was tried and not survived, N; None: the largest there is was survived.
        why: what happened there.
        signs: what gave out there, in the order in which it did.
        trials: how many pushes were tried.
    """

    direction_deg: float
    force: float
    impulse: float
    impulse_ratio: float
    beyond: float | None
    why: str
    signs: tuple[str, ...]
    trials: int


class Trial(msgspec.Struct, frozen=True):
    """One push and what came of it."""

    force: float
    summary: Summary
    signs: tuple[str, ...]

    @property
    def survived(self) -> bool:
        """Not fallen, and at rest at the end."""
        return self.summary.settled

    @property
    def why(self) -> str:
        """Why it was not survived."""
        if self.summary.fell:
            return f"fell at {self.summary.fall_time:.2f} s: {self.summary.fall_reason}"
        return f"still moving after {self.summary.seconds:g} s"


def push_limit(
    scenario: Scenario, robot: RobotModel, push: Push, proceed: Proceed, precision: float = PRECISION
) -> PushLimit:
    """The largest force of a push that is survived, by bisection.

    A push is survived when the robot has not fallen and is at rest at the end of the scenario.

    Args:
        scenario: everything but the push.
        robot: the scenario's robot.
        push: its duration, direction and start; its force does not matter.
        proceed: asked before every tick with the fraction of the search that is done, roughly.
        precision: how close the largest survived and the smallest not survived force are, as a part of them.

    Raises:
        InputError: the robot does not stand when nobody pushes it, or the push comes after the end.
    """
    if push.start + push.duration >= scenario.seconds:
        given = f"{push.start:g} s to {push.start + push.duration:g} s"
        raise InputError(
            "push", given, f"a push that ends before {scenario.name} does, at {scenario.seconds:g} s"
        )
    trials: list[Trial] = []

    def attempt(force: float) -> Trial:
        trials.append(trial(scenario, robot, push, force, _search_fraction(len(trials), precision, proceed)))
        return trials[-1]

    survived, beyond = _bracket(attempt, robot.mass * _FIRST_SPEED / push.duration)
    while beyond is not None and beyond.force - survived.force > precision * beyond.force:
        middle = attempt(0.5 * (survived.force + beyond.force))
        survived, beyond = (middle, beyond) if middle.survived else (survived, middle)
    return _limit(push, survived, beyond, len(trials))


def _bracket(attempt: Callable[[float], Trial], first: float) -> tuple[Trial, Trial | None]:
    """A push that is survived and a larger one that is not; None if there is none."""
    survived, beyond = attempt(0.0), None
    if not survived.survived:
        name = survived.summary.scenario
        raise InputError("scenario", name, "one in which the robot comes to rest when nobody pushes it")
    force = min(first, MAX_FORCE)
    while beyond is None and survived.force < MAX_FORCE:
        tried = attempt(force)
        survived, beyond = (tried, None) if tried.survived else (survived, tried)
        force = min(_GROWTH * force, MAX_FORCE)
    return survived, beyond


def trial(scenario: Scenario, robot: RobotModel, push: Push, force: float, proceed: Proceed) -> Trial:
    """One run with the push at a force, N; it ends with a fall."""
    sized = msgspec.structs.replace(push, force=force, velocity_change=None)
    session = Session(changed(scenario, pushes=(sized,)), robot)
    timing = run_headless(session, lambda fraction: session.fall is None and proceed(fraction))
    return Trial(force, summarize(session, timing), what_gave_out(session))


def _limit(push: Push, survived: Trial, beyond: Trial | None, trials: int) -> PushLimit:
    return PushLimit(
        direction_deg=push.direction_deg,
        force=survived.force,
        impulse=survived.summary.impulse,
        impulse_ratio=survived.summary.impulse_ratio,
        beyond=None if beyond is None else beyond.force,
        why="larger forces are not possible here" if beyond is None else beyond.why,
        signs=() if beyond is None else beyond.signs,
        trials=trials,
    )


def _search_fraction(done: int, precision: float, proceed: Proceed) -> Proceed:
    """What one trial asks, told as a fraction of a search of usual length."""
    usual = 3.0
    width = 0.5
    while width > precision:
        usual, width = usual + 1.0, 0.5 * width
    return lambda fraction: proceed(min(1.0, (done + fraction) / usual))
