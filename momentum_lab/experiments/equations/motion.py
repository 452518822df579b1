"""Eqs. 27 to 32: contacts, equations of motion and the momentum rate (section 4.2)."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from momentum_lab.control.accelerations import contact_constraint
from momentum_lab.control.computed_torque import inverse_dynamics
from momentum_lab.control.stance_motion import stance_motion
from momentum_lab.experiments.equations.equation import Equation
from momentum_lab.experiments.equations.scenes import (
    flying,
    inverse_dynamics_by_recursion,
    standing,
    standing_goal,
    worst,
)
from momentum_lab.momentum.centroidal import momentum_rate
from momentum_lab.momentum.ground import momentum_rate_from_wrenches
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import State

_BOTH = (0, 1)
# How fast a stance foot is brought to rest and flat, 1/s.
_CONTACT_RATE = 50.0


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
    motion = stance_motion(scene.dynamics, standing_goal(scene), _BOTH, _CONTACT_RATE)
    x = scene.draw(motion.acceleration.matrix.shape[1])
    rows = inverse_dynamics_by_recursion(scene, motion.acceleration.at(x), motion.wrench.at(x).reshape(2, 6))
    rows[6:] -= motion.torque.at(x)
    return worst(rows) / scene.weight


def _base_rows(robot: RobotModel, seed: int) -> float:
    """No force on the base: gravity and foot wrenches (Eqs. 1, 2) against the momentum rate (Eq. 20)."""
    scene = standing(robot, seed)
    dynamics = scene.dynamics
    motion = stance_motion(dynamics, standing_goal(scene), _BOTH, _CONTACT_RATE)
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
)
