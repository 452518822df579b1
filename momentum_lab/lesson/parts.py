"""What a lesson consists of, as plain data."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from momentum_lab.control.gains import with_gains
from momentum_lab.control.registry import controller_entry
from momentum_lab.events import SessionEvent, SetGain
from momentum_lab.experiments.choice import chosen
from momentum_lab.experiments.claims import Runs
from momentum_lab.lesson.equation import Equation
from momentum_lab.scenario import Scenario, changed

Value = float | str
Values = Mapping[str, Value]
PUSH_CONTROLS = ("push", "push direction", "push duration", "push height")
CONTROLS = (*PUSH_CONTROLS, "priority", "robot", "controller", "momenta", "angular goal")
VIEWS = ("Whole robot", "Feet", "Side", "Front", "Above")
"""From where a step may want to be looked at."""


@dataclass(frozen=True, slots=True)
class Run:
    """A run that a lesson looks at.

    Attributes:
        scenario: name of a scenario.
        changes: fields of the scenario that differ.
        events: what happens meanwhile: (time, s; event).

    Raises:
        InputError: the scenario, a field of it or a gain is unknown or out of range.
    """

    scenario: str
    changes: Mapping[str, Any] = field(default_factory=dict)
    events: tuple[tuple[float, SessionEvent], ...] = ()

    def __post_init__(self) -> None:
        scenario = self.for_robot(None)
        gains = controller_entry(scenario.controller).gains
        with_gains(gains, scenario.gains)
        for _, event in self.events:
            if isinstance(event, SetGain):
                with_gains(gains, {event.name: event.value})

    def for_robot(self, robot: str | None) -> Scenario:
        """The scenario for a robot; None: for the scenario's own."""
        return changed(chosen(self.scenario, robot), **self.changes)


@dataclass(frozen=True, slots=True)
class Measure:
    """A quantity that the prose may name in braces.

    Attributes:
        value: the quantity, from the runs by label.
        unit: of the value; empty for words.
        spec: how the number is written, a Python format.
    """

    value: Callable[[Runs], Value]
    unit: str = ""
    spec: str = ".0f"


@dataclass(frozen=True, slots=True)
class Prose:
    """A few sentences."""

    text: str


@dataclass(frozen=True, slots=True)
class Option:
    """One answer, and when it is the right one: decided by the measured values, not by the author."""

    text: str
    right: Callable[[Values], bool]


@dataclass(frozen=True, slots=True)
class Choice:
    """A prediction by choosing one of a few options, of which the runs make exactly one right."""

    text: str
    options: tuple[Option, ...]


@dataclass(frozen=True, slots=True)
class Number:
    """A prediction of a number.

    Attributes:
        text: what is asked.
        measure: the measure that answers it.
        low: lower end of what can be predicted, in the measure's unit.
        high: upper end.
    """

    text: str
    measure: str
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class Play:
    """Time to try.

    Attributes:
        text: what to look at, not what to click.
        run: the run it starts with.
        controls: what can be changed: `CONTROLS` or gains of the run's controller.
        beside: a second run, played and shown beside the first. Where both differ only in controller, priority or
            gains, both are there for a hand, too.
        view: from where it is looked at, one of `VIEWS`; None: from where it was before.
    """

    text: str
    run: str
    controls: tuple[str, ...] = ()
    beside: str | None = None
    view: str | None = None


@dataclass(frozen=True, slots=True)
class Compare:
    """What was measured, to be read against the prediction."""

    text: str
    measures: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Explain:
    """Why: an equation with the numbers of a run.

    Attributes:
        text: what it says, in words.
        run: the run.
        time: when the numbers are read, s.
        equation: its symbols carry them.
        view: from where it is looked at, one of `VIEWS`; None: from where it was before.
    """

    text: str
    run: str
    time: float
    equation: Equation
    view: str | None = None


@dataclass(frozen=True, slots=True)
class Bound:
    """A claim: a measure is not below `low` or not above `high`."""

    words: str
    measure: str
    low: float | None = None
    high: float | None = None


@dataclass(frozen=True, slots=True)
class Stands:
    """A claim: the robot of a run does not fall."""

    run: str
    words: str = "the robot"


@dataclass(frozen=True, slots=True)
class Falls:
    """A claim: the robot of a run falls."""

    run: str
    words: str = "the robot"


Step = Prose | Choice | Number | Play | Compare | Explain
Asserted = Bound | Stands | Falls


@dataclass(frozen=True, slots=True)
class Lesson:
    """One question and the way to its answer.

    Attributes:
        file: its script.
        number: its place in the list.
        title: a few words.
        question: the question that drives it.
        robots: the robots on which its claims are tested; the first is the usual one.
        runs: label -> run.
        measures: name -> measure.
        steps: the way, in its order.
        claims: what the runs have to show.
    """

    file: Path
    number: int
    title: str
    question: str
    robots: tuple[str, ...]
    runs: Mapping[str, Run]
    measures: Mapping[str, Measure]
    steps: tuple[Step, ...]
    claims: tuple[Asserted, ...]

    @property
    def first_run(self) -> Run:
        """The run of the first step that is played."""
        return self.runs[next(step.run for step in self.steps if isinstance(step, Play))]

    def beside(self, label: str) -> str | None:
        """The run that is played and shown beside a run; None: it is shown alone."""
        return next(
            (step.beside for step in self.steps if isinstance(step, Play) and step.run == label), None
        )
