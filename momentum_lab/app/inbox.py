"""What a client may ask for: every value is checked here before it goes to a session."""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import TypeVar

import msgspec

from momentum_lab.beside import Beside
from momentum_lab.errors import InputError
from momentum_lab.events import (
    ApplyPush,
    ApplyPushes,
    Event,
    Foresee,
    HoldPush,
    LoadScenario,
    LookBack,
    SelectRobot,
    SetBeside,
    SetSpeed,
    StepOnce,
)
from momentum_lab.physics.push import Push

Data = TypeVar("Data", Push, Beside)

SLOWEST = 1.0 / 8.0
MOST_TICKS = 1000
MOST_PUSHES = 50
MOST_SECONDS = 3600.0
_MOST_LETTERS = 200


def checked_event(event: Event, robots: Collection[str], scenarios: Collection[str]) -> Event:
    """The event, if its numbers are finite and its playback values are within range.

    Gains, priority, bodies and controllers are checked by the session, which knows its own.

    Args:
        event: what a client asks for.
        robots: the robots that may be chosen.
        scenarios: the scenarios that may be chosen.

    Raises:
        InputError: a value is not allowed; the message names it.
    """
    _check_plain(event)
    match event:
        case StepOnce(ticks) if not 1 <= ticks <= MOST_TICKS:
            raise InputError("step", ticks, f"1 to {MOST_TICKS} ticks")
        case SetSpeed(value) if not SLOWEST <= value <= 1.0:
            raise InputError("speed", value, f"{SLOWEST:g} to 1")
        case LookBack(seconds) if not 0.0 <= seconds <= MOST_SECONDS:
            raise InputError("look back", seconds, f"0 to {MOST_SECONDS:g} s")
        case SelectRobot(name) if name not in robots:
            raise InputError("robot", name, f"one of {', '.join(robots)}")
        case LoadScenario(name) if name not in scenarios:
            raise InputError("scenario", name, f"one of {', '.join(scenarios)}")
        case ApplyPush(push):
            return ApplyPush(_checked(push))
        case HoldPush(push):
            return HoldPush(_checked(push))
        case ApplyPushes(pushes):
            if not 1 <= len(pushes) <= MOST_PUSHES:
                raise InputError("sequence", f"{len(pushes)} pushes", f"1 to {MOST_PUSHES}")
            return ApplyPushes(tuple(_checked(push) for push in pushes))
        case Foresee(push):
            return Foresee(_checked(push))
        case SetBeside(beside) if beside is not None:
            return SetBeside(_checked(beside))
    return event


def _check_plain(event: Event) -> None:
    """Refuse what is not a finite number, or too long for a name."""
    for field, value in _leaves(msgspec.to_builtins(event), ""):
        if isinstance(value, float) and not math.isfinite(value):
            raise InputError(field, value, "a finite number")
        if isinstance(value, str) and len(value) > _MOST_LETTERS:
            raise InputError(field, f"{value[:20]}...", f"at most {_MOST_LETTERS} letters")


def _checked(data: Data) -> Data:
    """The same data, every field within its range."""
    try:
        return msgspec.convert(msgspec.to_builtins(data), type(data))
    except msgspec.ValidationError as error:
        message, _, where = str(error).partition(" - at ")
        field = where.strip("`").removeprefix("$.") or type(data).__name__.lower()
        raise InputError(field, getattr(data, field, data), message) from error


def _leaves(value: object, field: str) -> list[tuple[str, object]]:
    if isinstance(value, dict):
        return [leaf for key, inner in value.items() for leaf in _leaves(inner, str(key))]
    if isinstance(value, list | tuple):
        return [leaf for inner in value for leaf in _leaves(inner, field)]
    return [(field, value)]
