"""Who steers: from the state as it is believed and the ground as it is known to torques for the motors.

Everything that stands between the two is here: the goal and the motion on top of it, the controller with its
memory, what the soles feel, and the fading of a torque's jump when one law takes over from another. Of the world
it knows what a robot's sensors tell; pushes, model errors and contacts are the session's.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from momentum_lab.choices import Choices
from momentum_lab.control.controller import Controller, ControlOutput
from momentum_lab.control.fallback import limp
from momentum_lab.control.ground_sense import felt_ground
from momentum_lab.control.handover import Handover
from momentum_lab.control.motion import MovingGoal
from momentum_lab.control.registry import controller_entry
from momentum_lab.control.standing import StandingGoal
from momentum_lab.momentum.foot_ground import FootGround
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics

# The force sensor of a foot feels the ground from this part of the weight on.
_FELT = 0.02


class Steering:
    """Goal, motion, controller and handover of one robot.

    Args:
        robot: as the controller believes it to be.
        home: the robot standing, which is the goal.
        stance: the feet it stands on, as indices.
        timestep: of a tick, s.
        choices: what is chosen before the run.
    """

    # What changes while the session runs, and a snapshot holds.
    _controller: Controller
    _memory: Any
    _motion: MovingGoal | None
    _motion_start: float
    _known: FootGround
    _foot_wrench: np.ndarray
    _torque: np.ndarray | None
    _taken_over: bool
    _handover: Handover | None

    def __init__(
        self,
        robot: RobotModel,
        home: Dynamics,
        stance: tuple[int, ...],
        timestep: float,
        choices: Choices,
    ) -> None:
        self._robot = robot
        self._home = home
        self._stance = stance
        self._timestep = timestep
        self._weight = robot.mass * GRAVITY
        self._goal = StandingGoal(robot, home, stance)
        self.move(choices, 0.0)
        self._make(choices)

    def stand_up(self, dynamics: Dynamics, plates: FootGround) -> None:
        """Begin anew, with the chosen controller and motion: the clock is at zero."""
        self._motion_start = 0.0
        self._known = plates
        self._foot_wrench = np.zeros((len(self._robot.soles), 6))
        self._memory = self._controller.initial_memory(dynamics)
        self._torque = self._handover = None
        self._taken_over = False

    def output(self, dynamics: Dynamics, plates: FootGround, choices: Choices, time: float) -> ControlOutput:
        """The controller's answer in a tick, its torque without a jump.

        Args:
            dynamics: the state as it is believed.
            plates: the ground that a robot is told of; what its soles feel may take its place.
            choices: who controls, with which gains and goals.
            time: of the run, s.
        """
        self._known = self._sensed(dynamics, plates, choices)
        reference = self._goal.reference(dynamics, self._known, choices.controlled, choices.planner)
        if self._motion is not None:
            reference = self._motion.applied(reference, time - self._motion_start)
        output = self._controller.compute(dynamics, reference, choices.gains, choices.priority, self._memory)
        torque = self._without_jump(output.torque)
        return output if torque is output.torque else replace(output, torque=torque)

    def limp(self, dynamics: Dynamics) -> ControlOutput:
        """The answer for a robot that has fallen."""
        return limp(self._robot, dynamics, self._memory)

    def remember(self, memory: Any, torque: np.ndarray, foot_wrench: np.ndarray) -> None:
        """What a tick leaves behind: the controller's memory, torques (na,), N m, wrenches of the feet (F, 6)."""
        self._memory, self._torque, self._foot_wrench = memory, torque, foot_wrench

    def take_over(self) -> None:
        """From the next tick on the answer is another one; what the torque jumps by is faded."""
        self._taken_over = True

    def select(self, choices: Choices, dynamics: Dynamics) -> None:
        """Let the chosen controller take over."""
        self._make(choices)
        self._memory = self._controller.initial_memory(dynamics)
        self.take_over()

    def move(self, choices: Choices, start: float) -> None:
        """Let the chosen motion begin at a time of the run, s, or end it."""
        self._motion, self._motion_start = None, start
        if choices.motion:
            place, goal = (self._robot, self._home, self._stance), choices.angular_goal
            self._motion = MovingGoal(*place, choices.motion, goal, self._timestep)
        self.take_over()

    def aim(self, choices: Choices) -> None:
        """Let the motion that is under way have the chosen angular goal."""
        self.move(choices, self._motion_start)

    @property
    def motion_reach(self) -> np.ndarray:
        """How far the present motion moves each joint (na,), rad; zeros without one."""
        return np.zeros(self._robot.na) if self._motion is None else self._motion.reach.sum(axis=0)

    def angular_momentum_asked(self, time: float) -> np.ndarray:
        """k_d of the present motion at a time of the run, s (3,), N m s; zeros without one."""
        since = max(0.0, time - self._motion_start)
        return np.zeros(3) if self._motion is None else self._motion.angular_momentum(since)

    def _make(self, choices: Choices) -> None:
        self._controller = controller_entry(choices.controller).make(self._robot, self._timestep)

    def _sensed(self, dynamics: Dynamics, plates: FootGround, choices: Choices) -> FootGround:
        """The ground as the robot takes it to be: as it is told, or as its soles feel it."""
        if choices.ground_sense == "told":
            return plates
        return felt_ground(dynamics, self._foot_wrench[:, 2] > _FELT * self._weight, self._known)

    def _without_jump(self, torque: np.ndarray) -> np.ndarray:
        """The controller's torque; after a takeover it starts from the torque that was applied before."""
        if self._taken_over and self._torque is not None:
            self._handover = Handover.between(self._torque, torque)
        elif self._handover is not None:
            self._handover = self._handover.later(self._timestep)
        self._taken_over = False
        return torque if self._handover is None else self._handover.applied(torque)
