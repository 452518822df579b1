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
        """Whether the open step's prediction can not be changed any more: a run that answers it has been seen."""
        ahead = (place for place, step in enumerate(self.record.steps) if place >= self.place)
        answering = next((place for place in ahead if self.record.steps[place].kind == "play"), None)
        return answering is not None and not self._shown(answering).isdisjoint(self.news.seen)

    @property
    def played(self) -> str:
        """The run of the last step that is played on the way here, or of the first that will be."""
        runs = [step.run for step in self.record.steps if step.kind == "play"]
        behind = [step.run for step in self.record.steps[: self.place + 1] if step.kind == "play"]
        return behind[-1] if behind else runs[0]

    def runs_to_play(self) -> tuple[str, ...]:
        """The runs that the open step plays one after the other: its own, and those that no step plays."""
        return self._played(self.place)

    @property
    def all_seen(self) -> bool:
        """Whether everything that the open step plays has been seen to its end."""
        return self._shown(self.place) <= set(self.news.seen)

    @property
    def measured_in_sight(self) -> bool:
        """Whether everything that was played up to the open step has been seen."""
        plays = (place for place in range(self.place) if self.record.steps[place].kind == "play")
        return all(self._shown(place) <= set(self.news.seen) for place in plays)

    def _played(self, place: int) -> tuple[str, ...]:
        steps = self.record.steps
        of_steps = {run for step in steps if step.kind == "play" for run in (step.run, step.beside)}
        rest = [run for run in self.record.runs if run not in of_steps]
        return tuple(dict.fromkeys([steps[place].run, *rest]))

    def _shown(self, place: int) -> set[str]:
        """The runs that a step plays, with the one beside its own."""
        beside = self.record.steps[place].beside
        return {*self._played(place), beside} if beside else set(self._played(place))

    def to_compare(self) -> list[tuple[StepRecord, float | None]]:
        """The predictions that the open step looks back at, each with what was answered."""
        found: list[tuple[StepRecord, float | None]] = []
        for place, step in enumerate(self.record.steps[: self.place]):
            if step.kind == "compare":
                found.clear()
            elif step.kind in PREDICTED:
                found.append((step, self.answers.get(place)))
        return found
