"""Eqs. 37, 38 and 42: feedback laws of balance (sections 5.1.1 and 5.2)."""

from __future__ import annotations

import dataclasses

import numpy as np

from momentum_lab.control.desired import desired_angular_rate, desired_linear_rate
from momentum_lab.control.outputs import Spring, com_output, posture_output
from momentum_lab.experiments.equations.equation import Equation
from momentum_lab.experiments.equations.scenes import STEP, Scene, standing, standing_goal, worst
from momentum_lab.robot.model import RobotModel

# Gains of critically damped motion: x(t) = (x_0 + (v_0 + RATE x_0) t) e^(-RATE t).
_RATE = 4.0
_DAMPING, _STIFFNESS = 2.0 * _RATE, _RATE**2
# Steps of second differences: rounding grows with their inverse square.
_LONG_STEP = 10.0 * STEP


def _settling(error: np.ndarray, speed: np.ndarray) -> np.ndarray:
    """Second derivative at t = 0 of a critically damped motion to zero, by central differences."""

    def at(t: float) -> np.ndarray:
        return (error + (speed + _RATE * error) * t) * np.exp(-_RATE * t)

    return (at(_LONG_STEP) - 2.0 * at(0.0) + at(-_LONG_STEP)) / _LONG_STEP**2


def _com_error(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    goal = standing_goal(scene)
    return scene.dynamics.com_in_world - goal.com, scene.dynamics.com_velocity - goal.com_velocity


def _linear(robot: RobotModel, seed: int) -> float:
    """Against the acceleration of the critically damped motion that the gains describe."""
    scene = standing(robot, seed)
    found = desired_linear_rate(robot.mass, scene.dynamics, standing_goal(scene), _DAMPING, _STIFFNESS)
    return worst(found / robot.mass - _settling(*_com_error(scene)))


def _angular(robot: RobotModel, seed: int) -> float:
    """Against the slope of k(t) = k_d + (k_0 - k_d) e^(-Gamma t), by central differences."""
    scene = standing(robot, seed)
    wish = scene.rng.normal(size=3)
    goal = dataclasses.replace(standing_goal(scene), angular_momentum=wish)
    excess = scene.dynamics.momentum[3:] - wish
    slope = excess * (np.exp(-_RATE * STEP) - np.exp(_RATE * STEP)) / (2.0 * STEP)
    return worst(desired_angular_rate(scene.dynamics, goal, _RATE, 0.0) - slope)


def _outputs(robot: RobotModel, seed: int) -> float:
    """CoM and posture against the critically damped motion that the gains describe."""
    scene = standing(robot, seed)
    goal, spring, joints = standing_goal(scene), Spring(_STIFFNESS, _DAMPING), robot.upper_body
    com = com_output(robot.mass, scene.dynamics, goal, spring, 1.0).desired
    posture = posture_output(scene.dynamics, goal, joints, spring, 1.0).desired
    away = scene.state.q[7 + joints] - goal.posture[joints]
    return worst(com - _settling(*_com_error(scene)), posture - _settling(away, scene.state.v[6 + joints]))


_TEST = "tests/control/test_"
_COMMAND = "the left side is a command, not the rate of the set-point"

EQUATIONS = (
    Equation(
        37,
        "k_d' = Gamma_11 (k_d - k)",
        "control.desired.desired_angular_rate",
        f"{_TEST}desired.py::test_angular_rate_brakes_what_exceeds_the_wish",
        _angular,
        1e-7,
        "N m",
        _COMMAND,
    ),
    Equation(
        38,
        "l_d' / m = Gamma_21 (r_d' - r') + Gamma_22 (r_d - r)",
        "control.desired.desired_linear_rate",
        f"{_TEST}desired.py::test_linear_rate_is_mass_times_spring_and_damper",
        _linear,
        1e-6,
        "m/s^2",
        _COMMAND,
    ),
    Equation(
        42,
        "y_d'' = Gamma_p (y_d - y) + Gamma_d (y_d' - y')",
        "control.outputs.com_output",
        f"{_TEST}outputs.py::test_springs_pull_back_and_dampers_brake",
        _outputs,
        1e-6,
        "SI",
        "y_d' is missing: printed is the case of a set-point at rest",
    ),
)
