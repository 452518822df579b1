"""The tick of a session taken apart, with a watch between its parts."""

from __future__ import annotations

from time import perf_counter

import numpy as np

from momentum_lab.control.registry import controller_entry
from momentum_lab.control.standing import StandingGoal
from momentum_lab.observe import Tick, observe
from momentum_lab.physics.ground import Ground
from momentum_lab.physics.push import Push
from momentum_lab.physics.simulator import Simulator
from momentum_lab.recording import Layout, Recording
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.posture import standing_posture
from momentum_lab.robot.state import State
from momentum_lab.scenario import Scenario

STAGES = ("state_terms", "controller", "physics", "recording")
_KEPT = 1000


class StagedTick:
    """What a session does in a tick, standing on both feet, stage by stage.

    Args:
        robot: the robot.
        scenario: controller and timestep; the controller keeps its default gains.
    """

    def __init__(self, robot: RobotModel, scenario: Scenario) -> None:
        self.robot = robot
        self.timestep = scenario.timestep
        self.pushes: tuple[Push, ...] = ()
        self.state = State(standing_posture(robot), np.zeros(robot.nv))
        home = robot.at(self.state)
        feet = len(robot.soles)
        entry = controller_entry(scenario.controller)
        self._goal = StandingGoal(robot, home, tuple(range(feet)))
        self._controller = entry.make(robot, self.timestep)
        self._gains = entry.gains
        self._memory = self._controller.initial_memory(home)
        self._ground = Ground.level(feet, robot.spec.friction)
        self._simulator = Simulator(robot, self._ground, self.timestep)
        self._recording = Recording(Layout.of(robot), _KEPT)
        self._ticks = 0

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return self._ticks * self.timestep

    def tick(self) -> tuple[float, ...]:
        """One tick; how long each of `STAGES` took, s."""
        start = perf_counter()
        dynamics = self.robot.at(self.state)
        computed = perf_counter()
        plates = self._ground.at(self.time)
        reference = self._goal.reference(dynamics, plates)
        output = self._controller.compute(dynamics, reference, self._gains, 0.0, self._memory)
        decided = perf_counter()
        step = self._simulator.step(dynamics, output.torque, self.pushes, self.time)
        moved = perf_counter()
        tick = Tick(self.robot, self.time, self.timestep, dynamics, output, step, plates, 0.0, False)
        observe(self._recording.next_row(), tick)
        recorded = perf_counter()
        self._memory, self.state = output.memory, step.state
        self._ticks += 1
        return computed - start, decided - computed, moved - decided, recorded - moved
