"""Playing a session: time that runs, stops, steps and slows down; another robot, another scenario."""

from __future__ import annotations

from contextlib import suppress

import msgspec

from momentum_lab.app.beginnings import Forgetting, is_handled
from momentum_lab.app.companion import Companion
from momentum_lab.app.foresight import Foresight
from momentum_lab.app.opened import NOTHING_OPENED, OpenedRun
from momentum_lab.app.restart import named_run, once_more, with_robot
from momentum_lab.app.truth import Clock, recorded_of, taken_of, truth_of
from momentum_lab.app.wire import Foreseen, OpenRun, RunTaken, Truth
from momentum_lab.beside import Beside
from momentum_lab.errors import InputError, SimulationError
from momentum_lab.events import (
    ApplyPush,
    ApplyPushes,
    Branch,
    Event,
    Foresee,
    HoldPush,
    LetGo,
    LoadScenario,
    LookBack,
    MoveGround,
    Pause,
    Play,
    Reset,
    RunAgain,
    SelectRobot,
    SessionEvent,
    SetBeside,
    SetFriction,
    SetSpeed,
    StepOnce,
    StopGround,
)
from momentum_lab.physics.push import Push
from momentum_lab.recording import Sample
from momentum_lab.robot.model import RobotModel
from momentum_lab.run_file import Run, as_run
from momentum_lab.scenario import Scenario, sides
from momentum_lab.session import Session
from momentum_lab.timeline import Timeline

MEMORY = 60.0
"""What a session of the app remembers, s of simulated time."""

# Samples whose memory is made ready before the first tick, and in each idle moment afterwards.
_AT_ONCE, _IN_PASSING = 2000, 256


class Playback:
    """One session, and whether its time runs.

    Args:
        first: what to start with; it can be started again by its scenario's name.
        robot: its robot, if it is loaded already.
    """

    session: Session
    names: tuple[str, str] | None = None
    """What to call the two robots, if not by what differs."""

    def __init__(self, first: Scenario | Run, robot: RobotModel | None = None) -> None:
        self._first = as_run(first)
        self.run = 0
        self.speed = 1.0
        self.playing = True
        self.stopped: str | None = None
        self.beside: Companion | None = None
        self.foresights: tuple[Foresight, ...] = ()
        self._waiting: list[SessionEvent] = []
        self._forgetting = Forgetting()
        self._begin(self._first, robot)

    @property
    def latest(self) -> Sample:
        """The last sample; there always is one."""
        return self.session.recording.latest

    @property
    def shown(self) -> Sample:
        """The sample that is looked at: the last one, or an earlier one while somebody looks back."""
        return self.session.recording.before_end(self._behind)

    def prepare(self) -> None:
        """Use a moment in which nothing has to be done."""
        self.session.recording.reserve(_IN_PASSING)

    def take(self, event: Event | OpenRun) -> None:
        """Do what an event asks for.

        Raises:
            InputError: it asks for something that does not exist or is out of range; nothing has changed.
        """
        match event:
            case Play():
                if self.stopped is not None:
                    raise InputError("play", "a simulation that has stopped", "stand the robot up first")
                self.playing, self._behind = True, 0
            case Pause():
                self.playing = False
            case StepOnce(ticks):
                self.playing = False
                self._step(ticks)
            case LookBack(seconds):
                self.playing = False
                self._look_back(round(seconds / self.session.scenario.timestep))
            case Branch():
                self._branch()
            case SetSpeed(value):
                self.speed = value
            case SetBeside(beside):
                self._put_beside(beside)
            case Foresee(push):
                self._foresee(push)
            case RunAgain():
                coming = self._opened.coming(self.session)
                self._begin(once_more(self.session, self._waiting, coming, self._difference))
            case SelectRobot(name):
                self._begin(Run(with_robot(name, self.session, self._waiting, self._difference)))
            case LoadScenario(name):
                self._begin(named_run(name, self._first, self.session.scenario.robot))
            case OpenRun(run):
                self._begin(run)
                self._first = run
            case _:
                self._pass_on(event)

    def tick(self, count: int) -> None:
        """Some ticks, fewer if the simulation cannot go on."""
        for _ in range(count):
            if self.stopped is not None or self._opened.ends(self.session):
                self.playing = False
                break
            self._timeline.note()
            self._cue()
            try:
                self.session.tick()
            except SimulationError as error:
                self.stopped, self.playing = str(error), False
            if self.beside is not None:
                self.beside.tick()
            self._waiting.clear()

    def truth(self, real_time_factor: float) -> Truth:
        """What is the case now; what waits for the next tick counts as done."""
        clock = Clock(
            run=self.run,
            playing=self.playing,
            speed=self.speed,
            real_time_factor=real_time_factor,
            stopped=self.stopped,
            behind=self._behind * self.session.scenario.timestep,
        )
        opened = self._opened.told(self.session)
        return truth_of(
            self.session, self._waiting, self.shown, clock, self._difference, opened, self._forgotten()
        )

    def _forgotten(self) -> tuple[float, ...]:
        """When a hand has pushed that would not push again after going on from what is looked at, s."""
        tick = self.session.ticks - self._behind - 1
        return self._forgetting.times(self.session, tick, self._opened.events) if self._behind else ()

    def taken(self) -> RunTaken:
        """The run as it is now, without samples; a second robot is in its scenario."""
        return taken_of(self.session, self._waiting, self._difference)

    def recorded(self) -> RunTaken:
        """The run as it is now, with the samples of both robots."""
        recorded = recorded_of(self.session, self._waiting, self._difference)
        if self.beside is None:
            return recorded
        other = recorded_of(self.beside.session, self.beside.waiting, None)
        return msgspec.structs.replace(
            recorded, other=msgspec.structs.replace(other, since=self.beside.since)
        )

    @property
    def _difference(self) -> Beside | None:
        """What a robot beside the first does differently."""
        return None if self.beside is None else self.beside.beside

    def beside_truth(self, first: Truth) -> Truth | None:
        """What is the case with the robot beside the first."""
        return None if self.beside is None else self.beside.truth(first, self._behind)

    @property
    def beside_shown(self) -> Sample | None:
        """The sample of the robot beside the first that is looked at."""
        return None if self.beside is None else self.beside.shown(self._behind)

    def look_ahead(self, ticks: int) -> tuple[Foreseen, ...]:
        """Some ticks of what is being foreseen; the answers once they are all there, else nothing."""
        done = [foresight.go_on(ticks) for foresight in self.foresights]
        if not all(done):
            return ()
        answers = tuple(foresight.answer() for foresight in self.foresights)
        self.foresights = ()
        return answers

    @property
    def foreseen_part(self) -> float | None:
        """How much of what is being foreseen is done, from 0 to 1; None when nothing is."""
        return min((foresight.part for foresight in self.foresights), default=None)

    def _look_back(self, ticks: int) -> None:
        """Look at an earlier sample, the oldest that there is if that is too far."""
        self._behind = min(max(0, ticks), len(self.session.recording) - 1)

    def _step(self, ticks: int) -> None:
        """Forward through what has been, then through what has not been yet."""
        through = min(ticks, self._behind)
        self._behind -= through
        self.tick(ticks - through)

    def _branch(self) -> None:
        """Go on from what is looked at with what has been chosen by now; what came after it is forgotten."""
        if not self._behind:
            self.playing = self.stopped is None
            return
        if not self._timeline.remembers(self._behind + 1):
            self._pass_on(Reset())  # the first sample of a robot that was stood up: it is stood up again
            self.playing = True
            return
        chosen = self.session.choices_after(self._waiting)
        # The sample that is looked at is the first of the branch: it is simulated again, under the new choices.
        self._timeline.go_back(self._behind + 1)
        if self.beside is not None and not self.beside.back(self._behind + 1):
            self.beside = Companion.of(self.session, self.beside.beside)
        self._behind, self.stopped, self.playing = 0, None, True
        self._waiting.clear()
        for event in self.session.choices_after(self._waiting).until(chosen):
            self._pass_on(event)
        if self.session.holds and not is_handled(self._opened.coming(self.session)):
            self._post(LetGo())  # whoever held it has let go in what is forgotten
        self.tick(1)

    def _cue(self) -> None:
        """Let the robots do what was done at this tick of an opened run, as far as they can by now."""
        for event in self._opened.due(self.session):
            with suppress(InputError):  # another controller has no such gain: the run's end tells of it
                self._post(event)
                self.run += isinstance(event, Reset)

    def _post(self, event: SessionEvent) -> None:
        """Let the robots do something at the start of their next tick."""
        self.session.post(event)
        self._waiting.append(event)
        if self.beside is not None:
            self.beside.take(event)
            self.beside.align(self.session.choices_after(self._waiting))

    def _pass_on(self, event: SessionEvent) -> None:
        self._post(event)
        if isinstance(event, ApplyPush | ApplyPushes | HoldPush | MoveGround | StopGround | SetFriction):
            self._behind = 0  # it acts now, and has to be seen
        if isinstance(event, Reset):
            self._behind = 0
            self.playing = self.playing or self.stopped is not None
            self.stopped = None
            self._opened = NOTHING_OPENED  # its ticks are counted from another start
            self.run += 1
            self.tick(1)

    def _begin(self, run: Run, robot: RobotModel | None = None) -> None:
        """A new session, standing; the old one goes on if this one cannot be made."""
        scenario = run.scenario
        old = getattr(self, "session", None)
        if old is not None and old.scenario.robot == scenario.robot:
            robot = old.robot
        sessions = []
        for side in sides(scenario):
            sessions.append(Session(side, robot, capacity=round(MEMORY / scenario.timestep)))
            sessions[-1].recording.reserve(_AT_ONCE)
            robot = sessions[-1].robot
        sessions[0].check(entry.event for entry in run.events)
        beside = scenario.beside
        self.beside = None if beside is None else Companion(sessions[-1], beside)
        self.foresights = ()
        self._opened = OpenedRun(run)
        self.session, self._timeline = sessions[0], Timeline(sessions[0])
        self._behind = 0
        self._waiting.clear()
        self.stopped = None
        self.playing = True
        self.run += 1
        self.tick(1)

    def _put_beside(self, beside: Beside | None) -> None:
        """A robot beside the first that differs so; it begins where the first one is."""
        if beside is None:
            self.beside = None
            return
        chosen = self.session.choices_after(self._waiting)
        chosen.beside(beside)  # refuses what cannot be, before anything has changed
        if self.beside is None:
            self.beside = Companion.of(self.session, beside)
            for event in self._waiting:
                self.beside.take(event)
        self.beside.beside = beside
        self.beside.align(chosen)

    def _foresee(self, push: Push) -> None:
        """Begin to try a push on copies of the sessions."""
        found = [Foresight(self.session, self._waiting, push)]
        if self.beside is not None:
            found.append(Foresight(self.beside.session, self.beside.waiting, push))
        self.foresights = tuple(found)
