"""Choices in the plain form in which they go over the wire, and back."""

from __future__ import annotations

from typing import Any

from momentum_lab.app.wire import Truth
from momentum_lab.choices import CHOICES, Choices
from momentum_lab.control.gains import values_of, with_gains
from momentum_lab.control.registry import controller_entry
from momentum_lab.momentum.directions import directions, text_of


def told(choices: Choices) -> dict[str, Any]:
    """The choices under the names that `Truth` has for them, as plain data."""
    plain = {name: getattr(choices, name) for name in CHOICES}
    return {**plain, "controlled": text_of(choices.controlled), "gains": values_of(choices.gains)}


def chosen_in(truth: Truth) -> Choices:
    """The choices in what is the case."""
    plain = {name: getattr(truth, name) for name in CHOICES}
    gains = with_gains(controller_entry(truth.controller).gains, truth.gains)
    return Choices(**{**plain, "controlled": directions(truth.controlled), "gains": gains})
