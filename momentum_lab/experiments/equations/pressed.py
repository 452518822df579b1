"""A robot that is pressed against the ground, and the motion that follows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from momentum_lab.experiments.equations.scenes import Scene, flying
from momentum_lab.robot.model import RobotModel

_POINTS = 4


@dataclass(frozen=True, slots=True)
class Pressed:
    """A robot whose soles are pressed at some points of a ground plane, and the motion that follows.

    Attributes:
        scene: its state.
        rate: Pinocchio's [dl/dt; dk/dt] of that motion (6,), N and N m.
        wrenches: on the soles, about their origins (2, 6), N and N m.
        force: sum of all forces (3,), N.
        cop: mean of the points, weighted with their normal forces (3,), m.
    """

    scene: Scene
    rate: np.ndarray
    wrenches: np.ndarray
    force: np.ndarray
    cop: np.ndarray


def pressed(robot: RobotModel, seed: int) -> Pressed:
    """Forces from below at random points of a plane, through the soles, and some torques of the joints."""
    scene = flying(robot, seed)
    dynamics, rng = scene.dynamics, scene.rng
    ground = dynamics.com_in_world + np.array([0.0, 0.0, -rng.uniform(0.5, 1.0)])
    points = ground + rng.normal(scale=0.1, size=(2, _POINTS, 3)) * [1.0, 1.0, 0.0]
    forces = rng.uniform([-0.2, -0.2, 0.2], [0.2, 0.2, 1.0], (2, _POINTS, 3)) * scene.weight / _POINTS
    moments = np.cross(points - dynamics.sole_position[:, None], forces)
    wrenches = np.concatenate((forces.sum(1), moments.sum(1)), axis=1)
    effort = np.concatenate((np.zeros(6), robot.effort_limit * rng.uniform(-0.3, 0.3, robot.na)))
    effort += np.einsum("fi,fij->j", wrenches, dynamics.sole_jacobian) - dynamics.nonlinear_effects
    acceleration = np.linalg.solve(dynamics.mass_matrix, effort)
    data = robot.model.createData()
    state = scene.state
    rate = pin.computeCentroidalMomentumTimeVariation(robot.model, data, state.q, state.v, acceleration)
    normal = forces[..., 2]
    cop = np.einsum("fp,fpi->i", normal, points) / normal.sum()
    return Pressed(scene, rate.vector, wrenches, forces.sum((0, 1)), cop)
