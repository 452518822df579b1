"""The conductor: events in, ticks on, samples out. The same scenario and events give the same bits."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import msgspec
import numpy as np

from momentum_lab.control.controller import Controller, ControlOutput
from momentum_lab.control.fallback import limp
from momentum_lab.control.gains import with_gains
from momentum_lab.control.ground_sense import GroundSense, felt_ground, ground_sense
from momentum_lab.control.handover import Handover
from momentum_lab.control.motion import AngularGoal, MovingGoal, reach_of
from momentum_lab.control.planner import OWN
from momentum_lab.control.registry import check_planner, controller_entry
from momentum_lab.control.standing import StandingGoal
from momentum_lab.errors import InputError, SimulationError
from momentum_lab.events import (
    ApplyPush,
    ApplyPushes,
    HoldPush,
    LetGo,
    LoggedEvent,
    MoveGround,
    Reset,
    SelectController,
    SelectPlanner,
    SessionEvent,
    SetAngularGoal,
    SetDirections,
    SetFriction,
    SetGain,
    SetGains,
    SetGroundSense,
    SetMismatch,
    SetMotion,
    SetPriority,
    StopGround,
)
from momentum_lab.momentum.directions import Directions, directions
from momentum_lab.momentum.foot_ground import FootGround
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.observe import Tick, observe
from momentum_lab.physics.engines import check_ground, check_mismatch, world
from momentum_lab.physics.ground import Ground, checked_friction
from momentum_lab.physics.mismatch import EXACT, Mismatch, real_robot, with_error
from momentum_lab.physics.motors import Line, delayed, ticks_late
from momentum_lab.physics.held_push import Pushed
from momentum_lab.physics.push import Push, pushed_frame
from momentum_lab.physics.sensors import measured
from momentum_lab.physics.simulator import Step
from momentum_lab.recording import Layout, Recording, Sample
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics, State
from momentum_lab.scenario import Scenario
from momentum_lab.start import stance_of, standing_state, starting_state
from momentum_lab.terrain import terrain

# A robot whose CoM is lower than this part of its standing height has fallen.
_FALLEN_HEIGHT = 0.6
# The force sensor of a foot feels the ground from this part of the weight on.
_FELT = 0.02


@dataclass(frozen=True, slots=True)
class Fall:
    """When the robot fell, and why it counts as fallen.

    Attributes:
        time: simulated time, s.
        reason: in words.
    """

    time: float
    reason: str


@dataclass(frozen=True, slots=True)
class Snapshot:
    """Where a session was at the start of a tick: all that changes while it runs.

    Attributes:
        ticks: how many ticks it had done.
        changing: its changing attributes by name; none of them is ever changed in place.
    """

    ticks: int
    changing: dict[str, Any]


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
    _pushed: Pushed
    priority: float
    controlled: Directions
    planner: str
    motion: str
    angular_goal: AngularGoal
    ground_sense: GroundSense
    mismatch: Mismatch
    controller: str
    gains: Any
    fall: Fall | None
    solver_failures: int
    last_failure: str | None
    _scripted: tuple[Push, ...]
    _ground: Ground
    _known: FootGround
    _foot_wrench: np.ndarray
    _motion: MovingGoal | None
    _motion_start: float
    _controller: Controller
    _memory: Any
    _torque: np.ndarray | None
    _line: Line
    _taken_over: bool
    _handover: Handover | None
    _tick_of_run: int

    def __init__(
        self, scenario: Scenario, robot: RobotModel | None = None, capacity: int | None = None
    ) -> None:
        self.scenario = scenario
        self.robot = robot or RobotModel.named(scenario.robot)
        self.stance = stance_of(self.robot, scenario.stance)
        self._weight = self.robot.mass * GRAVITY
        self._ground = self._first_ground = terrain(scenario, self.robot, self.stance)
        self._start = starting_state(self.robot, scenario)
        home = self.robot.at(standing_state(self.robot, scenario))
        self._standing_height = float(home.com_in_world[2]) - self._ground.at(0.0).height
        self._goal = StandingGoal(self.robot, home, self.stance)
        self._home, self._tick_of_run = home, 0
        self._move(scenario.motion, scenario.angular_goal, 0.0)
        self._scripted = tuple(self._checked_push(push) for push in scenario.pushes)
        self.recording = Recording(Layout.of(self.robot), capacity or self.scenario_ticks)
        self.priority = scenario.priority
        self.ground_sense = scenario.ground_sense
        self.mismatch = scenario.mismatch
        check_mismatch(scenario.engine, scenario.mismatch)
        self.controlled = directions(scenario.controlled)
        self.log: list[LoggedEvent] = []
        self.ticks = 0
        self._inbox: deque[SessionEvent] = deque()
        self.planner = check_planner(scenario.planner, scenario.controller)
        self._select(scenario.controller)
        self.gains = with_gains(self.gains, scenario.gains)
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

    @property
    def motion_reach(self) -> np.ndarray:
        """How far the present motion moves each joint (na,), rad; zeros without one."""
        return np.zeros(self.robot.na) if self._motion is None else self._motion.reach.sum(axis=0)

    def angular_momentum_asked(self, time: float) -> np.ndarray:
        """k_d of the present motion at a time of the run, s (3,), N m s; zeros without one."""
        since = max(0.0, time - self._motion_start)
        return np.zeros(3) if self._motion is None else self._motion.angular_momentum(since)

    def post(self, event: SessionEvent) -> None:
        """Put an event into the inbox; it takes effect at the start of the next tick.

        Raises:
            InputError: the event asks for something that does not exist or is out of range.
        """
        self._check(event)
        self._inbox.append(event)

    def check(self, events: Iterable[SessionEvent]) -> None:
        """Refuse events that could not be done one after the other; none of them is done.

        Raises:
            InputError: one asks for something that does not exist or is out of range.
        """
        waiting = tuple(self._inbox)
        try:
            for event in events:
                self.post(event)
        finally:
            self._inbox = deque(waiting)

    def tick(self) -> Sample:
        """One step of control and physics.

        Raises:
            SimulationError: the state is not finite any more; the recording holds everything before.
        """
        self._drain_inbox()
        dynamics = self.dynamics
        plates = self._ground.at(self.time)
        output = self._control(self._believed(dynamics), plates)
        torque, self._line = delayed(self._line, output.torque, self._ticks_late)
        step = self._simulator.step(dynamics, torque, self._pushed.all, self.time)
        self.fall = self.fall or self._fall(dynamics, step, plates)
        sample = self._record(dynamics, output, step, plates)
        self._advance(output, step)
        return sample

    def snapshot(self) -> Snapshot:
        """Where the session is, between two ticks."""
        return Snapshot(self.ticks, {name: getattr(self, name) for name in Session.__annotations__})

    def resume(self, snapshot: Snapshot) -> None:
        """Go back to where the session was; what has been recorded, logged and posted since is forgotten."""
        # The snapshot may be another session's, and ahead of this one.
        self.recording.forget_last(max(0, self._tick_of_run - snapshot.changing["_tick_of_run"]))
        for name, value in snapshot.changing.items():
            setattr(self, name, value)
        self.ticks = snapshot.ticks
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
        if self.mismatch == EXACT:
            return dynamics
        seed, tick = self.scenario.seed, self._tick_of_run
        return self.robot.at(measured(self.robot, dynamics.state, self.mismatch, seed, tick))

    def _control(self, dynamics: Dynamics, plates: FootGround) -> ControlOutput:
        """The controller's answer; a robot that has fallen goes limp."""
        if self.fall is not None:
            return limp(self.robot, dynamics, self._memory)
        self._known = self._sensed(dynamics, plates)
        reference = self._goal.reference(dynamics, self._known, self.controlled, self.planner)
        if self._motion is not None:
            reference = self._motion.applied(reference, self.time - self._motion_start)
        output = self._controller.compute(dynamics, reference, self.gains, self.priority, self._memory)
        if output.failure is not None:
            self.solver_failures += 1
            self.last_failure = output.failure
        torque = self._without_jump(output.torque)
        return output if torque is output.torque else replace(output, torque=torque)

    def _sensed(self, dynamics: Dynamics, plates: FootGround) -> FootGround:
        """The ground as the robot takes it to be: as it is told, or as its soles feel it."""
        if self.ground_sense == "told":
            return plates
        return felt_ground(dynamics, self._foot_wrench[:, 2] > _FELT * self._weight, self._known)

    def _move(self, name: str, angular_goal: AngularGoal, start: float) -> None:
        """Let a motion begin at a time of the run, s, or end it; what the torque jumps by is faded."""
        self.motion, self.angular_goal, self._motion_start = name, angular_goal, start
        self._taken_over = True
        self._motion = None
        if name:
            self._motion = MovingGoal(
                self.robot, self._home, self.stance, name, angular_goal, self.scenario.timestep
            )

    def _without_jump(self, torque: np.ndarray) -> np.ndarray:
        """The controller's torque; after a takeover it starts from the torque that was applied before."""
        if self._taken_over and self._torque is not None:
            self._handover = Handover.between(self._torque, torque)
        elif self._handover is not None:
            self._handover = self._handover.later(self.scenario.timestep)
        self._taken_over = False
        return torque if self._handover is None else self._handover.applied(torque)

    def _record(self, dynamics: Dynamics, output: ControlOutput, step: Step, plates: FootGround) -> Sample:
        tick = Tick(
            self._real,
            self.time,
            self.scenario.timestep,
            dynamics,
            output,
            step,
            plates,
            self.priority,
            self.fall is not None,
        )
        observe(self.recording.next_row(), tick)
        return self.recording.latest

    def _advance(self, output: ControlOutput, step: Step) -> None:
        self._memory = output.memory
        self._torque = step.torque
        self._foot_wrench = step.foot_wrench
        self.state = step.state
        self.ticks += 1
        self._tick_of_run += 1
        if not step.state.is_finite():
            raise SimulationError(f"the state is not finite after {self.time:.3f} s; the recording is kept")

    def _fall(self, dynamics: Dynamics, step: Step, plates: FootGround) -> Fall | None:
        """When and why the robot has fallen; None while it stands."""
        if any(step.other_wrench.tolist()):
            return Fall(self.time, "something other than a sole touched the ground")
        height = dynamics.com_in_world[2] - plates.height
        if height < _FALLEN_HEIGHT * self._standing_height:
            return Fall(self.time, f"the CoM sank to {height:.2f} m")
        return None

    def _check(self, event: SessionEvent) -> None:
        """Refuse what cannot be done, before it is in the inbox."""
        match event:
            case SetGain(name, value):
                with_gains(controller_entry(self._controller_to_be()).gains, {name: value})
            case SetGains(values):
                with_gains(controller_entry(self._controller_to_be()).gains, values)
            case SetPriority(value):
                _checked_priority(value)
            case SetDirections(text):
                directions(text)
            case SelectPlanner(name):
                check_planner(name, self._controller_to_be())
            case SetMotion(name) if name:
                reach_of(self.robot, name)
            case SetFriction(value, foot):
                self._feet_named(foot)
                checked_friction(value)
            case MoveGround(motion, foot):
                ground = self._ground.moving_too(self._feet_named(foot), motion)
                check_ground(self.scenario.engine, ground)
            case SetGroundSense(sense):
                ground_sense(sense)
            case SetMismatch(name, value):
                check_mismatch(self.scenario.engine, with_error(self.mismatch, name, value))
            case SelectController(name):
                controller_entry(name)
            case ApplyPush(push) | HoldPush(push):
                self._checked_push(push)
            case ApplyPushes(pushes):
                for push in pushes:
                    self._checked_push(push)

    def _controller_to_be(self) -> str:
        """The controller after everything in the inbox has been done."""
        selected = [event.name for event in self._inbox if isinstance(event, SelectController)]
        return selected[-1] if selected else self.controller

    def _apply(self, event: SessionEvent) -> None:
        match event:
            case SetGain(name, value):
                self.gains = with_gains(self.gains, {name: value})
            case SetGains(values):
                self.gains = with_gains(self.gains, values)
            case SetPriority(value):
                self.priority = _checked_priority(value)
            case SetDirections(text):
                self.controlled = directions(text)
                self._taken_over = True
            case SelectPlanner(name):
                self.planner = name
                self._taken_over = True
            case SelectController(name):
                self._select(name)
                self._memory = self._controller.initial_memory(self._believed(self.dynamics))
                self._taken_over = True
            case SetMotion(name):
                self._move(name, self.angular_goal, self.time)
            case SetAngularGoal(goal):
                self._move(self.motion, goal, self._motion_start)
            case SetFriction(value, foot):
                self._change(self._ground.as_slippery_as(value, self._feet_named(foot), self.time))
            case MoveGround(motion, foot):
                begun = msgspec.structs.replace(motion, start=self.time, stop=None)
                self._change(self._ground.moving_too(self._feet_named(foot), begun))
            case StopGround():
                self._change(self._ground.coming_to_rest(self.time))
            case SetGroundSense(sense):
                self.ground_sense = ground_sense(sense)
                self._taken_over = True
            case SetMismatch(name, value):
                self.mismatch = with_error(self.mismatch, name, value)
                self._build()
            case ApplyPush(push):
                self._push(msgspec.structs.replace(push, start=0.0))
            case ApplyPushes(pushes):
                for push in pushes:
                    self._push(push)
            case HoldPush(push):
                self._pushed = self._pushed.held_from(self.time, self._checked_push(push))
            case LetGo():
                self._pushed = self._pushed.let_go(self.time)
            case Reset():
                self._scripted = ()
                self._stand_up()

    def _push(self, push: Push) -> None:
        """Let a push begin so long after now as its start says."""
        sized = self._checked_push(push)
        self._pushed = self._pushed.with_push(
            msgspec.structs.replace(sized, start=self.time + sized.start)
        )

    def _feet_named(self, name: str) -> tuple[int, ...]:
        """The feet of that name; all for an empty one."""
        if name and name not in self.robot.foot_names:
            raise InputError("foot", name, f"one of {', '.join(self.robot.foot_names)}")
        return tuple(i for i, foot in enumerate(self.robot.foot_names) if name in ("", foot))

    def _change(self, ground: Ground) -> None:
        """Stand on another ground from now on."""
        self._ground = ground
        self._build()

    def _build(self) -> None:
        """The robot that is simulated and its world, out of what is the case."""
        self._real = real_robot(self.robot, self.mismatch)
        self._ticks_late = ticks_late(self.mismatch.torque_delay_ms, self.scenario.timestep)
        self._simulator = world(self.scenario.engine, self._real, self._ground, self.scenario.timestep)

    def _select(self, name: str) -> None:
        entry = controller_entry(name)
        self.controller = name
        self.gains = entry.gains
        if self.planner not in entry.planners:
            self.planner = OWN
        self._controller = entry.make(self.robot, self.scenario.timestep)

    def _stand_up(self) -> None:
        """The robot where it started, the clock at zero."""
        self.state = self._start
        self._pushed = Pushed(self._scripted)
        self.fall = None
        self.solver_failures = 0
        self.last_failure = None
        self._tick_of_run, self._motion_start = 0, 0.0
        self._ground = self._first_ground
        self._known = self._ground.at(0.0)
        self._foot_wrench = np.zeros((len(self.robot.soles), 6))
        self._line = ()
        self._build()
        self._memory = self._controller.initial_memory(self._believed(self.dynamics))
        self._torque = self._handover = None
        self._taken_over = False
        self.recording.clear()

    def _checked_push(self, push: Push) -> Push:
        """The push with its force, if the robot has the body it names."""
        pushed_frame(self.robot, push)
        return push.sized_for(self.robot.mass)


def _checked_priority(value: float) -> float:
    if not math.isfinite(value) or not 0.0 <= value <= 1.0:
        raise InputError(
            "priority", value, "a number from 0 (keep linear momentum) to 1 (keep angular momentum)"
        )
    return float(value)
