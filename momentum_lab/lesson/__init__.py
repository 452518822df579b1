"""Guided lessons: what a lesson's script may use, and nothing else.

A lesson asks one question, lets the learner predict, then try, then compares the prediction with the recording,
then explains it with an equation whose symbols carry the recorded numbers. See lessons/README.md.
"""

from momentum_lab.events import ApplyPush, SetGain, SetPriority
from momentum_lab.lesson.equation import Equation, Symbol
from momentum_lab.lesson.measures import at, fate, of
from momentum_lab.lesson.parts import (
    Bound,
    Choice,
    Compare,
    Explain,
    Falls,
    Measure,
    Number,
    Option,
    Play,
    Prose,
    Run,
    Stands,
)
from momentum_lab.physics.push import Push

__all__ = [
    "ApplyPush",
    "Bound",
    "Choice",
    "Compare",
    "Equation",
    "Explain",
    "Falls",
    "Measure",
    "Number",
    "Option",
    "Play",
    "Prose",
    "Push",
    "Run",
    "SetGain",
    "SetPriority",
    "Stands",
    "Symbol",
    "at",
    "fate",
    "of",
]
