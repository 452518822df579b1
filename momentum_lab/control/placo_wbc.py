"""PlaCo's whole-body controller in the loop: what a user would pick instead, for comparison."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from momentum_lab.control import common_gains
from momentum_lab.control.controller import ControlOutput, Reference
from momentum_lab.control.desired import desired_linear_rate
from momentum_lab.control.fallback import NO_FOOT, hold_posture, in_words, without_ground
from momentum_lab.control.footing import Footing
from momentum_lab.control.gains import gain
from momentum_lab.control.placo_tasks import Law, PlacoTasks, TaskLaws
from momentum_lab.errors import SolverError
from momentum_lab.momentum.ground import cop_from_momentum_rate, momentum_rate_from_wrenches
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics


@dataclass(frozen=True, slots=True)
class PlacoWbcGains:
    """Gains of PlaCo's tasks and contacts."""

    com_stiffness: float = gain(
        16.0, "1/s^2", 0.0, 200.0, "How strongly the CoM is pulled back over the feet."
    )
    com_damping: float = gain(8.0, "1/s", 0.0, 60.0, "How strongly the velocity of the CoM is braked.")
    pelvis_stiffness: float = gain(100.0, "1/s^2", 0.0, 400.0, "How strongly the pelvis is turned upright.")
    pelvis_damping: float = gain(20.0, "1/s", 0.0, 60.0, "How strongly turning of the pelvis is braked.")
    posture_stiffness: float = gain(
        100.0, "1/s^2", 0.0, 400.0, "How strongly all joints are pulled to their posture."
    )
    posture_damping: float = gain(20.0, "1/s", 0.0, 60.0, "How strongly the motion of all joints is braked.")
    contact_damping: float = common_gains.contact_damping()
    safe_border: float = common_gains.safe_border()
    friction: float = common_gains.friction()


class PlacoWbc:
    """Soft tasks on CoM, pelvis and posture over planar contacts, solved by PlaCo in one program.

    Angular momentum is no task of PlaCo's: an upright pelvis and a quiet posture stand in for it.

    Args:
        robot: the robot.
        timestep: time between two calls, s.
    """

    def __init__(self, robot: RobotModel, timestep: float) -> None:
        self.robot = robot
        self.timestep = timestep
        self.footing = Footing(robot)
        self._tasks: dict[tuple[int, ...], PlacoTasks] = {}

    def initial_memory(self, dynamics: Dynamics) -> None:
        """Nothing: every tick is answered on its own."""

    def compute(
        self,
        dynamics: Dynamics,
        reference: Reference,
        gains: PlacoWbcGains,
        priority: float,
        memory: None,
    ) -> ControlOutput:
        """Torques for one tick; see `Controller.compute`.

        Priority weighs the CoM against the pelvis: 0 is 100 to 1, 1 is 1 to 100. Of the desired momentum rate
        the linear part is the CoM task's, the angular part the one that comes of it.
        """
        carrying = self.footing.on_the_ground(dynamics, reference.stance, reference.ground)
        linear = desired_linear_rate(
            self.robot.mass, dynamics, reference, gains.com_damping, gains.com_stiffness
        )
        if not carrying:
            return self._fallback(dynamics, reference, linear, NO_FOOT)
        if carrying not in self._tasks:
            self._tasks[carrying] = PlacoTasks(self.robot, carrying, self.timestep)
        try:
            answer = self._tasks[carrying].solve(dynamics, reference, _laws(gains), priority)
        except SolverError as error:
            return self._fallback(dynamics, reference, linear, str(error))
        com, mass = dynamics.com_in_world, self.robot.mass
        admissible = momentum_rate_from_wrenches(answer.wrench, dynamics.sole_position, com, mass)
        desired = np.concatenate([linear, admissible[3:]])
        height = float(dynamics.sole_position[list(carrying), 2].mean())
        return ControlOutput(
            torque=answer.torque,
            acceleration=answer.acceleration,
            momentum_rate_desired=desired,
            momentum_rate_admissible=admissible,
            foot_wrench_admissible=answer.wrench,
            cop_desired=cop_from_momentum_rate(desired, com, mass, height),
            cop_admissible=cop_from_momentum_rate(admissible, com, mass, height),
            failure=None,
            memory=None,
        )

    def _fallback(
        self, dynamics: Dynamics, reference: Reference, linear: np.ndarray, reason: str
    ) -> ControlOutput:
        """The posture held by joint springs, and why; nothing is asked of the ground."""
        return replace(
            without_ground(self.robot, dynamics, None),
            torque=hold_posture(self.robot, dynamics, reference),
            momentum_rate_desired=np.concatenate([linear, np.zeros(3)]),
            failure=in_words(reference, reason),
        )


def _laws(gains: PlacoWbcGains) -> TaskLaws:
    return TaskLaws(
        com=Law(gains.com_stiffness, gains.com_damping),
        pelvis=Law(gains.pelvis_stiffness, gains.pelvis_damping),
        posture=Law(gains.posture_stiffness, gains.posture_damping),
        contact_rate=gains.contact_damping,
        safe_border=gains.safe_border,
        friction=gains.friction,
    )
