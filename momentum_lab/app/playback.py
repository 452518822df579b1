"""Playing a session: time that runs, stops, steps and slows down; another robot, another scenario."""

from __future__ import annotations

from dataclasses import dataclass

from momentum_lab.app.opened import NOTHING_OPENED, OpenedRun
from momentum_lab.app.wire import Fallen, OpenRun, RunTaken, Truth
from momentum_lab.control.gains import declared_gains
from momentum_lab.control.ground_sense import GroundSense
from momentum_lab.control.motion import AngularGoal
from momentum_lab.control.planner import OWN
from momentum_lab.control.registry import controller_entry
from momentum_lab.errors import InputError, SimulationError
from momentum_lab.events import (
    ApplyPush,
    ApplyPushes,
    Branch,
    Event,
    LoadScenario,
    LookBack,
    MoveGround,
    Pause,
    Play,
    Reset,
    SelectController,
    SelectPlanner,
    SelectRobot,
    SessionEvent,
    SetAngularGoal,
    SetDirections,
    SetFriction,
    SetGain,
    SetGains,
    SetGroundSense,
    SetMotion,
    SetPriority,
    SetSpeed,
    StepOnce,
    StopGround,
)
from momentum_lab.momentum.directions import directions, text_of
from momentum_lab.physics.push import Push
from momentum_lab.recording import Sample
from momentum_lab.robot.catalog import load_spec
from momentum_lab.run_file import Run, as_run, run_of
from momentum_lab.scenario import Scenario, changed, load_scenario
from momentum_lab.session import Session
from momentum_lab.timeline import Timeline

MEMORY = 60.0
"""What a session of the app remembers, s of simulated time."""

# Samples whose memory is made ready before the first tick, and in each idle moment afterwards.
_AT_ONCE, _IN_PASSING = 2000, 256


@dataclass(frozen=True, slots=True)
class Chosen:
    """What a person has chosen for a session."""

    controller: str
    priority: float
    controlled: str
    planner: str
    motion: str
    angular_goal: AngularGoal
    gains: dict[str, float]
    ground_sense: GroundSense = "told"

    def until(self, other: Chosen) -> list[SessionEvent]:
        """The events that lead from these choices to others."""
        events: list[SessionEvent] = []
        gains = self.gains
        if other.controller != self.controller:
            events.append(SelectController(other.controller))
            gains = _values(controller_entry(other.controller).gains)
        if other.priority != self.priority:
            events.append(SetPriority(other.priority))
        if other.controlled != self.controlled:
            events.append(SetDirections(other.controlled))
        if other.planner != self.planner:
            events.append(SelectPlanner(other.planner))
        if other.motion != self.motion:
            events.append(SetMotion(other.motion))
        if other.ground_sense != self.ground_sense:
            events.append(SetGroundSense(other.ground_sense))
        if other.angular_goal != self.angular_goal:
            events.append(SetAngularGoal(other.angular_goal))
        return events + [SetGain(name, value) for name, value in other.gains.items() if value != gains[name]]


class Playback:
    """One session, and whether its time runs.

    Args:
        first: what to start with; it can be started again by its scenario's name.
    """

    session: Session

    def __init__(self, first: Scenario | Run) -> None:
        self._first = as_run(first)
        self.run = 0
        self.speed = 1.0
        self.playing = True
        self.stopped: str | None = None
        self._waiting: list[SessionEvent] = []
        self._begin(self._first)

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
            case SelectRobot(name):
                self._begin(Run(self._with_robot(name)))
            case LoadScenario(name):
                self._begin(self._scenario(name))
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
            self.run += self._opened.cue(self.session)
            try:
                self.session.tick()
            except SimulationError as error:
                self.stopped, self.playing = str(error), False
            self._waiting.clear()

    def truth(self, real_time_factor: float) -> Truth:
        """What is the case now; what waits for the next tick counts as done."""
        session, chosen = self.session, self._chosen()
        return Truth(
            run=self.run,
            scenario=session.scenario.name,
            robot=session.scenario.robot,
            controller=chosen.controller,
            priority=chosen.priority,
            controlled=chosen.controlled,
            planner=chosen.planner,
            motion=chosen.motion,
            angular_goal=chosen.angular_goal,
            gains=chosen.gains,
            playing=self.playing,
            speed=self.speed,
            real_time_factor=real_time_factor,
            fall=self._fall(),
            failure=session.last_failure,
            failures=session.solver_failures,
            stopped=self.stopped,
            push=_latest(session.pushes, self.shown.number("time")),
            friction=tuple(session.ground.friction(self.shown.number("time")).tolist()),
            uneven=not session.ground.is_floor,
            floor=float(session.ground.floor.origin[2]),
            ground_sense=chosen.ground_sense,
            behind=self._behind * session.scenario.timestep,
            opened=self._opened.told(session),
        )

    def taken(self, recording: bool) -> RunTaken:
        """The run as it is now, with its samples or without."""
        session, fall = self.session, self.session.fall
        return RunTaken(
            run=run_of(session, self._waiting),
            rows=session.recording.rows().tobytes() if recording else b"",
            time=session.time,
            controller=session.controller,
            planner=session.planner,
            priority=session.priority,
            gains=_values(session.gains),
            pushes=session.pushes,
            fall=None if fall is None else Fallen(fall.time, fall.reason),
            failures=session.solver_failures,
        )

    def _chosen(self) -> Chosen:
        """The choices of this moment; those that wait for the next tick count as made."""
        session = self.session
        priority, controlled = session.priority, text_of(session.controlled)
        motion, angular_goal = session.motion, session.angular_goal
        controller, planner, gains = session.controller, session.planner, _values(session.gains)
        sense = session.ground_sense
        for event in self._waiting:
            match event:
                case SetPriority(value):
                    priority = value
                case SetDirections(text):
                    controlled = text_of(directions(text))
                case SelectPlanner(name):
                    planner = name
                case SetMotion(name):
                    motion = name
                case SetAngularGoal(goal):
                    angular_goal = goal
                case SetGroundSense(told_or_felt):
                    sense = told_or_felt
                case SetGain(name, value):
                    gains[name] = value
                case SetGains(values):
                    gains.update(values)
                case SelectController(name):
                    controller, gains = name, _values(controller_entry(name).gains)
                    planner = planner if planner in controller_entry(name).planners else OWN
        return Chosen(controller, priority, controlled, planner, motion, angular_goal, gains, sense)

    def _fall(self) -> Fallen | None:
        """The fall, unless it is still to come at the instant that is looked at."""
        fall = self.session.fall
        if fall is None or fall.time > self.shown.number("time"):
            return None
        return Fallen(fall.time, fall.reason)

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
        chosen = self._chosen()
        # The sample that is looked at is the first of the branch: it is simulated again, under the new choices.
        self._timeline.go_back(self._behind + 1)
        self._behind, self.stopped, self.playing = 0, None, True
        self._waiting.clear()
        for event in self._chosen().until(chosen):
            self._pass_on(event)
        self.tick(1)

    def _pass_on(self, event: SessionEvent) -> None:
        self.session.post(event)
        self._waiting.append(event)
        if isinstance(event, ApplyPush | ApplyPushes | MoveGround | StopGround | SetFriction):
            self._behind = 0  # it acts now, and has to be seen
        if isinstance(event, Reset):
            self._behind = 0
            self.playing = self.playing or self.stopped is not None
            self.stopped = None
            self._opened = NOTHING_OPENED  # its ticks are counted from another start
            self.run += 1
            self.tick(1)

    def _begin(self, run: Run) -> None:
        """A new session, standing; the old one goes on if this one cannot be made."""
        scenario = run.scenario
        old = getattr(self, "session", None)
        robot = old.robot if old is not None and old.scenario.robot == scenario.robot else None
        session = Session(scenario, robot, capacity=round(MEMORY / scenario.timestep))
        session.check(entry.event for entry in run.events)
        session.recording.reserve(_AT_ONCE)
        self._opened = OpenedRun(run)
        self.session, self._timeline = session, Timeline(session)
        self._behind = 0
        self._waiting.clear()
        self.stopped = None
        self.playing = True
        self.run += 1
        self.tick(1)

    def _with_robot(self, name: str) -> Scenario:
        """The same scenario, priority and gains with another robot."""
        truth = self.truth(0.0)
        defaults = _values(controller_entry(truth.controller).gains)
        gains = {name: value for name, value in truth.gains.items() if value != defaults[name]}
        return changed(
            self.session.scenario,
            robot=name,
            controller=truth.controller,
            priority=truth.priority,
            controlled=truth.controlled,
            planner=truth.planner,
            motion=truth.motion if truth.motion in load_spec(name).motions else "",
            angular_goal=truth.angular_goal,
            gains=gains,
        )

    def _scenario(self, name: str) -> Run:
        """The scenario of that name with the robot that is there; what was opened under it is played again."""
        robot = self.session.scenario.robot
        if name != self._first.scenario.name:
            return Run(changed(load_scenario(name), robot=robot))
        if robot == self._first.scenario.robot:
            return self._first
        return Run(changed(self._first.scenario, robot=robot))


def _values(gains: object) -> dict[str, float]:
    return {name: float(getattr(gains, name)) for name in declared_gains(gains)}


def _latest(pushes: tuple[Push, ...], time: float) -> Push | None:
    begun = [push for push in pushes if push.start <= time]
    return max(begun, key=lambda push: push.start, default=None)
