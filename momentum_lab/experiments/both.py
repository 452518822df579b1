"""A run and the one beside it, with what to call them."""

from __future__ import annotations

from momentum_lab.choice_words import choices_in_words, differing, gains_in_words, names_of_chosen
from momentum_lab.control.gains import values_of
from momentum_lab.finished import FinishedRun


def both(run: FinishedRun) -> tuple[tuple[str, FinishedRun], ...]:
    """The runs of one robot or two, each with its name; a robot that is alone has none."""
    beside = run.beside
    if beside is None or not len(beside.recording):
        return (("", run),)
    return tuple(zip(names_of_chosen(run.choices, beside.choices), (run, beside), strict=True))


def different(run: FinishedRun) -> dict[str, tuple[str, ...]]:
    """What was chosen otherwise for the second robot: name -> value of each; empty without one."""
    chosen = [each.choices for _, each in both(run)]
    return differing([{**choices_in_words(each), **gains_in_words(values_of(each.gains))} for each in chosen])
