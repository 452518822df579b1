"""Eqs. 27 to 36: momentum-based computed torque (section 4.2)."""

from __future__ import annotations

import dataclasses

import numpy as np
import pinocchio as pin

from momentum_lab.control.accelerations import AccelerationProgram, MotionWeights, contact_constraint
from momentum_lab.control.computed_torque import (
    ComputedTorque,
    ComputedTorqueGains,
    JointCommand,
    inverse_dynamics,
    joint_feedback,
)
from momentum_lab.control.controller import ControlOutput
from momentum_lab.control.foot_forces import FootForces, Footing, ForceBounds
from momentum_lab.control.stance_motion import stance_motion
from momentum_lab.experiments.equations.equation import Equation
from momentum_lab.experiments.equations.scenes import (
    Scene,
    flying,
    inverse_dynamics_by_recursion,
    standing,
    standing_goal,
    worst,
)
from momentum_lab.momentum.centroidal import momentum_rate
from momentum_lab.momentum.ground import momentum_rate_from_wrenches
from momentum_lab.momentum.resolved import null_space
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import State

_BOTH = (0, 1)
_TIMESTEP, _RIDGE = 1e-3, 1e-6
# The chapter's Eq. 34 has no pelvis term.
_WEIGHTS = MotionWeights(
    momentum=0.99, pelvis=0.0, stiffness=25.0, damping=10.0, contact_rate=50.0, joint_limit_rate=25.0
)


def _sole_velocity(robot: RobotModel, seed: int) -> float:
    """J_c v against central differences of the soles' poses."""
    scene = flying(robot, seed)

    def poses(state: State) -> np.ndarray:
        moved = robot.at(state)
        turns = moved.sole_rotation @ scene.dynamics.sole_rotation.transpose(0, 2, 1)
        return np.concatenate([moved.sole_position, [pin.log3(turn) for turn in turns]], axis=1).ravel()

    return worst((scene.dynamics.sole_jacobian @ scene.state.v).ravel() - scene.rate(poses))


def _sole_acceleration(robot: RobotModel, seed: int) -> float:
    """J_c a + dJ_c v against central differences of the soles' velocities."""
    scene = flying(robot, seed)

    def velocities(state: State) -> np.ndarray:
        return (robot.at(state).sole_jacobian @ state.v).ravel()

    # Without correction of errors the target is -dJ_c v.
    rows, target = contact_constraint(scene.dynamics, _BOTH, standing_goal(scene), 0.0)
    return worst(rows @ scene.acceleration - target - scene.rate(velocities))


def _all_rows(robot: RobotModel, seed: int) -> float:
    """Base and joint rows of a motion on two feet by Pinocchio's recursion, minus its torques."""
    scene = standing(robot, seed)
    motion = stance_motion(scene.dynamics, standing_goal(scene), _BOTH, _WEIGHTS.contact_rate)
    x = scene.draw(motion.acceleration.matrix.shape[1])
    rows = inverse_dynamics_by_recursion(scene, motion.acceleration.at(x), motion.wrench.at(x).reshape(2, 6))
    rows[6:] -= motion.torque.at(x)
    return worst(rows) / scene.weight


def _base_rows(robot: RobotModel, seed: int) -> float:
    """No force on the base: gravity and foot wrenches (Eqs. 1, 2) against the momentum rate (Eq. 20)."""
    scene = standing(robot, seed)
    dynamics = scene.dynamics
    motion = stance_motion(dynamics, standing_goal(scene), _BOTH, _WEIGHTS.contact_rate)
    x = scene.draw(motion.acceleration.matrix.shape[1])
    wrench = motion.wrench.at(x).reshape(2, 6)
    given = momentum_rate_from_wrenches(wrench, dynamics.sole_position, dynamics.com_in_world, robot.mass)
    return worst(given - momentum_rate(dynamics, motion.acceleration.at(x))) / scene.weight


def _joint_rows(robot: RobotModel, seed: int) -> float:
    """Torques for any acceleration and any foot wrenches against Pinocchio's recursion."""
    scene = flying(robot, seed)
    dynamics, wrench = scene.dynamics, scene.rng.normal(scale=0.3 * scene.weight, size=(2, 6))
    found = inverse_dynamics(
        dynamics.mass_matrix, dynamics.nonlinear_effects, dynamics.sole_jacobian, scene.acceleration, wrench
    )
    return worst(found - inverse_dynamics_by_recursion(scene, scene.acceleration, wrench)[6:]) / scene.weight


def _momentum_rate(robot: RobotModel, seed: int) -> float:
    """Against Pinocchio's recursion of the momentum rate."""
    scene = flying(robot, seed)
    data = robot.model.createData()
    q, v, a = scene.state.q, scene.state.v, scene.acceleration
    expected = pin.computeCentroidalMomentumTimeVariation(robot.model, data, q, v, a)
    return worst(momentum_rate(scene.dynamics, a) - expected.vector)


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
    footing = Footing(scene.robot)
    bounds = ForceBounds(friction=0.6, normal_moment=0.018, least_force=0.02 * scene.weight)
    rate = scene.robot.mass * scene.rng.uniform(-0.1, 0.1, 6) * [1.0, 1.0, 1.0, 0.5, 0.5, 0.1]
    force = rate[:3] + [0.0, 0.0, scene.weight]
    return footing.share(footing.stance_feet(scene.dynamics, _BOTH, 0.005), force, rate[3:], bounds)


def _objective(scene: Scene, feet: FootForces) -> tuple[np.ndarray, np.ndarray]:
    """Rows and wishes of Eq. 34, each times the root of its weight, and the ridge that pulls to the same wishes."""
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
    ridge = np.zeros(robot.nv)
    ridge[6 + robot.upper_body] = np.sqrt(_RIDGE) * wish
    return np.concatenate(rows), np.concatenate((momentum * missing, posture * wish, ridge))


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
        27,
        "v_c = J_c q'",
        "robot.model.RobotModel.at",
        "tests/robot/test_model.py::test_jacobians_are_the_velocities_of_the_placements",
        _sole_velocity,
        1e-6,
        "SI",
    ),
    Equation(
        28,
        "tau = H q'' + C q' + tau_g - J_c^T f_c, tau = [0; tau_s]",
        "control.stance_motion.stance_motion",
        f"{_TESTS}stance_motion.py::test_every_choice_is_a_motion_of_the_robot",
        _all_rows,
        1e-9,
        "m g",
    ),
    Equation(
        29,
        "0 = H_0 q'' + C_0 q' + tau_g,0 - J_c,0^T f_c",
        "control.stance_motion.stance_motion",
        f"{_TESTS}stance_motion.py::test_wrenches_are_the_momentum_rate",
        _base_rows,
        1e-9,
        "m g",
        "equivalent to Eq. 20 only together with Eqs. 1 and 2: h_G' there is gravity and contact here",
    ),
    Equation(
        30,
        "tau_s = H_s q'' + C_s q' + tau_g,s - J_c,s^T f_c",
        f"{_TORQUE}inverse_dynamics",
        f"{_TICK}torques_are_those_of_inverse_dynamics",
        _joint_rows,
        1e-9,
        "m g",
    ),
    Equation(
        31,
        "v_c' = J_c q'' + J_c' q'",
        "control.accelerations.contact_constraint",
        f"{_TESTS}accelerations.py::test_the_contact_constraint_is_the_rate_of_the_sole_velocities",
        _sole_acceleration,
        1e-5,
        "SI",
    ),
    Equation(
        32,
        "h_G' = A_G q'' + A_G' q'",
        "momentum.centroidal.momentum_rate",
        "tests/momentum/test_centroidal.py::test_momentum_rate",
        _momentum_rate,
        1e-9,
        "SI",
    ),
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
