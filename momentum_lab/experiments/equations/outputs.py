"""Eqs. 43 to 47: outputs, and the equations that every tick of their controller obeys (section 5.2)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pinocchio as pin

from momentum_lab.control.accelerations import contact_constraint
from momentum_lab.control.controller import ControlOutput, Reference
from momentum_lab.control.outputs import (
    AXES,
    LiftedSoles,
    Output,
    Spring,
    com_output,
    pelvis_output,
    posture_output,
    sole_output,
)
from momentum_lab.control.slack_qp import SlackGains, SlackQP
from momentum_lab.control.stance_motion import stance_motion
from momentum_lab.errors import SolverError
from momentum_lab.experiments.equations.equation import Equation
from momentum_lab.experiments.equations.scenes import (
    Scene,
    inverse_dynamics_by_recursion,
    standing,
    standing_goal,
    worst,
)
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import State

LEFT = (0,)
"""The stance of Fig. 9."""
SPEED = 0.3
"""Of the standing robot whose outputs are measured, m/s and rad/s."""


def outputs_on_one_leg(scene: Scene, goal: Reference, gains: SlackGains) -> list[Output]:
    """CoM, pelvis, lifted sole and posture with the weights of the controller that keeps the CoM."""
    dynamics, robot = scene.dynamics, scene.robot
    body = Spring(gains.body_stiffness, gains.body_damping)
    com = Spring(gains.com_stiffness, gains.com_damping)
    lifted = LiftedSoles(robot).goal(dynamics, goal.posture, 1, 0)
    return [
        com_output(robot.mass, dynamics, goal, com, gains.com_weight),
        pelvis_output(dynamics, goal, body, gains.pelvis_weight),
        sole_output(dynamics, 1, lifted, body, gains.swing_weight),
        posture_output(dynamics, goal, robot.upper_body, body, gains.posture_weight),
    ]


def least_slack(scene: Scene, goal: Reference, gains: SlackGains) -> ControlOutput:
    """What the controller of section 5.2 answers.

    Raises:
        SolverError: it holds its posture instead.
    """
    answer = SlackQP(scene.robot, 1e-3).compute(scene.dynamics, goal, gains, 0.0, None)
    if answer.failure is not None:
        raise SolverError(f"Eqs. 47, 61 and 62 on {scene.robot.spec.title}: {answer.failure}")
    return answer


def com_slack(answer: ControlOutput) -> np.ndarray:
    """The CoM's slack (3,), m/s^2."""
    return np.array([answer.slack[f"com {axis}"] for axis in AXES])


def _stacked(parts: Sequence[np.ndarray]) -> np.ndarray:
    return np.concatenate([np.ravel(part) for part in parts])


def _positions(robot: RobotModel, seed: int) -> float:
    """CoM, pelvis axes and sole against the weighted mean of the links and Pinocchio's frames."""
    scene = standing(robot, seed, LEFT, SPEED)
    data, bodies = scene.kinematics(), list(robot.model.inertias)[1:]
    coms = [data.oMi[i + 1].act(body.lever) for i, body in enumerate(bodies)]
    com = np.average(coms, axis=0, weights=[body.mass for body in bodies])
    found, sole = scene.dynamics, data.oMf[robot.soles[1].frame]
    return worst(
        found.com_in_world - com,
        found.pelvis_rotation - data.oMf[robot.pelvis].rotation,
        found.sole_position[1] - sole.translation,
        found.sole_rotation[1] - sole.rotation,
    )


def _velocities(robot: RobotModel, seed: int) -> float:
    """J v of all outputs against central differences of what they are."""
    scene = standing(robot, seed, LEFT, SPEED)
    now = scene.dynamics

    def output(state: State) -> np.ndarray:
        moved = robot.at(state)
        pelvis = pin.log3(moved.pelvis_rotation @ now.pelvis_rotation.T)
        sole = pin.log3(moved.sole_rotation[1] @ now.sole_rotation[1].T)
        posture = state.q[7 + robot.upper_body]
        return _stacked((moved.com_in_world, pelvis, moved.sole_position[1], sole, posture))

    outputs = outputs_on_one_leg(scene, standing_goal(scene, LEFT), SlackGains())
    return worst(_stacked([each.jacobian @ scene.state.v for each in outputs]) - scene.rate(output))


def _accelerations(robot: RobotModel, seed: int) -> float:
    """J a + Psi of all outputs against central differences of their velocities."""
    scene = standing(robot, seed, LEFT, SPEED)

    def velocity(state: State) -> np.ndarray:
        moved = robot.at(state)
        pelvis, sole = moved.pelvis_jacobian[3:] @ state.v, moved.sole_jacobian[1] @ state.v
        return _stacked((moved.com_velocity, pelvis, sole, state.v[6 + robot.upper_body]))

    outputs = outputs_on_one_leg(scene, standing_goal(scene, LEFT), SlackGains())
    found = _stacked([each.jacobian @ scene.acceleration + each.bias for each in outputs])
    return worst(found - scene.rate(velocity))


def _rooted(robot: RobotModel, seed: int) -> float:
    """A robot rooted at its stance foot: all rows by Pinocchio's recursion, minus the torques, in m g."""
    scene = standing(robot, seed, LEFT, SPEED)
    motion = stance_motion(scene.dynamics, standing_goal(scene, LEFT), LEFT, 0.0)
    x = scene.draw(motion.acceleration.matrix.shape[1])
    wrench = motion.wrench.at(x).reshape(1, 6)
    rows = inverse_dynamics_by_recursion(scene, motion.acceleration.at(x), wrench, LEFT)
    rows[6:] -= motion.torque.at(x)
    return worst(rows) / scene.weight


def _system(robot: RobotModel, seed: int) -> float:
    """A solved program: the CoM's row, all rows by Pinocchio's recursion in m g, and the stance foot's."""
    scene = standing(robot, seed, LEFT, SPEED)
    goal, gains = standing_goal(scene, LEFT), SlackGains()
    answer = least_slack(scene, goal, gains)
    rows = inverse_dynamics_by_recursion(scene, answer.acceleration, answer.foot_wrench_admissible)
    rows[6:] -= answer.torque
    still, target = contact_constraint(scene.dynamics, LEFT, goal, gains.contact_damping)
    com = outputs_on_one_leg(scene, goal, gains)[0]
    slack = com_slack(answer)
    commanded = com.jacobian @ answer.acceleration + com.bias
    return worst(commanded + slack - com.desired, rows / scene.weight, still @ answer.acceleration - target)


_OUTPUTS = "control.outputs.com_output"
_SECOND = "tests/control/test_outputs.py::test_accelerations_are_second_differences"

EQUATIONS = (
    Equation(43, "y = x(q)", "robot.model.RobotModel.at", _SECOND, _positions, 1e-11, "SI"),
    Equation(44, "y' = J q'", _OUTPUTS, _SECOND, _velocities, 1e-6, "SI"),
    Equation(45, "y'' = J q'' + Psi, Psi = J' q'", _OUTPUTS, _SECOND, _accelerations, 1e-5, "SI"),
    Equation(
        46,
        "H q'' + C q' + tau_g - J_c^T f_c = tau",
        "control.stance_motion.stance_motion",
        "tests/control/test_stance_motion.py::test_every_choice_is_a_motion_of_the_robot",
        _rooted,
        1e-9,
        "m g",
        "no solution for a free base without J_c^T f_c; its C is a vector, that of Eq. 28 a matrix",
    ),
    Equation(
        47,
        "y_c'' + s = y_d'', y_c'' - J q'' = Psi, H q'' - tau - J_c^T f_c = -(C q' + tau_g)",
        "control.slack_qp.SlackQP.compute",
        "tests/control/test_slack_qp.py::TestOneTick::test_equation_47_with_its_corrections_holds",
        _system,
        1e-8,
        "m g",
        "-C is -(C + tau_g); y'' = y_d'' without a slack leaves no solution when a bound of Eq. 52 is active",
    ),
)
