"""A lesson in a session's process: its runs are played in sight, and measured; the person's own session waits."""

from __future__ import annotations

from pathlib import Path

from momentum_lab.app.demo_wire import DemoEvent, LeaveScenes, ShowScene
from momentum_lab.app.interlude import Interlude
from momentum_lab.app.left_runs import LeftRuns
from momentum_lab.app.lesson_runs import RunPlayback, staged
from momentum_lab.app.lesson_wire import (
    LeaveLesson,
    LessonEvent,
    LessonNews,
    OfferRun,
    OpenLesson,
    PlayRun,
    ShowRun,
)
from momentum_lab.app.playback import Playback
from momentum_lab.app.wire import OpenRun, TakeBack
from momentum_lab.errors import InputError, LabError
from momentum_lab.events import Branch, Event, LookBack, Pause, Play, Reset, SetSpeed, StepOnce
from momentum_lab.lesson import parts
from momentum_lab.lesson.loader import load_lesson
from momentum_lab.lesson.playing import measured
from momentum_lab.lesson.record import LessonRecord, recorded
from momentum_lab.robot.model import RobotModel
from momentum_lab.scenario import changed


class Classroom:
    """Whose turn it is: the person's own session, a lesson's run, or what the person tries in its place.

    Args:
        own: the person's own session.

    Attributes:
        stage: what is played and shown now.
    """

    def __init__(self, own: Playback) -> None:
        self._own = self.stage = own
        self._interlude = Interlude()
        self._left = LeftRuns()
        self._lesson: parts.Lesson | None = None
        self._robot: RobotModel | None = None
        self._runs: dict[str, RunPlayback] = {}
        self._watched: set[str] = set()
        self._seen: dict[str, None] = {}
        self._on_stage = ""
        self._begun = False
        self._offered = ""
        self._record: LessonRecord | None = None
        self._error = ""
        self._told = LessonNews()

    @property
    def in_demo(self) -> bool:
        """Whether what is on stage is a scene that nobody has asked for."""
        return self._interlude.on

    def take(self, event: Event | LessonEvent | DemoEvent | OpenRun | TakeBack) -> None:
        """Do what an event asks for, and put on stage what it is about.

        Raises:
            InputError: it asks for something that does not exist, is out of range, or comes too early.
        """
        if isinstance(event, ShowScene):
            self.stage = self._interlude.scene(self.stage, event.scenario)
            return
        self.stage = self._interlude.end(self.stage)
        if not isinstance(event, LeaveScenes):
            self._act(event)

    def _act(self, event: Event | LessonEvent | OpenRun | TakeBack) -> None:
        before = self.stage
        match event:
            case OpenLesson():
                self._open(event)
            case PlayRun(label):
                self._play(label)
            case OfferRun(label):
                self._offer(label)
            case ShowRun(label, time):
                self._show(label, time)
            case LeaveLesson():
                self._leave()
            case OpenRun(run) if before is self._own:
                self._own = self.stage = self._left.open(before, run)
            case TakeBack():
                self._take_back()
            case _:
                self._pass_on(event)
        if self.stage is not before and self.stage is not self._own:
            self.stage.speed = before.speed
            # Neighbours on stage must be told apart, and so must what they were before.
            self.stage.run = before.run + 1

    @property
    def left(self) -> tuple[str, ...]:
        """The runs that can be taken back, in words, the last one last."""
        return self._left.names

    def _take_back(self) -> None:
        """What was on stage before a run was opened; a lesson on stage goes first."""
        if self.stage is not self._own:
            raise InputError("take back", "a lesson that is open", "after it has been left")
        self._own = self.stage = self._left.take_back(self._own)

    def news(self) -> LessonNews | None:
        """How far the lesson has come, if that is not what was told last."""
        over = (label for label, playback in self._runs.items() if playback.over)
        self._seen |= {label: None for label in over if label in self._watched}
        self._measure()
        news = LessonNews(
            "" if self._lesson is None else str(self._lesson.file),
            tuple(self._seen),
            self._on_stage,
            self._record,
            self._error,
        )
        if news == self._told:
            return None
        self._told = news
        return news

    def _open(self, event: OpenLesson) -> None:
        self._leave()
        try:
            lesson = load_lesson(Path(event.file))
        except LabError as error:
            self._error = str(error)
            return
        stage = self.stage
        same = stage.session.robot if stage.session.scenario.robot == event.robot else None
        self._robot = same or RobotModel.named(event.robot)
        self._lesson, self._begun, self._told = lesson, False, LessonNews()
        self._put_on_stage(next(label for label, run in lesson.runs.items() if run is lesson.first_run))
        self.stage.playing = False

    def _play(self, label: str) -> None:
        self._watched |= self._put_on_stage(label)
        self._begun = True

    def _offer(self, label: str) -> None:
        self._put_on_stage(label)
        self.stage.playing, self._offered = False, label

    def _show(self, label: str, time: float) -> None:
        if label in self._runs:
            self.stage, self._on_stage = self._runs[label], label
        else:
            self._put_on_stage(label)
        self._begun = self._begun or time > 0.0
        if time > 0.0:
            self._runs[label].finish()
        self._runs[label].show(time)

    def _put_on_stage(self, label: str) -> set[str]:
        """A run of the lesson at its start, and the one beside it; the labels of all that is on stage now."""
        lesson, robot = self._lesson, self._robot
        if lesson is None or robot is None or label not in lesson.runs:
            known = "no lesson is open" if lesson is None else f"one of {', '.join(lesson.runs)}"
            raise InputError("run", label, known)
        runs = staged(lesson, label, robot)
        self._runs |= runs
        self.stage, self._on_stage = runs[label], label
        return set(runs)

    def _leave(self) -> None:
        self.stage, self._lesson, self._on_stage = self._own, None, ""
        self._record, self._error, self._offered = None, "", ""
        self._runs.clear()
        self._seen.clear()
        self._watched.clear()

    def _pass_on(self, event: Event | OpenRun) -> None:
        """What a hand does; a lesson's own run stays as it was measured, and the hand gets a copy of its start."""
        stage = self.stage
        if not isinstance(stage, RunPlayback) or not self._on_stage or isinstance(event, Pause | SetSpeed):
            stage.take(event)
        elif isinstance(event, Play) and (stage.over or self._waits_for_play):
            self._play(self._on_stage)
        elif not self._begun:
            first = "Play, to see the run" if self._offered else "your prediction first, then the run"
            raise InputError("lesson", "a hand on the robot", first)
        elif isinstance(event, Play | StepOnce | LookBack):
            stage.take(event)
        elif isinstance(event, Branch):
            self._branch(stage)
        else:
            self._try_out()
            if not isinstance(event, Reset):
                self.stage.take(event)

    @property
    def _waits_for_play(self) -> bool:
        """Whether the run on stage is one that its step offers, and that has not been played."""
        return self._on_stage == self._offered and self._on_stage not in self._watched

    def _try_out(self) -> None:
        """The start of a run without its pushes, for a hand to try; with the robot beside it, if that can be."""
        stage = self._runs[self._to_try()]
        scenario = changed(stage.session.scenario, pushes=(), beside=stage.hand_over)
        self.stage = Playback(scenario, stage.session.robot)
        self._on_stage = ""

    def _to_try(self) -> str:
        """The run on stage, or the one of the step that it belongs to if it has none of its own."""
        steps = () if self._lesson is None else self._lesson.steps
        plays = [step.run for step in steps if isinstance(step, parts.Play)]
        watched = [label for label in reversed(plays) if label in self._watched]
        return self._on_stage if self._on_stage in plays or not watched else watched[0]

    def _branch(self, stage: RunPlayback) -> None:
        """A copy of a run at the instant that is looked at, for a hand to go on from; the same bits lead there."""
        instant = stage.shown.number("time")
        if self._lesson is not None:
            copy = staged(self._lesson, self._on_stage, stage.session.robot)[self._on_stage]
            while copy.latest.number("time") < instant:
                copy.tick(1)
            copy.release()
            self.stage, self._on_stage = copy, ""

    def _measure(self) -> None:
        """Measure the runs once all have been seen."""
        lesson = self._lesson
        if lesson is None or self._record is not None or self._error or self.stage is self._own:
            return
        if any(label not in self._seen or not self._runs[label].over for label in lesson.runs):
            return
        try:
            sessions = {label: self._runs[label].session for label in lesson.runs}
            self._record = recorded(measured(lesson, sessions))
        except LabError as error:
            self._error = str(error)
