"""States in which equations are measured: in flight and standing, drawn from a seed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import pinocchio as pin

from momentum_lab.control.controller import Reference
from momentum_lab.control.standing import StandingGoal
from momentum_lab.momentum.foot_ground import FootGround
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.momentum.resolved import null_space
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.posture import standing_posture
from momentum_lab.robot.state import Dynamics, State

STEP = 1e-5
"""Half the step of central differences, s: rounding and curvature cost about the same."""


@dataclass(frozen=True, slots=True)
class Scene:
    """A robot in motion.

    Attributes:
        robot: the robot.
        dynamics: everything computed.
        acceleration: some generalized acceleration (nv,).
        rng: for whatever else is to be drawn.
    """

    robot: RobotModel
    dynamics: Dynamics
    acceleration: np.ndarray
    rng: np.random.Generator

    @property
    def state(self) -> State:
        """Configuration and velocity."""
        return self.dynamics.state

    @property
    def weight(self) -> float:
        """The weight m g, N."""
        return self.robot.mass * GRAVITY

    def draw(self, count: int) -> np.ndarray:
        """Random numbers (count,) of the size of 1."""
        return np.asarray(self.rng.normal(size=count))

    def after(self, time: float) -> State:
        """The state a short time later under the constant acceleration."""
        v, a = self.state.v, self.acceleration
        return State(self.robot.integrate(self.state.q, time * (v + 0.5 * time * a)), v + time * a)

    def rate(self, quantity: Callable[[State], np.ndarray]) -> np.ndarray:
        """d/dt of a quantity along the motion, by central differences."""
        return (quantity(self.after(STEP)) - quantity(self.after(-STEP))) / (2.0 * STEP)

    def kinematics(self) -> pin.Data:
        """Pinocchio's own kinematics of position, velocity and the acceleration."""
        data = self.robot.model.createData()
        pin.forwardKinematics(self.robot.model, data, self.state.q, self.state.v, self.acceleration)
        pin.updateFramePlacements(self.robot.model, data)
        return data


def flying(robot: RobotModel, seed: int) -> Scene:
    """Any posture within the joint limits, any orientation, base within 1 m, speeds around 1."""
    rng = np.random.default_rng(seed)
    turn = rng.normal(size=4)
    joints = rng.uniform(robot.position_lower, robot.position_upper)
    q = np.concatenate((rng.uniform(-1.0, 1.0, 3), turn / np.linalg.norm(turn), joints))
    dynamics = robot.at(State(q, rng.normal(size=robot.nv)))
    return Scene(robot, dynamics, rng.normal(size=robot.nv), rng)


def standing(robot: RobotModel, seed: int, stance: tuple[int, ...] = (0, 1), speed: float = 0.1) -> Scene:
    """Near the home posture, moving at random with the stance feet still; speed in m/s and rad/s."""
    rng = np.random.default_rng(seed)
    home = at_home(robot, stance)
    free = _motions(home, stance)
    q = robot.integrate(home.state.q, free @ rng.normal(scale=0.01, size=free.shape[1]))
    free = _motions(robot.at(State(q, np.zeros(robot.nv))), stance)
    dynamics = robot.at(State(q, free @ rng.normal(scale=speed, size=free.shape[1])))
    return Scene(robot, dynamics, rng.normal(size=robot.nv), rng)


def standing_goal(scene: Scene, stance: tuple[int, ...] = (0, 1)) -> Reference:
    """Standing in the home posture of a stance."""
    goal = StandingGoal(scene.robot, at_home(scene.robot, stance), stance)
    return goal.reference(scene.dynamics, FootGround.level(len(scene.robot.soles)))


@lru_cache(maxsize=4)
def at_home(robot: RobotModel, stance: tuple[int, ...]) -> Dynamics:
    """The standing posture at rest."""
    q = standing_posture(robot, [robot.foot_names[foot] for foot in stance])
    return robot.at(State(q, np.zeros(robot.nv)))


def inverse_dynamics_by_recursion(
    scene: Scene, acceleration: np.ndarray, wrenches: np.ndarray, feet: Sequence[int] = (0, 1)
) -> np.ndarray:
    """Generalized forces (nv,) of Pinocchio's recursion, with wrenches on the soles as external forces."""
    model, data = scene.robot.model, scene.kinematics()
    external = pin.StdVec_Force()
    external.extend([pin.Force.Zero() for _ in range(model.njoints)])
    for foot, wrench in zip(feet, wrenches, strict=True):
        joint = model.frames[scene.robot.soles[foot].frame].parentJoint
        sole = pin.SE3(np.eye(3), scene.dynamics.sole_position[foot])
        external[joint] += data.oMi[joint].actInv(sole.act(pin.Force(wrench)))
    return pin.rnea(model, data, scene.state.q, scene.state.v, acceleration, external)


def worst(*differences: np.ndarray | float) -> float:
    """The largest entry of some differences."""
    return max(float(np.abs(difference).max()) for difference in differences)


def _motions(dynamics: Dynamics, stance: tuple[int, ...]) -> np.ndarray:
    """Velocities that leave the stance soles where they are, one per column (nv, n)."""
    jacobian = dynamics.sole_jacobian[list(stance)]
    return null_space(jacobian.reshape(-1, jacobian.shape[-1]))
