"""Momentum-based computed torque control (the chapter's sections 4.2 and 5.1)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from momentum_lab.control.accelerations import AccelerationProgram, MotionWeights
from momentum_lab.control.controller import ControlOutput, Reference
from momentum_lab.control.desired import desired_angular_rate, desired_linear_rate
from momentum_lab.control.fallback import HOLD_IN_WORDS, hold_posture, without_ground
from momentum_lab.control.foot_forces import FootForces, Footing, ForceBounds
from momentum_lab.control.gains import gain
from momentum_lab.control.priority import Compromise, compromise
from momentum_lab.errors import SolverError
from momentum_lab.momentum.ground import GRAVITY, cop_from_momentum_rate
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics

# A sole of a few centimetres turns on its own friction with about this lever, m.
_YAW_LEVER = 0.03
# Eq. 36 integrates accelerations; what did not come true is forgotten with this time constant, s.
_FORGETTING_TIME = 0.05


@dataclass(frozen=True, slots=True)
class ComputedTorqueGains:
    """Gains of the momentum-based computed torque controller."""

    linear_damping: float = gain(
        8.0, "1/s", 0.0, 60.0, "Gamma_21: how strongly the velocity of the CoM is braked (Eq. 38)."
    )
    linear_stiffness: float = gain(
        16.0, "1/s^2", 0.0, 200.0, "Gamma_22: how strongly the CoM is pulled back over the feet (Eq. 38)."
    )
    angular_damping: float = gain(
        5.0, "1/s", 0.0, 40.0, "Gamma_11: how strongly angular momentum is braked (Eq. 37)."
    )
    pelvis_stiffness: float = gain(
        4.0, "1/s^2", 0.0, 60.0, "K_theta: how strongly the pelvis is turned upright; an extension of Eq. 37."
    )
    momentum_weight: float = gain(
        0.9999, "1", 0.5, 0.99999, "w_b: momentum against posture where both cannot be met (Eq. 34)."
    )
    posture_stiffness: float = gain(
        100.0, "1/s^2", 0.0, 400.0, "How strongly the upper body is pulled to its posture (Eq. 34)."
    )
    posture_damping: float = gain(
        20.0, "1/s", 0.0, 60.0, "How strongly the motion of the upper body is braked (Eq. 34)."
    )
    pelvis_weight: float = gain(
        1.0,
        "1",
        0.0,
        100.0,
        "Weight of an upright pelvis against the posture of the upper body; an extension.",
    )
    contact_damping: float = gain(
        50.0, "1/s", 0.0, 200.0, "kappa: how fast a stance foot is brought to rest and flat (Eq. 31)."
    )
    safe_border: float = gain(
        0.005, "m", 0.0, 0.02, "How far inside the edge of the sole the admissible CoP stays."
    )
    friction: float = gain(0.6, "1", 0.05, 1.5, "Friction coefficient the controller counts on.")
    least_foot_force: float = gain(
        0.02, "1", 0.005, 0.2, "Part of the weight that every stance foot keeps carrying."
    )
    joint_limit_rate: float = gain(
        25.0, "1/s", 5.0, 100.0, "How late a joint may brake before its limit: larger is later (Eq. 34)."
    )
    feedback_stiffness: float = gain(
        0.0,
        "N m/rad",
        0.0,
        2000.0,
        "Gamma_p: joint position feedback on top of the computed torque (Eq. 36).",
    )
    feedback_damping: float = gain(
        0.0,
        "N m s/rad",
        0.0,
        50.0,
        "Gamma_d: joint velocity feedback on top of the computed torque (Eq. 36).",
    )


@dataclass(frozen=True, slots=True)
class JointCommand:
    """What the integrated accelerations ask of the joints: the memory of Eq. 36.

    Attributes:
        angle: theta* (na,), rad.
        rate: its time derivative (na,), rad/s.
    """

    angle: np.ndarray
    rate: np.ndarray


class ComputedTorque:
    """Three questions in a row: which foot forces, which accelerations, which torques.

    Args:
        robot: the robot.
        timestep: time between two calls, s.
    """

    def __init__(self, robot: RobotModel, timestep: float) -> None:
        self.robot = robot
        self.timestep = timestep
        self.footing = Footing(robot)
        self._programs: dict[tuple[int, ...], AccelerationProgram] = {}

    def initial_memory(self, dynamics: Dynamics) -> JointCommand:
        """The joints as they are."""
        return JointCommand(dynamics.state.q[7:], dynamics.state.v[6:])

    def compute(
        self,
        dynamics: Dynamics,
        reference: Reference,
        gains: ComputedTorqueGains,
        priority: float,
        memory: JointCommand,
    ) -> ControlOutput:
        """Torques for one tick (Fig. 6); see `Controller.compute`."""
        desired = self._desired_rate(dynamics, reference, gains)
        carrying = self.footing.on_the_ground(dynamics, reference.stance, reference.sole_height)
        if not carrying:
            return self._fallback(dynamics, reference, desired, "no foot is on the ground")
        balance = self._balance(dynamics, desired, carrying, gains, priority)
        try:
            feet = self._foot_forces(dynamics, balance, carrying, gains)
            program = self._acceleration_program(reference.stance)
            acceleration = program.solve(dynamics, feet, reference, _weights(gains))
        except SolverError as error:
            return self._fallback(dynamics, reference, desired, str(error))
        torque = self._inverse_dynamics(dynamics, acceleration, feet.wrench, carrying)
        torque += _feedback(dynamics, memory, gains)
        return ControlOutput(
            torque=torque,
            acceleration=acceleration,
            momentum_rate_desired=desired,
            momentum_rate_admissible=feet.momentum_rate,
            foot_wrench_admissible=feet.wrench,
            cop_desired=balance.cop_desired,
            cop_admissible=self._cop(dynamics, carrying, feet),
            failure=None,
            memory=self._joint_command(dynamics, acceleration, memory),
        )

    def _desired_rate(
        self, dynamics: Dynamics, reference: Reference, gains: ComputedTorqueGains
    ) -> np.ndarray:
        """[dl_d; dk_d] of Eqs. 37 and 38 (6,), N and N m."""
        linear = desired_linear_rate(
            self.robot.mass, dynamics, reference, gains.linear_damping, gains.linear_stiffness
        )
        angular = desired_angular_rate(dynamics, reference, gains.angular_damping, gains.pelvis_stiffness)
        return np.concatenate([linear, angular])

    def _balance(
        self,
        dynamics: Dynamics,
        desired: np.ndarray,
        stance: tuple[int, ...],
        gains: ComputedTorqueGains,
        priority: float,
    ) -> Compromise:
        """The net force and angular rate to ask the ground for (section 5.1.2)."""
        polygon = self.footing.safe_polygon(dynamics, stance, gains.safe_border)
        height = float(dynamics.sole_position[list(stance), 2].mean())
        return compromise(
            desired, dynamics.com_in_world, self.robot.mass, polygon, height, gains.friction, priority
        )

    def _foot_forces(
        self, dynamics: Dynamics, balance: Compromise, stance: tuple[int, ...], gains: ComputedTorqueGains
    ) -> FootForces:
        """Step 1: admissible wrenches of the feet."""
        bounds = ForceBounds(
            friction=gains.friction,
            normal_moment=_YAW_LEVER * gains.friction,
            least_force=gains.least_foot_force * self.robot.mass * GRAVITY,
        )
        feet = self.footing.stance_feet(dynamics, stance, gains.safe_border)
        return self.footing.share(feet, balance.force, balance.angular_rate, bounds)

    def _cop(self, dynamics: Dynamics, stance: tuple[int, ...], feet: FootForces) -> np.ndarray:
        """CoP of the admissible wrenches (2,), m (Eq. 21)."""
        height = float(dynamics.sole_position[list(stance), 2].mean())
        return cop_from_momentum_rate(feet.momentum_rate, dynamics.com_in_world, self.robot.mass, height)

    def _acceleration_program(self, stance: tuple[int, ...]) -> AccelerationProgram:
        """Step 2 for the feet that carry."""
        if stance not in self._programs:
            self._programs[stance] = AccelerationProgram(self.robot, stance)
        return self._programs[stance]

    def _inverse_dynamics(
        self, dynamics: Dynamics, acceleration: np.ndarray, wrench: np.ndarray, stance: tuple[int, ...]
    ) -> np.ndarray:
        """Step 3: joint torques (na,), tau_s = H_s a + C_s v + tau_g,s - J_c,s^T f_c (Eq. 33)."""
        torque = dynamics.mass_matrix[6:] @ acceleration + dynamics.nonlinear_effects[6:]
        for foot in stance:
            torque -= wrench[foot] @ dynamics.sole_jacobian[foot, :, 6:]
        return torque

    def _joint_command(
        self, dynamics: Dynamics, acceleration: np.ndarray, memory: JointCommand
    ) -> JointCommand:
        """Integrate accelerations to theta* and its rate, slowly forgetting what did not come true."""
        dt, forget = self.timestep, self.timestep / _FORGETTING_TIME
        state = dynamics.state
        rate = memory.rate + dt * acceleration[6:] + forget * (state.v[6:] - memory.rate)
        angle = memory.angle + dt * rate + forget * (state.q[7:] - memory.angle)
        return JointCommand(angle, rate)

    def _fallback(
        self, dynamics: Dynamics, reference: Reference, desired: np.ndarray, reason: str
    ) -> ControlOutput:
        """The posture held by joint springs, and why; nothing is asked of the ground."""
        nothing = without_ground(self.robot, dynamics, self.initial_memory(dynamics))
        return replace(
            nothing,
            torque=hold_posture(self.robot, dynamics, reference.posture),
            momentum_rate_desired=desired,
            failure=f"{reason}; {HOLD_IN_WORDS}",
        )


def _weights(gains: ComputedTorqueGains) -> MotionWeights:
    return MotionWeights(
        momentum=gains.momentum_weight,
        pelvis=gains.pelvis_weight,
        stiffness=gains.posture_stiffness,
        damping=gains.posture_damping,
        contact_rate=gains.contact_damping,
        joint_limit_rate=gains.joint_limit_rate,
    )


def _feedback(dynamics: Dynamics, command: JointCommand, gains: ComputedTorqueGains) -> np.ndarray:
    """tau_fb = Gamma_p (theta* - theta) + Gamma_d (theta*' - theta') (na,), N m (Eqs. 35, 36)."""
    state = dynamics.state
    return gains.feedback_stiffness * (command.angle - state.q[7:]) + gains.feedback_damping * (
        command.rate - state.v[6:]
    )
