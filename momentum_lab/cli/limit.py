"""momentum-lab limit: the largest push that is survived, by bisection."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable

import msgspec
from rich.console import Console
from rich.table import Table

from momentum_lab.cli.choices import chosen_scenario
from momentum_lab.cli.progress import progress
from momentum_lab.errors import InputError
from momentum_lab.experiments.push_limit import PushLimit, push_limit
from momentum_lab.physics.push import Push
from momentum_lab.plain import plain
from momentum_lab.robot.model import RobotModel
from momentum_lab.scenario import Scenario

_START, _DURATION = 0.5, 0.1
_STEP_DEG = 45.0
_WORDS = {0.0: "forward", 90.0: "left", 180.0: "backward", 270.0: "right"}


class Limits(msgspec.Struct, frozen=True):
    """What the command prints as JSON: who was pushed in whose physics, and how far; SI units."""

    robot: str
    controller: str
    scenario: str
    engine: str
    push_duration: float
    limits: list[PushLimit]


def limit(args: Namespace) -> int:
    """Find the largest push that is survived in one direction or in eight, print it.

    Raises:
        InputError: something that was typed cannot be used.
        KeyboardInterrupt: Ctrl+C.
    """
    scenario = chosen_scenario(Namespace(**{**vars(args), "push_duration": None}))
    robot = RobotModel.named(scenario.robot)
    found = _found(scenario, robot, _push(args, scenario), args.direction)
    limits = Limits(
        robot.spec.name,
        scenario.controller,
        scenario.name,
        scenario.engine,
        args.push_duration or _DURATION,
        found,
    )
    if args.json:
        print(msgspec.json.encode(limits).decode())
    else:
        _show(limits)
    return 0


def _push(args: Namespace, scenario: Scenario) -> Push:
    """The push to be sized: it begins when the scenario's own first push does."""
    start = scenario.pushes[0].start if scenario.pushes else _START
    duration = args.push_duration or _DURATION
    if start + duration >= scenario.seconds:
        until = f"less than {scenario.seconds - start:g} s, when {scenario.name} ends"
        raise InputError("--push-duration", f"{duration:g}", until)
    return Push(force=0.0, duration=duration, start=start)


def _found(scenario: Scenario, robot: RobotModel, push: Push, direction: float | None) -> list[PushLimit]:
    """One limit, or that of every 45 degrees."""
    directions = [_STEP_DEG * i for i in range(8)] if direction is None else [direction]
    found = []
    with progress(f"{scenario.name}: {robot.spec.name}") as told:
        for i, degrees in enumerate(directions):
            aimed = msgspec.structs.replace(push, direction_deg=degrees)
            found.append(push_limit(scenario, robot, aimed, _part_of(i, len(directions), told)))
    return found


def _part_of(done: int, count: int, told: Callable[[float], None]) -> Callable[[float], bool]:
    def proceed(fraction: float) -> bool:
        told((done + fraction) / count)
        return True

    return proceed


def _show(limits: Limits) -> None:
    """The limits for people, on stdout."""
    title = (
        f"largest push of {limits.push_duration:g} s: {limits.robot}, {limits.controller}, {limits.engine}"
    )
    table = Table("direction", "survived", "impulse", "ratio", "just beyond", title=title)
    for found in limits.limits:
        table.add_row(
            f"{plain(found.direction_deg, 'g')} {_WORDS.get(found.direction_deg % 360.0, '')}".strip(),
            f"{found.force:.0f} N",
            f"{found.impulse:.1f} N s",
            f"{found.impulse_ratio:.2f}",
            "\n".join(_beyond(found)),
        )
    Console(markup=False).print(table)
    print("ratio: impulse over what a pendulum survives on its CoP alone")


def _beyond(found: PushLimit) -> list[str]:
    if found.beyond is None:
        return [found.why]
    return [f"{found.beyond:.0f} N: {found.why}", *found.signs]
