"""What differs between runs, in words: what was chosen for them, and how they were pushed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import msgspec

from momentum_lab.app.chosen import chosen_in
from momentum_lab.app.wire import Truth
from momentum_lab.choices import CHOICES, Choices
from momentum_lab.control.gains import values_of
from momentum_lab.momentum.directions import text_of
from momentum_lab.physics.push import Push

NOTHING = "–"
LAY_THERE = "had fallen already"
"""Of a robot that was put beside one that lay on the ground."""


def choices(truth: Truth) -> dict[str, str]:
    """Everything that was chosen for a run, by its name on the screen."""
    chosen = chosen_in(truth)
    errors = choices_in_words(chosen)
    first = {name: errors.pop(name) for name in list(errors) if not name.startswith("model: ")}
    return {
        "robot": truth.robot,
        **first,
        "friction of the ground": ", ".join(f"{value:g}" for value in dict.fromkeys(truth.friction)),
        "push": NOTHING if truth.first_push is None else push_in_words(truth.first_push),
        **_gains(truth.gains),
        **errors,
    }


def _gains(values: Mapping[str, float]) -> dict[str, str]:
    return {name.replace("_", " "): f"{value:g}" for name, value in values.items()}


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


def differences(truths: Sequence[Truth]) -> dict[str, tuple[str, ...]]:
    """The choices that are not the same in all runs: name -> one value for each."""
    return _differing([choices(truth) for truth in truths])


def _differing(words: Sequence[dict[str, str]]) -> dict[str, tuple[str, ...]]:
    names = dict.fromkeys(name for each in words for name in each)
    values = {name: tuple(each.get(name, NOTHING) for each in words) for name in names}
    return {name: found for name, found in values.items() if len(set(found)) > 1}


def with_choices(truth: Truth, chosen: Truth) -> Truth:
    """What is the case in a run, with the choices of another moment of it."""
    return msgspec.structs.replace(truth, **{name: getattr(chosen, name) for name in CHOICES})


def names_of(first: Truth, second: Truth) -> tuple[str, str]:
    """What to call two robots: by the first thing in which they differ."""
    return _names([choices(truth) for truth in (first, second)])


def names_of_chosen(first: Choices, second: Choices) -> tuple[str, str]:
    """What to call two robots of one run: by the first thing that was chosen otherwise for the second."""
    return _names([{**choices_in_words(each), **_gains(values_of(each.gains))} for each in (first, second)])


def _names(words: Sequence[dict[str, str]]) -> tuple[str, str]:
    found = _differing(words)
    if not found:
        return "first", "second"
    name, (one, other) = next(iter(found.items()))
    if name in ("robot", "controller"):
        return one, other
    return f"{name} {one}", f"{name} {other}"


def push_in_words(push: Push) -> str:
    """Force, duration and direction, and what else a push says."""
    words = f"{push.force or 0.0:.0f} N, {1e3 * push.duration:.0f} ms, {push.direction_deg:.0f}°{push.tilt}"
    if push.height is not None:
        words += f", {push.height:g} m high"
    if push.body is not None:
        words += f", {push.body.replace('_', ' ')}"
    if push.point is not None:
        words += ", where it was grabbed"
    return words if push.shape == "rectangle" else f"{words}, {push.shape}"
