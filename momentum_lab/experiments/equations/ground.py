"""Eqs. 1, 2, 21 to 23 and 39 to 41: momentum rates and the ground (sections 1, 3.4 and 5.1.2)."""

from __future__ import annotations

import numpy as np

from momentum_lab.experiments.equations.equation import Equation
from momentum_lab.experiments.equations.pressed import Pressed, pressed
from momentum_lab.experiments.equations.scenes import worst
from momentum_lab.momentum.ground import (
    cmp_cop_gap,
    cmp_from_force,
    cop_from_momentum_rate,
    ground_reaction_force,
    momentum_rate_from_wrenches,
)
from momentum_lab.momentum.wrench import y_up_from_z_up, z_up_from_y_up
from momentum_lab.robot.model import RobotModel


def _difference(robot: RobotModel, seed: int) -> np.ndarray:
    """Foot wrenches and gravity against Pinocchio's momentum rate of the motion they cause, in m g (m)."""
    case = pressed(robot, seed)
    dynamics = case.scene.dynamics
    found = momentum_rate_from_wrenches(
        case.wrenches, dynamics.sole_position, dynamics.com_in_world, robot.mass
    )
    return (found - case.rate) / case.scene.weight


def _angular_rate(robot: RobotModel, seed: int) -> float:
    return worst(_difference(robot, seed)[3:])


def _linear_rate(robot: RobotModel, seed: int) -> float:
    return worst(_difference(robot, seed)[:3])


def _found_cop(case: Pressed) -> np.ndarray:
    com = case.scene.dynamics.com_in_world
    return cop_from_momentum_rate(case.rate, com, case.scene.robot.mass, float(case.cop[2]))


def _cop(robot: RobotModel, seed: int) -> float:
    """The CoP of a motion against the mean of the points that are pressed."""
    case = pressed(robot, seed)
    return worst(_found_cop(case) - case.cop[:2])


def _cmp(robot: RobotModel, seed: int) -> float:
    """Distance of the CoM from the line of force through the CMP, |(s - r_G) x f| / |f|."""
    case = pressed(robot, seed)
    com, height = case.scene.dynamics.com_in_world, float(case.cop[2])
    arm = np.append(cmp_from_force(case.force, com, height), height) - com
    return worst(np.cross(arm, case.force)) / float(np.linalg.norm(case.force))


def _gap(robot: RobotModel, seed: int) -> float:
    """Against the line of force through the CoM and the mean of the points that are pressed."""
    case = pressed(robot, seed)
    com = case.scene.dynamics.com_in_world
    on_the_ground = com + (case.cop[2] - com[2]) / case.force[2] * case.force
    return worst(cmp_cop_gap(case.rate[3:], float(case.force[2])) - (on_the_ground - case.cop)[:2])


def _force(robot: RobotModel, seed: int) -> float:
    """The force that a motion needs against the sum of those that caused it."""
    case = pressed(robot, seed)
    return worst(ground_reaction_force(case.rate[:3], robot.mass) - case.force) / case.scene.weight


def _corrected(robot: RobotModel, seed: int) -> np.ndarray:
    """Eqs. 40 and 41 in their own y-up axes with errata put right, against the CoP z up (2,), m."""
    case = pressed(robot, seed)
    above = case.scene.dynamics.com_in_world - [0.0, 0.0, case.cop[2]]
    r, f, k = (y_up_from_z_up(each) for each in (above, case.force, case.rate[3:]))
    normal = y_up_from_z_up(case.rate[:3])[1] + case.scene.weight
    p = np.array([r[0] - (f[0] * r[1] - k[2]) / normal, 0.0, r[2] - (f[2] * r[1] + k[0]) / normal])
    return _found_cop(case) - z_up_from_y_up(p)[:2]


def _forward(robot: RobotModel, seed: int) -> float:
    return worst(_corrected(robot, seed)[0])


def _sideways(robot: RobotModel, seed: int) -> float:
    return worst(_corrected(robot, seed)[1])


_TEST = "tests/momentum/test_ground.py::test_"
_PUSH = "only ground and weight as printed: a push F at c adds F and (c - r_G) x F"
_GRAVITY = "the divisor is f_y = l_y' + 9.81 m, y up: g is -9.81 there, and l_y' a number, not bold"

EQUATIONS = (
    Equation(
        1,
        "k' = sum ((p_i - r_G) x f_i + n_i)",
        "momentum.ground.momentum_rate_from_wrenches",
        f"{_TEST}momentum_rate_is_gravity_plus_contacts_plus_push",
        _angular_rate,
        1e-9,
        "m g",
        _PUSH,
    ),
    Equation(
        2,
        "l' = m g + sum f_i",
        "momentum.ground.momentum_rate_from_wrenches",
        f"{_TEST}momentum_rate_is_gravity_plus_contacts_plus_push",
        _linear_rate,
        1e-9,
        "m g",
        _PUSH,
    ),
    Equation(
        21,
        "p_x = r_x - (f_x z_c + k_y') / f_z, p_y = r_y - (f_y z_c - k_x') / f_z",
        "momentum.ground.cop_from_momentum_rate",
        f"{_TEST}cop_of_a_whole_robot",
        _cop,
        1e-9,
        "m",
    ),
    Equation(
        22,
        "s = r_G - (f / f_z) z_c",
        "momentum.ground.cmp_from_force",
        f"{_TEST}cmp_lies_on_the_line_of_force_through_the_com",
        _cmp,
        1e-9,
        "m",
    ),
    Equation(
        23,
        "s - p = (k_y', -k_x') / f_z",
        "momentum.ground.cmp_cop_gap",
        f"{_TEST}gap_between_cop_and_cmp_is_the_moment_arm",
        _gap,
        1e-9,
        "m",
    ),
    Equation(
        39,
        "f_d = l_d' - m g",
        "momentum.ground.ground_reaction_force",
        f"{_TEST}ground_wrench_is_the_momentum_rate_without_gravity",
        _force,
        1e-9,
        "m g",
    ),
    Equation(
        40,
        "p_d,x = r_x - (f_d,x z_c + k_d,y') / f_d,z",
        "momentum.ground.cop_from_momentum_rate",
        f"{_TEST}eqs_40_and_41_as_printed_are_wrong_and_corrected_are_right",
        _forward,
        1e-9,
        "m",
        f"the first term is r_Gx, not r_Gz; {_GRAVITY}",
    ),
    Equation(
        41,
        "p_d,y = r_y - (f_d,y z_c - k_d,x') / f_d,z",
        "momentum.ground.cop_from_momentum_rate",
        f"{_TEST}eqs_40_and_41_as_printed_are_wrong_and_corrected_are_right",
        _sideways,
        1e-9,
        "m",
        _GRAVITY,
    ),
)
