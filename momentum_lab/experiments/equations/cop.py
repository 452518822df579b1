"""Eqs. 48 to 51: the CoP from the accelerations of all links (section 5.2)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from momentum_lab.experiments.equations.equation import Equation
from momentum_lab.experiments.equations.scenes import Scene, flying, worst
from momentum_lab.momentum.centroidal import momentum_rate
from momentum_lab.momentum.ground import cop_from_momentum_rate
from momentum_lab.momentum.segment_cop import Edges, link_moments, rectangle_edges, segment_cop
from momentum_lab.momentum.segments import Segments, segments
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import State


@dataclass(frozen=True, slots=True)
class Case:
    """A robot in motion above a rectangle on the ground.

    Attributes:
        scene: its state and acceleration.
        links: all links with mass.
        rate: [dl/dt; dk/dt] of the motion (6,), N and N m (Eq. 20).
        edges: of the rectangle.
        ground: its height, m.
    """

    scene: Scene
    links: Segments
    rate: np.ndarray
    edges: Edges
    ground: float

    @property
    def normal_force(self) -> float:
        """The force f_z that the motion needs, N."""
        return float(self.rate[2] + self.scene.weight)


def case_of(robot: RobotModel, seed: int) -> Case:
    """A robot in flight and a ground half a metre to a metre below its CoM."""
    scene = flying(robot, seed)
    com = scene.dynamics.com_in_world
    lower, upper = com[:2] - scene.rng.uniform(0.05, 0.1, 2), com[:2] + scene.rng.uniform(0.05, 0.1, 2)
    ground = float(com[2] - scene.rng.uniform(0.5, 1.0))
    rate = momentum_rate(scene.dynamics, scene.acceleration)
    return Case(scene, segments(robot, scene.state), rate, rectangle_edges(lower, upper), ground)


def _cop_difference(robot: RobotModel, seed: int) -> np.ndarray:
    """The CoP of all links against that of the momentum rate (Eq. 21) (2,), m."""
    case = case_of(robot, seed)
    found = segment_cop(case.links, case.links.stacked_acceleration(case.scene.acceleration), case.ground)
    com = case.scene.dynamics.com_in_world
    return found - cop_from_momentum_rate(case.rate, com, robot.mass, case.ground)


def _forward(robot: RobotModel, seed: int) -> float:
    return worst(_cop_difference(robot, seed)[0])


def _sideways(robot: RobotModel, seed: int) -> float:
    return worst(_cop_difference(robot, seed)[1])


def _moment_difference(robot: RobotModel, seed: int) -> np.ndarray:
    """Moments of the links against central differences of their spins I_i omega_i (N, 3), N m."""
    case = case_of(robot, seed)

    def spins(state: State) -> np.ndarray:
        moved = segments(robot, state)
        return np.einsum("nij,nj->ni", moved.inertia, moved.spin)

    angular = case.links.stacked_acceleration(case.scene.acceleration).reshape(6, -1)[3:].T
    return link_moments(case.links, angular) - case.scene.rate(spins)


def _rolling_moments(robot: RobotModel, seed: int) -> float:
    return worst(_moment_difference(robot, seed)[:, 0])


def _pitching_moments(robot: RobotModel, seed: int) -> float:
    return worst(_moment_difference(robot, seed)[:, 1])


_COP, _MOMENTS = "momentum.segment_cop.segment_cop", "momentum.segment_cop.link_moments"
_TEST = "tests/momentum/test_segment_cop.py::test_"
_SUMS = f"{_TEST}cop_of_the_links_is_that_of_the_momentum_rate"
_SPINS = f"{_TEST}moments_of_the_links_change_their_spins"
_AXES = "z up here, y up in Eq. 21 that it expands; tau_i is about each link's CoM, not about G"
_GYRO = "the gyroscopic moment omega x I omega is missing, and I is the full inertia in world axes"

EQUATIONS = (
    Equation(
        48,
        "p_x = (sum m r_x (r_z'' + g) - sum m r_z r_x'' - sum tau_y) / sum m (r_z'' + g)",
        _COP,
        _SUMS,
        _forward,
        1e-8,
        "m",
        _AXES,
    ),
    Equation(
        49,
        "p_y = (sum m r_y (r_z'' + g) - sum m r_z r_y'' + sum tau_x) / sum m (r_z'' + g)",
        _COP,
        _SUMS,
        _sideways,
        1e-8,
        "m",
        _AXES,
    ),
    Equation(
        50, "tau_xi = (I_i w_i' + w_i x I_i w_i)_x", _MOMENTS, _SPINS, _rolling_moments, 1e-5, "N m", _GYRO
    ),
    Equation(
        51, "tau_yi = (I_i w_i' + w_i x I_i w_i)_y", _MOMENTS, _SPINS, _pitching_moments, 1e-5, "N m", _GYRO
    ),
)
