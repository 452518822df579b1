"""The conductor: events in, ticks on, samples out. The same scenario and events give the same bits.

It keeps the world and the clock; `momentum_lab.steering` is between the robot's senses and its motors.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from momentum_lab.changing import changing, put_back
from momentum_lab.choices import Choices
from momentum_lab.control.controller import ControlOutput
from momentum_lab.effects import ground_after, pushed_after, sized
from momentum_lab.errors import SimulationError
from momentum_lab.events import (
    LoggedEvent,
    MoveGround,
    Reset,
    SelectController,
    SelectPlanner,
    SessionEvent,
    SetAngularGoal,
    SetDirections,
    SetFriction,
    SetGroundSense,
    SetMismatch,
    SetMotion,
    StopGround,
)
from momentum_lab.fall import Fall, fall_of
from momentum_lab.momentum.foot_ground import FootGround
from momentum_lab.observe import Tick, observe
from momentum_lab.physics.engines import check_ground, check_mismatch, world
from momentum_lab.physics.ground import Ground
from momentum_lab.physics.held_push import Pushed
from momentum_lab.physics.mismatch import EXACT, real_robot
from momentum_lab.physics.motors import Line, delayed, ticks_late
from momentum_lab.physics.push import Push
from momentum_lab.physics.sensors import measured
from momentum_lab.physics.simulator import Step
from momentum_lab.recording import Layout, Recording, Sample
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics, State
from momentum_lab.scenario import Scenario
from momentum_lab.start import stance_of, standing_state, starting_state
from momentum_lab.steering import Steering
from momentum_lab.terrain import terrain


@dataclass(frozen=True, slots=True)
class Snapshot:
    """Where a session was at the start of a tick: all that changes while it runs.

    Attributes:
        ticks: how many ticks it had done.
        tick_of_run: how many of them since the robot stood up.
        changing: what changes in the session itself, by name.
        steering: what changes in its steering, by name.
    """

    ticks: int
    tick_of_run: int
    changing: dict[str, Any]
    steering: dict[str, Any]


class Session:
    """One robot, one controller, one clock.

    Args:
        scenario: what is decided before the run.
        robot: the scenario's robot, if it is loaded already.
        capacity: ticks that the recording keeps; None: as many as the scenario is long.

    Raises:
        InputError: the scenario names something that does not exist.
    """

    # What changes while the session runs, and a snapshot holds; everything else is decided when it begins.
    state: State
    choices: Choices
    _pushed: Pushed
    fall: Fall | None
    solver_failures: int
    last_failure: str | None
    _scripted: tuple[Push, ...]
    _ground: Ground
    _line: Line

    def __init__(
        self, scenario: Scenario, robot: RobotModel | None = None, capacity: int | None = None
    ) -> None:
        self.scenario = scenario
        self.robot = robot or RobotModel.named(scenario.robot)
        self.choices = Choices.of(scenario)
        check_mismatch(scenario.engine, scenario.mismatch)
        self.stance = stance_of(self.robot, scenario.stance)
        self._ground = self._first_ground = terrain(scenario, self.robot, self.stance)
        self._scripted = tuple(sized(push, self.robot) for push in scenario.pushes)
        self._start = starting_state(self.robot, scenario)
        home = self.robot.at(standing_state(self.robot, scenario))
        self._standing_height = float(home.com_in_world[2]) - self._ground.at(0.0).height
        self.steering = Steering(self.robot, home, self.stance, scenario.timestep, self.choices)
        self.recording = Recording(Layout.of(self.robot), capacity or self.scenario_ticks)
        self.log: list[LoggedEvent] = []
        self.ticks = self._tick_of_run = 0
        self._inbox: deque[SessionEvent] = deque()
        # Choices and ground once all that is in the inbox has been done.
        self._coming = (self.choices, self._ground)
        self._stand_up()

    @property
    def time(self) -> float:
        """Simulated time since the robot stood up, s."""
        return self._tick_of_run * self.scenario.timestep

    @property
    def scenario_ticks(self) -> int:
        """How many ticks the scenario lasts."""
        return math.ceil(self.scenario.seconds / self.scenario.timestep - 1e-9)

    @property
    def dynamics(self) -> Dynamics:
        """The present state of the robot that is simulated, with everything computed."""
        return self._real.at(self.state)

    @property
    def ground(self) -> Ground:
        """What the robot can touch, as it is and as it will move."""
        return self._ground

    @property
    def pushes(self) -> tuple[Push, ...]:
        """All pushes since the robot stood up, sized; one that is held has lasted until now."""
        return self._pushed.until(self.time, self.scenario.timestep)

    def pushes_after(self, events: Iterable[SessionEvent]) -> tuple[Push, ...]:
        """All pushes there will be once some events have been done at the start of the next tick."""
        pushed = self._pushed
        for event in events:
            pushed = pushed_after(pushed, event, self.robot, self.time)
        return pushed.until(self.time, self.scenario.timestep)

    @property
    def holds(self) -> bool:
        """Whether a push is held."""
        return self._pushed.held is not None

    def post(self, event: SessionEvent) -> None:
        """Put an event into the inbox; it takes effect at the start of the next tick.

        Raises:
            InputError: the event asks for something that does not exist or is out of range.
        """
        self._coming = self._checked(event)
        self._inbox.append(event)

    def choices_after(self, events: Iterable[SessionEvent]) -> Choices:
        """What will have been chosen after some events."""
        return self.choices.after_all(events, self.robot)

    def check(self, events: Iterable[SessionEvent]) -> None:
        """Refuse events that could not be done one after the other; none of them is done.

        Raises:
            InputError: one asks for something that does not exist or is out of range.
        """
        waiting, coming = tuple(self._inbox), self._coming
        try:
            for event in events:
                self.post(event)
        finally:
            self._inbox, self._coming = deque(waiting), coming

    def tick(self) -> Sample:
        """One step of control and physics.

        Raises:
            SimulationError: the state is not finite any more; the recording holds everything before.
        """
        self._drain_inbox()
        dynamics = self.dynamics
        time = self.time
        plates = self._ground.at(time)
        output = self._control(self._believed(dynamics), plates, time)
        torque, self._line = delayed(self._line, output.torque, self._ticks_late)
        step = self._simulator.step(dynamics, torque, self._pushed.all, time)
        self.fall = self.fall or fall_of(time, dynamics, step, plates.height, self._standing_height)
        sample = self._record(dynamics, output, step, plates)
        self._advance(output, step)
        return sample

    def snapshot(self) -> Snapshot:
        """Where the session is, between two ticks."""
        return Snapshot(self.ticks, self._tick_of_run, changing(self), changing(self.steering))

    def resume(self, snapshot: Snapshot) -> None:
        """Go back to where the session was; what has been recorded, logged and posted since is forgotten."""
        # The snapshot may be another session's, and ahead of this one.
        self.recording.forget_last(max(0, self._tick_of_run - snapshot.tick_of_run))
        put_back(self, snapshot.changing)
        put_back(self.steering, snapshot.steering)
        self.ticks, self._tick_of_run = snapshot.ticks, snapshot.tick_of_run
        self.log = [entry for entry in self.log if entry.tick < snapshot.ticks]
        self._inbox.clear()
        self._build()

    def _drain_inbox(self) -> None:
        while self._inbox:
            event = self._inbox.popleft()
            self.log.append(LoggedEvent(self.ticks, event))
            self._apply(event)

    def _believed(self, dynamics: Dynamics) -> Dynamics:
        """The state as the controller sees it: measured, and computed with the robot it believes in."""
        if self.choices.mismatch == EXACT:
            return dynamics
        seed, tick = self.scenario.seed, self._tick_of_run
        return self.robot.at(measured(self.robot, dynamics.state, self.choices.mismatch, seed, tick))

    def _control(self, dynamics: Dynamics, plates: FootGround, time: float) -> ControlOutput:
        """What steers the robot; one that has fallen goes limp."""
        if self.fall is not None:
            return self.steering.limp(dynamics)
        output = self.steering.output(dynamics, plates, self.choices, time)
        if output.failure is not None:
            self.solver_failures += 1
            self.last_failure = output.failure
        return output

    def _record(self, dynamics: Dynamics, output: ControlOutput, step: Step, plates: FootGround) -> Sample:
        fallen, priority = self.fall is not None, self.choices.priority
        clock = self.time, self.scenario.timestep
        observe(
            self.recording.next_row(),
            Tick(self._real, *clock, dynamics, output, step, plates, priority, fallen),
        )
        return self.recording.latest

    def _advance(self, output: ControlOutput, step: Step) -> None:
        self.steering.remember(output.memory, step.torque, step.foot_wrench)
        self.state = step.state
        self.ticks += 1
        self._tick_of_run += 1
        if not step.state.is_finite():
            raise SimulationError(f"the state is not finite after {self.time:.3f} s; the recording is kept")

    def _checked(self, event: SessionEvent) -> tuple[Choices, Ground]:
        """What will be the case after an event that comes after those in the inbox; refuses what cannot be done."""
        robot, engine = self.robot, self.scenario.engine
        choices, ground = self._coming if self._inbox else (self.choices, self._ground)
        choices, ground = choices.after(event, robot), ground_after(ground, event, robot, self.time)
        if isinstance(event, Reset):
            ground = self._first_ground
        check_mismatch(engine, choices.mismatch)
        check_ground(engine, ground)
        pushed_after(self._pushed, event, robot, self.time)
        return choices, ground

    def _apply(self, event: SessionEvent) -> None:
        self.choices = self.choices.after(event, self.robot)
        self._pushed = pushed_after(self._pushed, event, self.robot, self.time)
        self._ground = ground_after(self._ground, event, self.robot, self.time)
        match event:
            case SelectController():
                self.steering.select(self.choices, self._believed(self.dynamics))
            case SetDirections() | SelectPlanner() | SetGroundSense():
                self.steering.take_over()
            case SetMotion():
                self.steering.move(self.choices, self.time)
            case SetAngularGoal():
                self.steering.aim(self.choices)
            case SetMismatch() | SetFriction() | MoveGround() | StopGround():
                self._build()
            case Reset():
                self._scripted = ()
                self._stand_up()

    def _build(self) -> None:
        """The robot that is simulated and its world, out of what is the case."""
        self._real = real_robot(self.robot, self.choices.mismatch)
        self._ticks_late = ticks_late(self.choices.mismatch.torque_delay_ms, self.scenario.timestep)
        self._simulator = world(self.scenario.engine, self._real, self._ground, self.scenario.timestep)

    def _stand_up(self) -> None:
        """The robot where it started, the clock at zero."""
        self.state = self._start
        self._pushed = Pushed(self._scripted)
        self.fall = None
        self.solver_failures, self.last_failure = 0, None
        self._tick_of_run = 0
        self._ground = self._first_ground
        self._line = ()
        self._build()
        self.steering.stand_up(self._believed(self.dynamics), self._ground.at(0.0))
        self.recording.clear()
