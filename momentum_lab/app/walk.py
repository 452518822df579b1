"""A learner's way through a lesson: where it has come to, what was predicted, and what may come next."""

from __future__ import annotations

from dataclasses import dataclass, field

from momentum_lab.app.lesson_wire import LessonNews
from momentum_lab.lesson.record import LessonRecord, StepRecord

PREDICTED = ("choice", "number")


@dataclass
class Walk:
    """A lesson that is open.

    Attributes:
        rehearsed: what the lesson showed when it was played out of sight.
        place: the step that is open.
        answers: step -> what was predicted: the place of an option, or a number.
        news: how far it has come in the session's process.
    """

    rehearsed: LessonRecord
    place: int = 0
    answers: dict[int, float] = field(default_factory=dict)
    news: LessonNews = field(default_factory=LessonNews)

    @property
    def record(self) -> LessonRecord:
        """What the runs have shown: those that were seen, as soon as they are all there."""
        return self.news.record or self.rehearsed

    @property
    def step(self) -> StepRecord:
        """The step that is open."""
        return self.record.steps[self.place]

    @property
    def last(self) -> bool:
        """Whether no step follows."""
        return self.place == len(self.record.steps) - 1

    @property
    def waits(self) -> bool:
        """Whether a prediction has to be made before anything else comes."""
        return self.step.kind in PREDICTED and self.place not in self.answers

    @property
    def frozen(self) -> bool:
        """Whether predictions can not be changed any more: a run has been seen."""
        return bool(self.news.seen)

    @property
    def played(self) -> str:
        """The run of the last step that is played on the way here, or of the first that will be."""
        runs = [step.run for step in self.record.steps if step.kind == "play"]
        behind = [step.run for step in self.record.steps[: self.place + 1] if step.kind == "play"]
        return behind[-1] if behind else runs[0]

    def runs_to_play(self) -> tuple[str, ...]:
        """The runs of the step that is open: its own, the one beside it, and those that no other step plays."""
        step, steps = self.step, self.record.steps
        elsewhere = {
            run
            for other in steps
            if other is not step
            for run in (other.run, other.beside)
            if other.kind == "play"
        }
        rest = [run for run in self.record.runs if run not in elsewhere]
        own = [run for run in (step.run, step.beside) if run]
        return tuple(dict.fromkeys([*own, *rest]))

    def to_compare(self) -> list[tuple[StepRecord, float | None]]:
        """The predictions that the open step looks back at, each with what was answered."""
        found: list[tuple[StepRecord, float | None]] = []
        for place, step in enumerate(self.record.steps[: self.place]):
            if step.kind == "compare":
                found.clear()
            elif step.kind in PREDICTED:
                found.append((step, self.answers.get(place)))
        return found
