"""Play a lesson without a screen: its runs, what they measure, and whether its claims hold."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import msgspec

from momentum_lab.errors import SimulationError
from momentum_lab.experiments.claims import Claim, Runs, at_least, at_most, falls, stands
from momentum_lab.headless import run_headless
from momentum_lab.lesson.equation import mathml, numbers, residual
from momentum_lab.lesson.loader import located
from momentum_lab.lesson.parts import (
    Asserted,
    Bound,
    Choice,
    Compare,
    Explain,
    Falls,
    Lesson,
    Number,
    Play,
    Run,
    Step,
    Value,
    Values,
)
from momentum_lab.lesson.staging import Staging
from momentum_lab.lesson.text import spoken, with_unit
from momentum_lab.robot.model import RobotModel
from momentum_lab.session import Session


@dataclass(frozen=True, slots=True)
class Played:
    """A lesson that has been played.

    Attributes:
        lesson: the lesson.
        runs: its runs, each to its end or to a fall.
        values: name of a measure -> what it is.
        claims: what the runs had to show, and whether they do.
    """

    lesson: Lesson
    runs: Runs
    values: Values
    claims: tuple[Claim, ...]

    @property
    def holds(self) -> bool:
        """Whether every claim holds."""
        return all(claim.holds for claim in self.claims)


def _always(_fraction: float) -> bool:
    return True


def play_lesson(
    lesson: Lesson, robot: RobotModel | None = None, proceed: Callable[[float], bool] = _always
) -> Played:
    """Play all runs of a lesson and judge its claims.

    Args:
        lesson: the lesson.
        robot: who plays it; None: the first robot it names.
        proceed: asked before every tick with the fraction that is done; False ends the run.

    Raises:
        LessonError: a measure or an event of the lesson has an error in it.
        SimulationError: a run broke down before its end.
    """
    robot = robot or RobotModel.named(lesson.robots[0])
    runs: dict[str, Session] = {}
    for label, run in lesson.runs.items():
        with located(lesson.file, label):
            runs[label] = _played(run, robot, _part_of(len(runs), len(lesson.runs), proceed))
    return measured(lesson, runs)


def measured(lesson: Lesson, runs: Runs) -> Played:
    """What a lesson's runs show, once all of them have been played.

    Raises:
        LessonError: a measure or a claim of the lesson has an error in it.
    """
    values = {name: _measured(lesson, name, runs) for name in lesson.measures}
    asserted = [claim for each in lesson.claims for claim in _judged(each, lesson, runs, values)]
    implied = [claim for step in lesson.steps for claim in _implied(step, lesson, runs, values)]
    return Played(lesson, runs, values, (*asserted, *implied))


def right_options(step: Choice, values: Values) -> list[int]:
    """Which options of a choice the recording makes right."""
    return [place for place, option in enumerate(step.options) if option.right(values)]


def told(step: Step, played: Played) -> dict[str, Any]:
    """A step as plain data: its kind, its words with all numbers, and what belongs to it."""
    with located(played.lesson.file, step.text):
        return _told(step, played)


def _told(step: Step, played: Played) -> dict[str, Any]:
    lesson, values = played.lesson, played.values
    record: dict[str, Any] = {"kind": type(step).__name__.lower()}
    record["text"] = spoken(step.text, lesson.measures, values)
    match step:
        case Choice(options=options):
            record["options"] = [option.text for option in options]
            record["right"] = right_options(step, values)
        case Number(measure=name, low=low, high=high):
            unit = lesson.measures[name].unit
            record |= {"low": low, "high": high, "unit": unit, "measured": values[name]}
        case Play(run=run, controls=controls, beside=beside):
            record |= {"run": run, "controls": list(controls), "beside": beside}
        case Compare(measures=names):
            record["measured"] = {name: with_unit(lesson.measures[name], values[name]) for name in names}
        case Explain(run=run, time=time, equation=equation):
            found = numbers(equation, played.runs[run], time)
            record |= {"run": run, "time": time, "equation": equation.text, "symbols": found}
            record["residual"] = residual(equation, played.runs[run])
            record["unit"] = equation.unit
            record["mathml"] = mathml(equation, found)
    return record


def report(played: Played) -> dict[str, Any]:
    """Everything about a lesson that has been played, as plain data."""
    lesson = played.lesson
    return {
        "name": lesson.file.stem,
        "number": lesson.number,
        "title": lesson.title,
        "question": lesson.question,
        "robot": next(iter(played.runs.values())).robot.spec.name,
        "steps": [told(step, played) for step in lesson.steps],
        "measures": {
            name: {"value": value, "unit": lesson.measures[name].unit}
            for name, value in played.values.items()
        },
        "claims": msgspec.to_builtins(played.claims),
        "holds": played.holds,
    }


def _played(run: Run, robot: RobotModel, proceed: Callable[[float], bool]) -> Session:
    """One run to its end or to a fall, each event at its time."""
    session = Session(run.for_robot(robot.spec.name), robot=robot)
    staging = Staging(run)
    timing = run_headless(session, lambda fraction: proceed(fraction) and staging.prepare(session))
    if timing.error is not None:
        raise SimulationError(timing.error)
    return session


def _part_of(done: int, count: int, proceed: Callable[[float], bool]) -> Callable[[float], bool]:
    return lambda fraction: proceed((done + fraction) / count)


def _measured(lesson: Lesson, name: str, runs: Runs) -> Value:
    """What a measure is: words, or a number that can be written as it says."""
    measure = lesson.measures[name]
    with located(lesson.file, name):
        value = measure.value(runs)
        number = value if isinstance(value, str) else float(value)
        with_unit(measure, number)
    return number


def _implied(step: Step, lesson: Lesson, runs: Runs, values: Values) -> Iterator[Claim]:
    """What a step claims by itself: one answer is right, a number is in its range, an equation holds."""
    with located(lesson.file, step.text):
        match step:
            case Choice(text=text):
                count = len(right_options(step, values))
                asked = spoken(text, lesson.measures, values)
                yield Claim(f"one answer is right: {asked}", float(count), "1 option", count == 1)
            case Number(measure=name, low=low, high=high):
                value, unit = float(values[name]), lesson.measures[name].unit
                inside = low <= value <= high
                yield Claim(f"{name} can be predicted", value, f"from {low:g} to {high:g} {unit}", inside)
            case Explain(run=run, equation=equation):
                left = residual(equation, runs[run])
                yield at_most(f"{equation.text}, within", left, equation.within, equation.unit)


def _judged(asserted: Asserted, lesson: Lesson, runs: Runs, values: Values) -> Iterator[Claim]:
    if isinstance(asserted, Bound):
        value, unit = values[asserted.measure], lesson.measures[asserted.measure].unit
        number = math.nan if isinstance(value, str) else value
        if asserted.low is not None:
            yield at_least(asserted.words, number, asserted.low, unit)
        if asserted.high is not None:
            yield at_most(asserted.words, number, asserted.high, unit)
    elif isinstance(asserted, Falls):
        yield falls(asserted.words, runs[asserted.run])
    else:
        yield stands(asserted.words, runs[asserted.run])
