"""Eqs. 33 to 36: accelerations and torques of the computed torque controller (section 4.2)."""

from __future__ import annotations

import dataclasses

import numpy as np

from momentum_lab.control.accelerations import AccelerationProgram, MotionWeights, contact_constraint
from momentum_lab.control.computed_torque import (
    ComputedTorque,
    ComputedTorqueGains,
    JointCommand,
    joint_feedback,
)
from momentum_lab.control.controller import ControlOutput
from momentum_lab.control.foot_forces import FootForces, ForceBounds, LoadSharing
from momentum_lab.control.footing import Footing
from momentum_lab.experiments.equations.equation import Equation
from momentum_lab.experiments.equations.scenes import (
    Scene,
    inverse_dynamics_by_recursion,
    standing,
    standing_goal,
    worst,
)
from momentum_lab.momentum.resolved import null_space
from momentum_lab.robot.model import RobotModel

_BOTH = (0, 1)
_TIMESTEP, _RIDGE = 1e-3, 1e-6
# The chapter's Eq. 34 has no pelvis term.
_WEIGHTS = MotionWeights(
    momentum=0.99, pelvis=0.0, stiffness=25.0, damping=10.0, contact_rate=50.0, joint_limit_rate=25.0
)


def _accelerations(robot: RobotModel, seed: int) -> float:
    """The solver's minimum against the least squares of Eq. 34 in the null space of J_c."""
    scene = standing(robot, seed)
    feet, reference = _modest_forces(scene), standing_goal(scene)
    found = AccelerationProgram(robot, _BOTH).solve(scene.dynamics, feet, reference, _WEIGHTS)
    rows, target = contact_constraint(scene.dynamics, _BOTH, reference, _WEIGHTS.contact_rate)
    objective, wanted = _objective(scene, feet)
    particular = np.linalg.lstsq(rows, target, rcond=None)[0]
    free = null_space(rows)
    z = np.linalg.lstsq(objective @ free, wanted - objective @ particular, rcond=None)[0]
    return worst(found - particular - free @ z)


def _modest_forces(scene: Scene) -> FootForces:
    """Admissible foot forces for a momentum rate that two feet can give."""
    bounds = ForceBounds(friction=0.6, normal_moment=0.018, least_force=0.02 * scene.weight)
    rate = scene.robot.mass * scene.rng.uniform(-0.1, 0.1, 6) * [1.0, 1.0, 1.0, 0.5, 0.5, 0.1]
    force = rate[:3] + [0.0, 0.0, scene.weight]
    stance = Footing(scene.robot).stance_feet(scene.dynamics, _BOTH, 0.005)
    return LoadSharing(scene.robot).share(stance, force, rate[3:], bounds)


def _objective(scene: Scene, feet: FootForces) -> tuple[np.ndarray, np.ndarray]:
    """Rows and wishes of Eq. 34, each times the root of its weight, and the ridge, which wishes for none."""
    robot, dynamics = scene.robot, scene.dynamics
    per_inertia = np.zeros((6, 6))
    per_inertia[:3, :3], per_inertia[3:, 3:] = np.eye(3) / robot.mass, np.linalg.inv(dynamics.locked_inertia)
    momentum, posture = np.sqrt(_WEIGHTS.momentum), np.sqrt(1.0 - _WEIGHTS.momentum)
    error = (standing_goal(scene).posture - scene.state.q[7:])[robot.upper_body]
    wish = _WEIGHTS.stiffness * error - _WEIGHTS.damping * scene.state.v[6:][robot.upper_body]
    rows = (
        momentum * per_inertia @ dynamics.centroidal_map,
        posture * np.eye(robot.nv)[6 + robot.upper_body],
        np.sqrt(_RIDGE) * np.eye(robot.nv),
    )
    missing = per_inertia @ (feet.momentum_rate - dynamics.centroidal_bias)
    return np.concatenate(rows), np.concatenate((momentum * missing, posture * wish, np.zeros(robot.nv)))


def _answer(scene: Scene, gains: ComputedTorqueGains, command: JointCommand) -> ControlOutput:
    controller = ComputedTorque(scene.robot, _TIMESTEP)
    return controller.compute(scene.dynamics, standing_goal(scene), gains, 0.0, command)


def _command(scene: Scene) -> JointCommand:
    angle, rate = scene.rng.normal(scale=0.01, size=(2, scene.robot.na))
    return JointCommand(scene.state.q[7:] + angle, scene.state.v[6:] + rate)


def _controller_torque(robot: RobotModel, seed: int) -> float:
    """The controller's torques against Pinocchio's recursion for its accelerations and foot wrenches."""
    scene = standing(robot, seed)
    output = _answer(scene, ComputedTorqueGains(), _command(scene))
    rows = inverse_dynamics_by_recursion(scene, output.acceleration, output.foot_wrench_admissible)
    return worst(output.torque - rows[6:]) / scene.weight


def _feedforward_and_feedback(robot: RobotModel, seed: int) -> float:
    """The controller's torques with feedback against the recursion's plus the feedback."""
    scene = standing(robot, seed)
    gains = dataclasses.replace(ComputedTorqueGains(), feedback_stiffness=300.0, feedback_damping=7.0)
    command = _command(scene)
    output = _answer(scene, gains, command)
    rows = inverse_dynamics_by_recursion(scene, output.acceleration, output.foot_wrench_admissible)
    expected = rows[6:] + joint_feedback(scene.dynamics, command, gains)
    return worst(output.torque - expected) / scene.weight


def _feedback(robot: RobotModel, seed: int) -> float:
    """Against the work of the feedback: minus the slopes of (Gamma_p e^2 + Gamma_d e'^2) / 2."""
    scene = standing(robot, seed)
    gains = dataclasses.replace(ComputedTorqueGains(), feedback_stiffness=300.0, feedback_damping=7.0)
    command, joint_angles, joint_rates = _command(scene), scene.state.q[7:], scene.state.v[6:]

    def energy(angles: np.ndarray, rates: np.ndarray) -> np.ndarray:
        stored = gains.feedback_stiffness * (angles - command.angle) ** 2
        return 0.5 * (stored + gains.feedback_damping * (rates - command.rate) ** 2)

    step = 1e-3
    angle_slope = energy(joint_angles + step, joint_rates) - energy(joint_angles - step, joint_rates)
    rate_slope = energy(joint_angles, joint_rates + step) - energy(joint_angles, joint_rates - step)
    found = joint_feedback(scene.dynamics, command, gains)
    return worst(found + (angle_slope + rate_slope) / (2.0 * step))


_TORQUE = "control.computed_torque."
_TESTS = "tests/control/test_"
_TICK = f"{_TESTS}computed_torque.py::test_"

EQUATIONS = (
    Equation(
        33,
        "tau_s = H_s q'' + C_s q' + tau_g,s - J_c,s^T f_c, q'' and f_c admissible",
        f"{_TORQUE}ComputedTorque.compute",
        f"{_TICK}torques_are_those_of_inverse_dynamics",
        _controller_torque,
        1e-9,
        "m g",
    ),
    Equation(
        34,
        "q'' = argmin w_b |h_a' - A_G q'' - A_G' q'|^2 + (1 - w_b) |th_d'' - th''|^2",
        "control.accelerations.AccelerationProgram.solve",
        f"{_TESTS}accelerations.py::test_the_answer_is_the_minimum_of_the_objective",
        _accelerations,
        1e-6,
        "SI",
        "norms squared, J is J_c; on two feet both terms reach 0 unless a bound is active, whatever w_b",
    ),
    Equation(
        35,
        "tau_s = tau_ff + tau_fb",
        f"{_TORQUE}ComputedTorque.compute",
        f"{_TICK}feedback_is_added_to_the_torque",
        _feedforward_and_feedback,
        1e-9,
        "m g",
    ),
    Equation(
        36,
        "tau_fb = Gamma_p (th* - th) + Gamma_d (th*' - th')",
        f"{_TORQUE}joint_feedback",
        f"{_TICK}feedback_is_added_to_the_torque",
        _feedback,
        1e-8,
        "N m",
        "the text below it names th where it means the command th*",
    ),
)
