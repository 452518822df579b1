"""Momentum-based computed torque control (the chapter's sections 4.2 and 5.1)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from momentum_lab.compiled import compiled
from momentum_lab.control.accelerations import AccelerationProgram, MotionWeights
from momentum_lab.control.computed_torque_gains import ComputedTorqueGains
from momentum_lab.control.controller import ControlOutput, Reference
from momentum_lab.control.desired import desired_momentum_rate
from momentum_lab.control.fallback import NO_FOOT, hold_posture, in_words, without_ground
from momentum_lab.control.foot_forces import FootForces, ForceBounds, LoadSharing
from momentum_lab.control.footing import Footing, StanceFeet
from momentum_lab.control.planner import OWN, PLANNERS, Support
from momentum_lab.control.priority import Compromise
from momentum_lab.control.turning_back import balanced
from momentum_lab.errors import SolverError
from momentum_lab.momentum.directions import ALL
from momentum_lab.momentum.ground import GRAVITY, cop_from_momentum_rate
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics

# A sole of a few centimetres turns on its own friction with about this lever, m.
YAW_LEVER = 0.03
# Eq. 36 integrates accelerations; what did not come true is forgotten with this time constant, s.
_FORGETTING_TIME = 0.05


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
        self._sharing = LoadSharing(robot)
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
        """Torques for one tick (Fig. 6); see `Controller.compute`.

        In directions of momentum that are not asked for (section 5.3.1), what posture and pelvis would bring
        about takes the place of the desired rate; from there on they are treated like all others, so that foot
        forces, bounds and torques stay consistent.
        """
        desired = self._desired_rate(dynamics, reference, gains)
        carrying = self.footing.on_the_ground(dynamics, reference.stance, reference.ground)
        if not carrying:
            return self._fallback(dynamics, reference, desired, NO_FOOT)
        stance = self.footing.stance_feet(dynamics, carrying, gains.safe_border)
        if reference.planner != OWN:
            support = Support(self.robot.mass, stance.safe_polygon, stance.height)
            desired = PLANNERS[reference.planner].plan(desired, dynamics, reference, support)
        program, weights = self._acceleration_program(reference.stance), _weights(gains)
        if reference.controlled != ALL:
            desired = program.rate_with_free_directions(dynamics, desired, reference, weights)
        balance = balanced(self.robot.mass, dynamics, desired, reference, stance, gains, priority)
        try:
            feet = self._foot_forces(stance, balance, gains)
            acceleration = program.solve(dynamics, feet, reference, weights)
        except SolverError as error:
            return self._fallback(dynamics, reference, desired, str(error))
        torque = inverse_dynamics(
            dynamics.mass_matrix,
            dynamics.nonlinear_effects,
            dynamics.sole_jacobian,
            acceleration,
            feet.wrench,
        )
        if gains.feedback_stiffness or gains.feedback_damping:
            torque += joint_feedback(dynamics, memory, gains)
        return ControlOutput(
            torque=torque,
            acceleration=acceleration,
            momentum_rate_desired=desired,
            momentum_rate_admissible=feet.momentum_rate,
            foot_wrench_admissible=feet.wrench,
            cop_desired=balance.cop_desired,
            cop_admissible=self._cop(dynamics, stance, feet),
            failure=None,
            memory=self._joint_command(dynamics, acceleration, memory),
        )

    def _desired_rate(
        self, dynamics: Dynamics, reference: Reference, gains: ComputedTorqueGains
    ) -> np.ndarray:
        """[dl_d; dk_d] of Eqs. 37 and 38 (6,), N and N m, with the rate of a k_d that moves."""
        rate = desired_momentum_rate(
            self.robot.mass,
            dynamics,
            reference,
            gains.linear_damping,
            gains.linear_stiffness,
            gains.angular_damping,
            gains.pelvis_stiffness,
        )
        if reference.angular_momentum_rate is not None:
            rate[3:] += reference.angular_momentum_rate
        return rate

    def _foot_forces(self, stance: StanceFeet, balance: Compromise, gains: ComputedTorqueGains) -> FootForces:
        """Step 1: admissible wrenches of the feet."""
        bounds = ForceBounds(
            friction=gains.friction,
            normal_moment=YAW_LEVER * gains.friction,
            least_force=gains.least_foot_force * self.robot.mass * GRAVITY,
        )
        return self._sharing.share(stance, balance.force, balance.angular_rate, bounds)

    def _cop(self, dynamics: Dynamics, stance: StanceFeet, feet: FootForces) -> np.ndarray:
        """CoP of the admissible wrenches (2,), m (Eq. 21)."""
        return cop_from_momentum_rate(
            feet.momentum_rate, dynamics.com_in_world, self.robot.mass, stance.height
        )

    def _acceleration_program(self, stance: tuple[int, ...]) -> AccelerationProgram:
        """Step 2 for the feet that carry."""
        if stance not in self._programs:
            self._programs[stance] = AccelerationProgram(self.robot, stance)
        return self._programs[stance]

    def _joint_command(
        self, dynamics: Dynamics, acceleration: np.ndarray, memory: JointCommand
    ) -> JointCommand:
        """Integrate accelerations to theta* and its rate, slowly forgetting what did not come true."""
        state = dynamics.state
        angle, rate = integrated(
            memory.angle,
            memory.rate,
            acceleration,
            state.q,
            state.v,
            self.timestep,
            self.timestep / _FORGETTING_TIME,
        )
        return JointCommand(angle, rate)

    def _fallback(
        self, dynamics: Dynamics, reference: Reference, desired: np.ndarray, reason: str
    ) -> ControlOutput:
        """The posture held by joint springs, and why; nothing is asked of the ground."""
        nothing = without_ground(self.robot, dynamics, self.initial_memory(dynamics))
        return replace(
            nothing,
            torque=hold_posture(self.robot, dynamics, reference),
            momentum_rate_desired=desired,
            failure=in_words(reference, reason),
        )


@compiled("f8[::1](f8[:, ::1], f8[::1], f8[:, :, ::1], f8[::1], f8[:, ::1])")
def inverse_dynamics(
    mass_matrix: np.ndarray,
    nonlinear_effects: np.ndarray,
    sole_jacobian: np.ndarray,
    acceleration: np.ndarray,
    wrench: np.ndarray,
) -> np.ndarray:
    """Step 3: joint torques (na,), tau_s = H_s a + C_s v + tau_g,s - J_c,s^T f_c, N m (Eq. 33).

    Args:
        mass_matrix: H (nv, nv).
        nonlinear_effects: C v + tau_g (nv,), N m.
        sole_jacobian: J_c of all soles (F, 6, nv).
        acceleration: a (nv,).
        wrench: f_c on all soles about their origins, zero for feet that do not carry (F, 6), N and N m.
    """
    torque = mass_matrix[6:] @ acceleration + nonlinear_effects[6:]
    for foot in range(len(wrench)):
        torque -= wrench[foot] @ sole_jacobian[foot][:, 6:].copy()
    return torque


@compiled("UniTuple(f8[::1], 2)(f8[::1], f8[::1], f8[::1], f8[::1], f8[::1], f8, f8)")
def integrated(
    angle: np.ndarray,
    rate: np.ndarray,
    acceleration: np.ndarray,
    q: np.ndarray,
    v: np.ndarray,
    timestep: float,
    forget: float,
) -> tuple[np.ndarray, np.ndarray]:
    """theta* and its rate (na,) a step later, slowly forgetting what did not come true (Eq. 36).

    Args:
        angle: theta* (na,), rad.
        rate: its time derivative (na,), rad/s.
        acceleration: a (nv,).
        q: the robot's configuration (nq,).
        v: its velocity (nv,).
        timestep: dt, s.
        forget: the part of the difference to the robot that is forgotten.
    """
    new_rate = rate + timestep * acceleration[6:] + forget * (v[6:] - rate)
    return angle + timestep * new_rate + forget * (q[7:] - angle), new_rate


def _weights(gains: ComputedTorqueGains) -> MotionWeights:
    return MotionWeights(
        momentum=gains.momentum_weight,
        pelvis=gains.pelvis_weight,
        stiffness=gains.posture_stiffness,
        damping=gains.posture_damping,
        contact_rate=gains.contact_damping,
        joint_limit_rate=gains.joint_limit_rate,
    )


def joint_feedback(dynamics: Dynamics, command: JointCommand, gains: ComputedTorqueGains) -> np.ndarray:
    """What is added to the computed torque where joints do not follow their command.

    tau_fb = Gamma_p (theta* - theta) + Gamma_d (theta*' - theta') (Eq. 36), in tau_s = tau_ff + tau_fb (Eq. 35).

    Args:
        dynamics: the state with everything computed.
        command: theta* and its rate.
        gains: hold Gamma_p and Gamma_d.

    Returns:
        tau_fb (na,), N m.
    """
    state = dynamics.state
    return gains.feedback_stiffness * (command.angle - state.q[7:]) + gains.feedback_damping * (
        command.rate - state.v[6:]
    )
