"""What differs between runs, in words: what was chosen for them, and how they were pushed."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from momentum_lab.app.chosen import chosen_in
from momentum_lab.app.wire import Truth
from momentum_lab.choice_words import NOTHING, choices_in_words, differing, gains_in_words, names_by
from momentum_lab.choices import CHOICES
from momentum_lab.physics.push import Push
from momentum_lab.plain import plain

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
        **gains_in_words(truth.gains),
        **errors,
    }


def differences(truths: Sequence[Truth]) -> dict[str, tuple[str, ...]]:
    """The choices that are not the same in all runs: name -> one value for each."""
    return differing([choices(truth) for truth in truths])


def with_choices(truth: Truth, chosen: Truth) -> Truth:
    """What is the case in a run, with the choices of another moment of it."""
    return msgspec.structs.replace(truth, **{name: getattr(chosen, name) for name in CHOICES})


def names_of(first: Truth, second: Truth) -> tuple[str, str]:
    """What to call two robots: by the first thing in which they differ."""
    return names_by([choices(truth) for truth in (first, second)])


def push_in_words(push: Push) -> str:
    """Force, duration and direction, and what else a push says."""
    words = f"{push.force or 0.0:.0f} N, {1e3 * push.duration:.0f} ms, {plain(push.direction_deg, '.0f')}°{push.tilt}"
    if push.height is not None:
        words += f", {push.height:g} m high"
    if push.body is not None:
        words += f", {push.body.replace('_', ' ')}"
    if push.point is not None:
        words += ", where it was grabbed"
    return words if push.shape == "rectangle" else f"{words}, {push.shape}"
