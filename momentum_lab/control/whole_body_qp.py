"""One quadratic program over accelerations, forces and torques: the modern form of momentum control.

The chapter's scheme asks three questions in a row: which forces, which accelerations, which torques. Here they
are one question, so no answer has to be repaired by the next (Herzog et al. 2014).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from momentum_lab.control import common_gains
from momentum_lab.control.controller import ControlOutput, Reference
from momentum_lab.control.desired import desired_angular_rate, desired_linear_rate
from momentum_lab.control.fallback import NO_FOOT, hold
from momentum_lab.control.footing import Footing
from momentum_lab.control.gains import gain
from momentum_lab.control.momentum_lqr import LqrCosts
from momentum_lab.control.outputs import (
    Output,
    Spring,
    least_squares,
    lightened,
    momentum_outputs,
    pelvis_output,
    posture_output,
)
from momentum_lab.control.planner import OWN, PLANNERS, Support
from momentum_lab.control.qp import solve
from momentum_lab.control.regulated import RegulatedMomentum
from momentum_lab.control.stance_motion import Affine, StanceMotion, stance_motion
from momentum_lab.control.stance_output import stance_output
from momentum_lab.control.stance_program import StanceBounds, StanceProgram
from momentum_lab.errors import SolverError
from momentum_lab.momentum.centroidal import momentum_rate
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics

# Keeps accelerations unique where nothing else decides.
_RIDGE = 1e-5
# What the less important momentum weighs against the more important one at the ends of the slider.
_SECOND = 1e-3


@dataclass(frozen=True, slots=True)
class WholeBodyGains:
    """Gains of the whole-body quadratic program."""

    linear_damping: float = common_gains.linear_damping()
    linear_stiffness: float = common_gains.linear_stiffness()
    angular_damping: float = common_gains.angular_damping()
    pelvis_stiffness: float = common_gains.pelvis_stiffness()
    lqr_share: float = gain(
        0.0, "1", 0.0, 1.0, "0: momentum rates of Eqs. 37, 38; 1: those of a linear-quadratic regulator."
    )
    lqr_com_error: float = gain(
        0.02, "m", 0.001, 0.2, "CoM error as bad as the other errors of the regulator: smaller is stiffer."
    )
    lqr_velocity_error: float = gain(
        0.1, "m/s", 0.005, 2.0, "CoM velocity as bad as the other errors of the regulator."
    )
    lqr_spin_error: float = gain(
        0.5, "rad/s", 0.01, 10.0, "Average spin as bad as the other errors of the regulator."
    )
    lqr_force: float = gain(
        0.03, "1", 0.001, 1.0, "Change of a foot's force, in parts of the weight, as bad as those errors."
    )
    momentum_weight: float = gain(1e4, "1", 1.0, 1e6, "Weight of the momentum that the slider keeps.")
    posture_weight: float = gain(0.1, "1", 0.0, 1e2, "Weight of the upper body's posture.")
    pelvis_weight: float = gain(0.01, "1", 0.0, 1e2, "Weight of an upright pelvis.")
    posture_stiffness: float = gain(
        100.0, "1/s^2", 0.0, 400.0, "How strongly upper body and pelvis are pulled to their posture."
    )
    posture_damping: float = gain(
        20.0, "1/s", 0.0, 60.0, "How strongly motion of upper body and pelvis is braked."
    )
    force_weight: float = gain(
        1e-3, "1", 1e-5, 10.0, "Weight of an even share of the weight between the feet."
    )
    contact_damping: float = common_gains.contact_damping()
    safe_border: float = common_gains.safe_border()
    friction: float = common_gains.friction()
    least_foot_force: float = common_gains.least_foot_force()
    joint_limit_rate: float = common_gains.joint_limit_rate()


class WholeBodyQP:
    """Momentum, posture and forces in one program (EoM, contact, friction, CoP, torque limits).

    Args:
        robot: the robot.
        timestep: time between two calls, s; unused, the law has no memory.
    """

    def __init__(self, robot: RobotModel, timestep: float) -> None:
        self.robot = robot
        self.footing = Footing(robot)
        self._regulator = RegulatedMomentum(robot)
        self._programs: dict[tuple[tuple[int, ...], tuple[int, ...]], StanceProgram] = {}

    def initial_memory(self, dynamics: Dynamics) -> None:
        """Nothing: the torques follow from the state."""
        return None

    def compute(
        self,
        dynamics: Dynamics,
        reference: Reference,
        gains: WholeBodyGains,
        priority: float,
        memory: None,
    ) -> ControlOutput:
        """Torques for one tick; see `Controller.compute`.

        min w_l |dl_d - dl|^2 / m^2 + w_k |I_G^-1 (dk_d - dk)|^2 + posture + pelvis + uneven forces, with
        dh = A_G a + dA_G v, subject to the equations of motion, still feet, wrenches within the cones of the
        safe soles, and limits of torques and joints. The priority is the ratio of w_l and w_k: priority 0
        keeps linear momentum, priority 1 angular momentum, evenly on a logarithmic scale between. Directions that
        are not asked for have no term (section 5.3.1); what is desired there is what comes out.
        """
        carrying = self.footing.on_the_ground(dynamics, reference.stance, reference.ground)
        if not carrying:
            return hold(self.robot, dynamics, reference, NO_FOOT, memory)
        desired = self.desired_rate(dynamics, reference, gains)
        if reference.planner != OWN:
            stance = self.footing.stance_feet(dynamics, carrying, gains.safe_border)
            support = Support(self.robot.mass, stance.safe_polygon, stance.height)
            desired = PLANNERS[reference.planner].plan(desired, dynamics, reference, support)
        motion = stance_motion(dynamics, reference, carrying, gains.contact_damping)
        program = self._program(reference.stance, carrying)
        outputs = self._outputs(dynamics, reference, desired, gains, priority)
        uneven = program.centered(dynamics, motion.wrench)
        hessian, gradient = self._objective(outputs, motion, uneven, gains)
        problem = program.problem(hessian, gradient, dynamics, motion, uneven, _bounds(gains))
        try:
            x = solve(problem).x
        except SolverError as error:
            return hold(self.robot, dynamics, reference, str(error), memory)
        if not all(reference.controlled):
            achieved = momentum_rate(dynamics, motion.acceleration.at(x))
            desired = np.where(
                reference.controlled, desired, achieved
            )  # what is not asked for is as it comes
        return stance_output(self.robot, dynamics, motion, x, carrying, desired, slack={})

    def desired_rate(self, dynamics: Dynamics, reference: Reference, gains: WholeBodyGains) -> np.ndarray:
        """[dl_d; dk_d] (6,), N and N m: Eqs. 37 and 38, the regulator's, or a mean of both; dk_d as it moves."""
        upright = desired_angular_rate(dynamics, reference, 0.0, gains.pelvis_stiffness)
        if reference.angular_momentum_rate is not None:
            upright += reference.angular_momentum_rate
        rate = np.concatenate([np.zeros(3), upright])
        if gains.lqr_share < 1.0:
            linear = desired_linear_rate(
                self.robot.mass, dynamics, reference, gains.linear_damping, gains.linear_stiffness
            )
            angular = desired_angular_rate(dynamics, reference, gains.angular_damping, 0.0)
            rate += (1.0 - gains.lqr_share) * np.concatenate([linear, angular])
        if gains.lqr_share > 0.0:
            rate += gains.lqr_share * self._regulator.rate(dynamics, reference, _costs(gains))
        return rate

    def _outputs(
        self,
        dynamics: Dynamics,
        reference: Reference,
        desired: np.ndarray,
        gains: WholeBodyGains,
        priority: float,
    ) -> list[Output]:
        """Momentum as accelerations, the more important part first; then what is left free."""
        linear, angular = (gains.momentum_weight * _SECOND**part for part in (priority, 1.0 - priority))
        spring = Spring(gains.posture_stiffness, gains.posture_damping)
        lifted = [s.joints for foot, s in enumerate(self.robot.soles) if foot not in reference.stance]
        joints = np.concatenate([self.robot.upper_body, *lifted])
        return [
            *momentum_outputs(self.robot.mass, dynamics, desired, reference.controlled, linear, angular),
            pelvis_output(dynamics, reference, spring, gains.pelvis_weight),
            posture_output(dynamics, reference, joints, spring, gains.posture_weight),
        ]

    def _objective(
        self, outputs: list[Output], motion: StanceMotion, uneven: Affine, gains: WholeBodyGains
    ) -> tuple[np.ndarray, np.ndarray]:
        hessian, gradient = least_squares(outputs, motion.acceleration)
        joints = np.arange(self.robot.na)
        hessian[joints, joints] += _RIDGE
        hessian += gains.force_weight * (uneven.matrix.T @ uneven.matrix)
        gradient += gains.force_weight * (uneven.offset @ uneven.matrix)
        return lightened(hessian, gradient, outputs)

    def _program(self, stance: tuple[int, ...], carrying: tuple[int, ...]) -> StanceProgram:
        if (stance, carrying) not in self._programs:
            self._programs[stance, carrying] = StanceProgram(self.robot, stance, carrying)
        return self._programs[stance, carrying]


def _costs(gains: WholeBodyGains) -> LqrCosts:
    return LqrCosts(gains.lqr_com_error, gains.lqr_velocity_error, gains.lqr_spin_error, gains.lqr_force)


def _bounds(gains: WholeBodyGains) -> StanceBounds:
    return StanceBounds(
        border=gains.safe_border,
        friction=gains.friction,
        least_force=gains.least_foot_force,
        joint_limit_rate=gains.joint_limit_rate,
    )
