"""Choices in words, and what to call two robots of which one has others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import msgspec

from momentum_lab.choices import Choices
from momentum_lab.control.gains import values_of
from momentum_lab.momentum.directions import text_of

NOTHING = "–"


def choices_in_words(chosen: Choices) -> dict[str, str]:
    """All choices but the gains, by their names on the screen."""
    errors: dict[str, float] = msgspec.structs.asdict(chosen.mismatch)
    return {
        "controller": chosen.controller,
        "priority": f"{chosen.priority:g}",
        "planner": chosen.planner,
        "directions": text_of(chosen.controlled),
        "motion": chosen.motion or "stand still",
        "angular goal": chosen.angular_goal,
        "how the ground moves": chosen.ground_sense,
        **{f"model: {name.replace('_', ' ')}": f"{value:g}" for name, value in errors.items()},
    }


def gains_in_words(values: Mapping[str, Any]) -> dict[str, str]:
    """All gains, by their names on the screen."""
    return {name.replace("_", " "): f"{value:g}" for name, value in values.items()}


def differing(words: Sequence[dict[str, str]]) -> dict[str, tuple[str, ...]]:
    """What is not the same in all of several descriptions: name -> one value for each."""
    names = dict.fromkeys(name for each in words for name in each)
    values = {name: tuple(each.get(name, NOTHING) for each in words) for name in names}
    return {name: found for name, found in values.items() if len(set(found)) > 1}


def names_of_chosen(first: Choices, second: Choices) -> tuple[str, str]:
    """What to call two robots of one run: by the first thing that was chosen otherwise for the second."""
    return names_by(
        [{**choices_in_words(each), **gains_in_words(values_of(each.gains))} for each in (first, second)]
    )


def names_by(words: Sequence[dict[str, str]]) -> tuple[str, str]:
    """What to call two robots that are described so: by the first thing in which they differ."""
    found = differing(words)
    if not found:
        return "first", "second"
    name, (one, other) = next(iter(found.items()))
    if name in ("robot", "controller"):
        return one, other
    return f"{name} {one}", f"{name} {other}"
