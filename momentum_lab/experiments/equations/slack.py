"""Eqs. 61 and 62: slacks, and the quadratic program that makes them small (section 5.2)."""

from __future__ import annotations

import dataclasses

import numpy as np
import pinocchio as pin

from momentum_lab.control.controller import ControlOutput, Reference
from momentum_lab.control.outputs import Output, least_squares, lightened
from momentum_lab.control.qp import QuadraticProgram, solve_reference
from momentum_lab.control.slack_qp import SlackGains
from momentum_lab.control.stance_motion import StanceMotion, stance_motion
from momentum_lab.control.stance_program import StanceBounds, StanceProgram
from momentum_lab.experiments.equations.equation import Equation
from momentum_lab.experiments.equations.outputs import LEFT, com_slack, least_slack, outputs_on_one_leg
from momentum_lab.experiments.equations.scenes import Scene, standing, standing_goal, worst
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.robot.model import RobotModel

# Makes accelerations unique where no output decides, as in the controller.
_RIDGE = 1e-4
_GAINS = SlackGains()
# Of the cost: torque limits in force yield by a millionth for the controller, and are firm for Clarabel.
_PRICE = 1e-5
# How far beside its goal the CoM is asked to be, in parts of what the sole's half width can give.
_BEYOND = (1.1, 1.4)


def _goal(scene: Scene) -> Reference:
    """A CoM so far to one side that the sole cannot give what it asks for: CoP bounds are active.

    Only so far that motors seldom come to their limits, which yield a little for the controller.
    """
    goal, sole = standing_goal(scene, LEFT), scene.robot.soles[0]
    half_width = (sole.upper[1] - sole.lower[1]) / 2.0
    reach = half_width * GRAVITY / (_GAINS.com_stiffness * scene.dynamics.com_in_world[2])
    side = scene.rng.choice((-1.0, 1.0)) * scene.rng.uniform(*_BEYOND) * reach
    return dataclasses.replace(goal, com=goal.com + [0.0, side, 0.0])


def _solved(robot: RobotModel, seed: int) -> tuple[Scene, Reference, ControlOutput]:
    scene = standing(robot, seed, LEFT)
    goal = _goal(scene)
    return scene, goal, least_slack(scene, goal, _GAINS)


def _slack(robot: RobotModel, seed: int) -> float:
    """The CoM's slack of a solved program plus Pinocchio's acceleration of the CoM against what was wanted."""
    scene, goal, answer = _solved(robot, seed)
    data, now = robot.model.createData(), scene.dynamics
    pin.centerOfMass(robot.model, data, scene.state.q, scene.state.v, answer.acceleration)
    wanted = _GAINS.com_stiffness * (goal.com - now.com_in_world) - _GAINS.com_damping * now.com_velocity
    return worst(data.acom[0] + com_slack(answer) - wanted)


def _minimum(robot: RobotModel, seed: int) -> float:
    """The cost of the controller's answer against that of Clarabel's, relative to it."""
    scene, goal, answer = _solved(robot, seed)
    outputs = outputs_on_one_leg(scene, goal, _GAINS)
    motion = stance_motion(scene.dynamics, goal, LEFT, _GAINS.contact_damping)
    reference = motion.acceleration.at(solve_reference(_program(scene, outputs, motion)))
    least = _cost(outputs, reference)
    return abs(_cost(outputs, answer.acceleration) - least) / least


def _program(scene: Scene, outputs: list[Output], motion: StanceMotion) -> QuadraticProgram:
    """Eq. 62 put together anew."""
    hessian, gradient = least_squares(outputs, motion.acceleration)
    hessian += _RIDGE * np.eye(len(gradient))
    bounds = StanceBounds(
        border=_GAINS.safe_border,
        friction=_GAINS.friction,
        least_force=_GAINS.least_foot_force,
        joint_limit_rate=_GAINS.joint_limit_rate,
    )
    program = StanceProgram(scene.robot, LEFT, LEFT)
    centered = program.centered(scene.dynamics, motion.wrench)
    lighter = lightened(hessian, gradient, outputs)
    return program.problem(*lighter, scene.dynamics, motion, centered, bounds)


def _cost(outputs: list[Output], acceleration: np.ndarray) -> float:
    """s^T W s, and the ridge on the joints."""
    slack = sum(each.weight * np.sum(each.slack(acceleration) ** 2) for each in outputs)
    return float(slack + _RIDGE * np.sum(acceleration[6:] ** 2))


_TICK = "tests/control/test_slack_qp.py::TestOneTick::test_"

EQUATIONS = (
    Equation(
        61,
        "y_d'' = y_c'' + s",
        "control.outputs.Output.slack",
        "tests/control/test_outputs.py::test_the_slack_is_what_is_missing",
        _slack,
        1e-8,
        "m/s^2",
    ),
    Equation(
        62,
        "min s^T W s subject to Eqs. 47 and 52",
        "control.slack_qp.SlackQP.compute",
        f"{_TICK}the_answer_is_the_minimiser_by_another_solver",
        _minimum,
        _PRICE,
        "1",
    ),
)
