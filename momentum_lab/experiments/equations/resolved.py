"""Eqs. 24 to 26: joint rates that resolve a momentum (section 4.1)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from momentum_lab.experiments.equations.equation import Equation
from momentum_lab.experiments.equations.scenes import standing, worst
from momentum_lab.momentum.resolved import resolved_rates
from momentum_lab.robot.model import RobotModel


@dataclass(frozen=True, slots=True)
class _Question:
    """Feet, momentum and reference for joint rates, and the answer (nv,)."""

    feet: np.ndarray
    feet_velocity: np.ndarray
    centroidal_map: np.ndarray
    momentum: np.ndarray
    reference: np.ndarray
    rates: np.ndarray


def _question(robot: RobotModel, seed: int, reachable: bool = True) -> _Question:
    scene = standing(robot, seed)
    rng, centroidal_map = scene.rng, scene.dynamics.centroidal_map
    feet = scene.dynamics.sole_jacobian.reshape(-1, robot.nv)
    velocity, momentum = 0.1 * rng.normal(size=len(feet)), 0.1 * robot.mass * rng.normal(size=6)
    reference = rng.normal(size=robot.nv)
    if not reachable:
        # Two equal rows that are asked for two different momenta cannot both be obeyed.
        centroidal_map = centroidal_map.copy()
        centroidal_map[4] = centroidal_map[0]
    rates = resolved_rates(feet, velocity, centroidal_map, momentum, reference)
    return _Question(feet, velocity, centroidal_map, momentum, reference, rates)


def _feet(robot: RobotModel, seed: int) -> float:
    """Velocity of the feet that the rates give against the one asked for."""
    asked = _question(robot, seed)
    return worst(asked.feet @ asked.rates - asked.feet_velocity)


def _least_squares(robot: RobotModel, seed: int) -> float:
    """Two rows that contradict each other: the miss against the system of Eq. 25's optimality conditions."""
    asked = _question(robot, seed, reachable=False)
    size, count = robot.nv, len(asked.feet)
    system = np.zeros((size + count, size + count))
    system[:size, :size] = asked.centroidal_map.T @ asked.centroidal_map
    system[:size, size:], system[size:, :size] = asked.feet.T, asked.feet
    right = np.concatenate((asked.centroidal_map.T @ asked.momentum, asked.feet_velocity))
    best = np.linalg.lstsq(system, right, rcond=1e-12)[0][:size]
    return worst(asked.centroidal_map @ (asked.rates - best)) / robot.mass


def _nearest(robot: RobotModel, seed: int) -> float:
    """Against one pseudo-inverse of feet and momentum together, from the reference on."""
    asked = _question(robot, seed)
    rows = np.concatenate((asked.feet, asked.centroidal_map))
    wanted = np.concatenate((asked.feet_velocity, asked.momentum))
    nearest = asked.reference + np.linalg.pinv(rows) @ (wanted - rows @ asked.reference)
    return worst(asked.rates - nearest)


_FUNCTION = "momentum.resolved.resolved_rates"
_TEST = "tests/momentum/test_resolved.py::test_"

EQUATIONS = (
    Equation(
        24,
        "v_c = J_c q'",
        _FUNCTION,
        f"{_TEST}feet_momentum_and_reference_in_this_order",
        _feet,
        1e-9,
        "SI",
    ),
    Equation(
        25,
        "q' = argmin |h_d - A_G q'| subject to J_c q' = v_c",
        _FUNCTION,
        f"{_TEST}the_least_squares_of_eq_25_has_the_same_answer",
        _least_squares,
        1e-6,
        "SI",
    ),
    Equation(
        26,
        "q' = J_c^+ v_c + N z, z = (A_G N)^+ (h_d - A_G J_c^+ v_c), J_c N = 0",
        _FUNCTION,
        f"{_TEST}feet_momentum_and_reference_in_this_order",
        _nearest,
        1e-7,
        "SI",
    ),
)
