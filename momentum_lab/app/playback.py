"""Playing a session: time that runs, stops, steps and slows down; another robot, another scenario."""

from __future__ import annotations

from momentum_lab.app.wire import Fallen, Truth
from momentum_lab.control.gains import declared_gains
from momentum_lab.control.registry import controller_entry
from momentum_lab.errors import InputError, SimulationError
from momentum_lab.events import (
    Event,
    LoadScenario,
    Pause,
    Play,
    Reset,
    SelectController,
    SelectRobot,
    SessionEvent,
    SetGain,
    SetPriority,
    SetSpeed,
    StepOnce,
)
from momentum_lab.physics.push import Push
from momentum_lab.recording import Sample
from momentum_lab.scenario import Scenario, changed, load_scenario
from momentum_lab.session import Session

# What a session of the app remembers, s of simulated time.
_MEMORY = 20.0


class Playback:
    """One session, and whether its time runs.

    Args:
        scenario: what to start with; it can be started again by its name.
    """

    def __init__(self, scenario: Scenario) -> None:
        self._first = scenario
        self.run = 0
        self.speed = 1.0
        self.playing = True
        self.stopped: str | None = None
        self._waiting: list[SessionEvent] = []
        self._begin(scenario)

    @property
    def latest(self) -> Sample:
        """The last sample; there always is one."""
        return self.session.recording.latest

    def take(self, event: Event) -> None:
        """Do what an event asks for.

        Raises:
            InputError: it asks for something that does not exist or is out of range; nothing has changed.
        """
        match event:
            case Play():
                if self.stopped is not None:
                    raise InputError("play", "a simulation that has stopped", "stand the robot up first")
                self.playing = True
            case Pause():
                self.playing = False
            case StepOnce(ticks):
                self.playing = False
                self.tick(ticks)
            case SetSpeed(value):
                self.speed = value
            case SelectRobot(name):
                self._begin(self._with_robot(name))
            case LoadScenario(name):
                self._begin(self._scenario(name))
            case _:
                self._pass_on(event)

    def tick(self, count: int) -> None:
        """Some ticks, fewer if the simulation cannot go on."""
        for _ in range(count):
            if self.stopped is not None:
                return
            try:
                self.session.tick()
            except SimulationError as error:
                self.stopped, self.playing = str(error), False
        self._waiting.clear()

    def truth(self, real_time_factor: float) -> Truth:
        """What is the case now; what waits for the next tick counts as done."""
        session = self.session
        priority, controller, gains = session.priority, session.controller, _values(session.gains)
        for event in self._waiting:
            match event:
                case SetPriority(value):
                    priority = value
                case SetGain(name, value):
                    gains[name] = value
                case SelectController(name):
                    controller, gains = name, _values(controller_entry(name).gains)
        return Truth(
            run=self.run,
            scenario=session.scenario.name,
            robot=session.scenario.robot,
            controller=controller,
            priority=priority,
            gains=gains,
            playing=self.playing,
            speed=self.speed,
            real_time_factor=real_time_factor,
            fall=None if session.fall is None else Fallen(session.fall.time, session.fall.reason),
            failure=session.last_failure,
            failures=session.solver_failures,
            stopped=self.stopped,
            push=_latest(session.pushes, session.time),
        )

    def _pass_on(self, event: SessionEvent) -> None:
        self.session.post(event)
        self._waiting.append(event)
        if isinstance(event, Reset):
            self.playing = self.playing or self.stopped is not None
            self.stopped = None
            self.run += 1
            self.tick(1)

    def _begin(self, scenario: Scenario) -> None:
        """A new session, standing; the old one goes on if this one cannot be made."""
        old = getattr(self, "session", None)
        robot = old.robot if old is not None and old.scenario.robot == scenario.robot else None
        session = Session(scenario, robot, capacity=round(_MEMORY / scenario.timestep))
        session.recording.reserve()
        self.session = session
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
            gains=gains,
        )

    def _scenario(self, name: str) -> Scenario:
        """The scenario of that name with the robot that is there."""
        scenario = self._first if name == self._first.name else load_scenario(name)
        return changed(scenario, robot=self.session.scenario.robot)


def _values(gains: object) -> dict[str, float]:
    return {name: float(getattr(gains, name)) for name in declared_gains(gains)}


def _latest(pushes: tuple[Push, ...], time: float) -> Push | None:
    begun = [push for push in pushes if push.start <= time]
    return max(begun, key=lambda push: push.start, default=None)
