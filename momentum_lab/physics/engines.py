"""The physics that may answer, by name."""

from __future__ import annotations

from typing import Literal, Protocol

import numpy as np

from momentum_lab.errors import InputError
from momentum_lab.physics.ground import Ground
from momentum_lab.physics.mismatch import Mismatch
from momentum_lab.physics.mujoco_engine import MujocoSimulator, check_level
from momentum_lab.physics.push import Push
from momentum_lab.physics.simulator import Simulator, Step
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics

Engine = Literal["pinocchio", "mujoco"]


class World(Protocol):
    """One robot and its ground, in some engine."""

    def step(self, dynamics: Dynamics, torque: np.ndarray, pushes: tuple[Push, ...], time: float) -> Step:
        """The step from `dynamics.state` at `time` (s) under joint torques (na,) and the pushes of the run."""


def world(engine: Engine, robot: RobotModel, ground: Ground, timestep: float) -> World:
    """A world in an engine.

    Args:
        engine: whose physics.
        robot: who lives in it.
        ground: what it stands on.
        timestep: length of a step, s.

    Raises:
        InputError: the engine is not installed, or does not know this robot or ground.
    """
    if engine == "pinocchio":
        return Simulator(robot, ground, timestep)
    return MujocoSimulator(robot, ground, timestep)


def check_ground(engine: Engine, ground: Ground) -> None:
    """Refuse ground that an engine does not know.

    Raises:
        InputError: the engine is MuJoCo, and the ground is not a level floor at rest.
    """
    if engine == "mujoco":
        check_level(ground)


def check_mismatch(engine: Engine, mismatch: Mismatch) -> None:
    """Refuse what an engine cannot make of a robot.

    Raises:
        InputError: the engine is MuJoCo, and the joints have friction.
    """
    if engine == "mujoco" and mismatch.joint_friction:
        raise InputError("mismatch joint_friction", mismatch.joint_friction, "0 with the engine mujoco")
