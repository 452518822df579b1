"""A lesson that has been played, as plain data that goes from one process to another."""

from __future__ import annotations

from pathlib import Path

import msgspec
import numpy as np

from momentum_lab.lesson.equation import Equation, apart, course, labelled, residual
from momentum_lab.lesson.loader import load_lesson, located
from momentum_lab.lesson.parts import Choice, Compare, Explain, Number, Play, Step
from momentum_lab.lesson.playing import Played, play_lesson, told
from momentum_lab.plain import plain
from momentum_lab.robot.model import RobotModel
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session


class SymbolRecord(msgspec.Struct, frozen=True):
    """A symbol of an equation and its numbers over a run (n,) or as one number (), float64."""

    unit: str
    words: str
    spec: str
    values: bytes


class EquationRecord(msgspec.Struct, frozen=True):
    """An equation and what its symbols were, tick by tick.

    Attributes:
        text: the equation.
        symbols: name -> symbol.
        apart: how far both sides differ (n,), float64.
        unit: of the difference.
        residual: how far they differ where they have to agree.
        within: how far they may.
        timestep: between two ticks, s.
        ticks: of the run.
    """

    text: str
    symbols: dict[str, SymbolRecord]
    apart: bytes
    unit: str
    residual: float
    within: float
    timestep: float
    ticks: int

    def numbers(self, time: float) -> dict[str, float]:
        """What every symbol is at a time of the run, s, or at its nearest end."""
        return {name: self._at(symbol.values, time) for name, symbol in self.symbols.items()}

    def difference(self, time: float) -> float:
        """How far both sides differ at a time of the run, s."""
        return self._at(self.apart, time)

    def mathml(self, time: float) -> str:
        """The equation with the numbers of a time, s."""
        numbers = self.numbers(time)
        labels = {
            name: f"{written(numbers[name], one.spec)} {one.unit}" for name, one in self.symbols.items()
        }
        return labelled(self.text, labels)

    def _at(self, data: bytes, time: float) -> float:
        values = np.frombuffer(data)
        return float(values[min(max(0, round(time / self.timestep)), len(values) - 1)])


class StepRecord(msgspec.Struct, frozen=True):
    """A step with all numbers in its words; what it has depends on its kind, as in `lesson.parts`.

    Attributes:
        kind: prose, choice, number, play, compare or explain.
        text: its words.
        options: of a choice.
        right: places of the options that the runs make right.
        low: lower end of what can be predicted.
        high: upper end.
        unit: of a number.
        measured: what a number turned out to be.
        measures: what is compared: name -> value with its unit.
        run: what is played or explained.
        beside: what is played beside it.
        controls: what can be changed meanwhile.
        time: when an equation is read first, s.
        equation: what explains.
        view: from where it is looked at; empty: from where it was before.
    """

    kind: str
    text: str
    options: tuple[str, ...] = ()
    right: tuple[int, ...] = ()
    low: float = 0.0
    high: float = 0.0
    unit: str = ""
    measured: float = 0.0
    measures: dict[str, str] = {}
    run: str = ""
    beside: str = ""
    controls: tuple[str, ...] = ()
    time: float = 0.0
    equation: EquationRecord | None = None
    view: str = ""


class LessonRecord(msgspec.Struct, frozen=True):
    """A lesson that has been played on a robot.

    Attributes:
        file: its script.
        number: its place in the list.
        title: a few words.
        question: the question that drives it.
        robot: who has played it.
        runs: label -> what was played.
        steps: the way through it.
        failed: claims that did not hold.
    """

    file: str
    number: int
    title: str
    question: str
    robot: str
    runs: dict[str, Scenario]
    steps: tuple[StepRecord, ...]
    failed: tuple[str, ...]


def written(value: float, spec: str) -> str:
    """A number as people write it: with a minus, and none before a zero."""
    return plain(value, spec).replace("-", "−")


def rehearsed(file: str, robot: str) -> LessonRecord:
    """A lesson played without a screen.

    Args:
        file: its script.
        robot: who is to play it, if the lesson is for that robot; otherwise the first that it names.

    Raises:
        LessonError: something is wrong with the script.
        SimulationError: a run broke down before its end.
    """
    lesson = load_lesson(Path(file))
    name = robot if robot in lesson.robots else lesson.robots[0]
    return recorded(play_lesson(lesson, RobotModel.named(name)))


def recorded(played: Played) -> LessonRecord:
    """A lesson that has been played, as plain data.

    Raises:
        LessonError: a step has an error in it that shows only now.
    """
    lesson = played.lesson
    return LessonRecord(
        file=str(lesson.file),
        number=lesson.number,
        title=lesson.title,
        question=lesson.question,
        robot=next(iter(played.runs.values())).robot.spec.name,
        runs={label: session.scenario for label, session in played.runs.items()},
        steps=tuple(_step(step, played) for step in lesson.steps),
        failed=tuple(claim.text for claim in played.claims if not claim.holds),
    )


def _step(step: Step, played: Played) -> StepRecord:
    record = told(step, played)
    kind, text = record["kind"], record["text"]
    match step:
        case Choice():
            return StepRecord(kind, text, options=tuple(record["options"]), right=tuple(record["right"]))
        case Number(low=low, high=high):
            measured = float(record["measured"])
            return StepRecord(kind, text, low=low, high=high, unit=record["unit"], measured=measured)
        case Play(run=run, beside=beside, controls=controls, view=view):
            return StepRecord(kind, text, run=run, beside=beside or "", controls=controls, view=view or "")
        case Compare():
            return StepRecord(kind, text, measures=record["measured"])
        case Explain(run=run, time=time, equation=equation, view=view):
            with located(played.lesson.file, step.text):
                living = _living(equation, played.runs[run])
            return StepRecord(kind, text, run=run, time=time, equation=living, view=view or "")
    return StepRecord(kind, text)


def _living(equation: Equation, session: Session) -> EquationRecord:
    values = course(equation, session)
    symbols = {
        name: SymbolRecord(symbol.unit, symbol.words, symbol.spec, _bytes(values[name]))
        for name, symbol in equation.symbols.items()
    }
    return EquationRecord(
        equation.text,
        symbols,
        _bytes(apart(equation, values)),
        equation.unit,
        residual(equation, session),
        equation.within,
        session.scenario.timestep,
        session.ticks,
    )


def _bytes(values: np.ndarray) -> bytes:
    return np.atleast_1d(np.asarray(values, dtype=np.float64)).tobytes()
