"""Widgets that ask and then show what is: the hand that moves one is never fought, the truth always wins."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any, Generic, TypeVar

from momentum_lab.errors import InputError
from momentum_lab.events import Event

Post = Callable[[Event], None]
Value = TypeVar("Value", bool, float, str)

HANDS_OFF = 0.7
"""How long a widget that was touched keeps what the hand gave it, s: longer than an event needs to come back."""


class Bound(Generic[Value]):
    """A widget whose value belongs to the session.

    Args:
        handle: a viser input.
        event: what a new value asks for.
        post: where to put it.
        clock: seconds, for tests.
    """

    def __init__(
        self,
        handle: Any,
        event: Callable[[Value], Event],
        post: Post,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.handle = handle
        self._event: Callable[[Value], Event] = event
        self._post = post
        self._clock = clock
        self._touched = -math.inf
        self._known: Value = handle.value
        handle.on_update(self._changed)

    def follow(self, truth: Value) -> None:
        """Show what is the case, unless a hand has just been there."""
        if not _same(self.handle.value, self._known):
            return  # a hand has moved it this very moment, and `_changed` is on its way
        if self._clock() - self._touched > HANDS_OFF and not _same(self._known, truth):
            self._known = truth
            self.handle.value = truth

    def _changed(self, update: Any) -> None:
        if update.client is None:
            return  # it was `follow`, not a person
        self._touched = self._clock()
        self._known = self.handle.value
        self._post(self._event(self._known))


def one_of(widget: Any, name: str, allowed: tuple[str, ...]) -> str:
    """What has been chosen, if the widget offers it: a browser may send anything.

    Raises:
        InputError: it does not.
    """
    if widget.value not in allowed:
        raise InputError(name, widget.value, f"one of {', '.join(allowed)}")
    return str(widget.value)


def _same(one: object, other: object) -> bool:
    """Whether two values are equal; what is not a number equals itself here."""
    return one == other or (one != one and other != other)


def nice_step(low: float, high: float, default: float) -> float:
    """A slider step of 1, 2 or 5 times a power of ten, for some hundred steps from low to high.

    Args:
        low: the slider's lower end.
        high: its upper end.
        default: a value that must lie on a step.
    """
    rough = (high - low) / 150.0
    power = 10.0 ** math.floor(math.log10(rough))
    steps = [power * factor / scale for scale in (1.0, 10.0, 100.0) for factor in (5.0, 2.0, 1.0)]
    fine = [step for step in steps if step <= rough * 1.001]
    return next((step for step in fine if _on_step(default - low, step)), fine[-1])


def _on_step(distance: float, step: float) -> bool:
    return abs(distance / step - round(distance / step)) < 1e-6
