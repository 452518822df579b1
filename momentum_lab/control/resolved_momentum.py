"""Resolved momentum control (the chapter's section 4.1): momentum to joint rates, joint rates to joint servos."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pinocchio as pin

from momentum_lab.control.controller import ControlOutput, Reference
from momentum_lab.control.fallback import NO_FOOT, hold_posture, in_words, without_ground
from momentum_lab.control.footing import Footing
from momentum_lab.control.gains import gain
from momentum_lab.control.held_feet import holding_torque, motion_of_held_feet, weight_on_feet
from momentum_lab.control.placo_rates import MomentumGoal, PlacoRates
from momentum_lab.errors import SolverError
from momentum_lab.momentum.centroidal import momentum_rate
from momentum_lab.momentum.foot_ground import FootGround, velocity_at
from momentum_lab.momentum.ground import cop_from_momentum_rate
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics


@dataclass(frozen=True, slots=True)
class ResolvedMomentumGains:
    """Gains of the resolved momentum controller and of the joint servos under it."""

    com_rate: float = gain(
        20.0, "1/s", 0.0, 40.0, "kappa: how fast the CoM of the set-point goes where it should be."
    )
    com_lead: float = gain(
        0.3, "s", 0.0, 0.4, "How far the set-point leans against the motion of the real CoM, per speed."
    )
    pelvis_rate: float = gain(
        2.0, "1/s", 0.0, 6.0, "How fast the pelvis of the set-point turns upright; an extension."
    )
    posture_rate: float = gain(
        2.0,
        "1/s",
        0.0,
        10.0,
        "How fast the joints return to their posture where feet and momentum leave a choice.",
    )
    servo_stiffness: float = gain(
        12.0,
        "1/rad",
        1.0,
        60.0,
        "Stiffness of the joint servos, as a part of each joint's torque limit.",
    )
    servo_damping: float = gain(
        0.06, "s", 0.0, 0.3, "Damping of the joint servos, as a part of their stiffness."
    )
    weight_compensation: float = gain(
        1.0,
        "1",
        0.0,
        1.0,
        "Part of gravity, shared among the feet on the ground, that the servos need not carry.",
    )


@dataclass(frozen=True, slots=True)
class SetPoint:
    """The robot as it should be: what the joint rates have been integrated to.

    Attributes:
        q: configuration (nq,), m and rad.
        v: its rate (nv,), m/s and rad/s.
        footholds: where its soles stand, for all feet (F, 4, 4), m.
    """

    q: np.ndarray
    v: np.ndarray
    footholds: np.ndarray


class ResolvedMomentum:
    """A momentum for the body, rates for the joints (Eq. 25), servos that follow them.

    The desired momentum comes from where the CoM and the pelvis really are; the rates are those of a body of the
    mind, the set-point, that stands still on its footholds. Nobody looks at the CoP: the servos ask of the
    ground whatever they need.

    Args:
        robot: the robot.
        timestep: time between two calls, s.
    """

    def __init__(self, robot: RobotModel, timestep: float) -> None:
        self.robot = robot
        self.timestep = timestep
        self.footing = Footing(robot)
        self._data = robot.model.createData()
        self._rates: dict[tuple[int, ...], PlacoRates] = {}

    def initial_memory(self, dynamics: Dynamics) -> SetPoint:
        """The robot as it is, joints within their limits, at rest."""
        q = dynamics.state.q.copy()
        q[7:] = np.clip(q[7:], self.robot.position_lower, self.robot.position_upper)
        footholds = np.tile(np.eye(4), (len(self.robot.soles), 1, 1))
        footholds[:, :3, :3] = dynamics.sole_rotation
        footholds[:, :3, 3] = dynamics.sole_position
        return SetPoint(q, np.zeros(self.robot.nv), footholds)

    def compute(
        self,
        dynamics: Dynamics,
        reference: Reference,
        gains: ResolvedMomentumGains,
        priority: float,
        memory: SetPoint,
    ) -> ControlOutput:
        """Torques for one tick; see `Controller.compute`. There is no priority: both momenta are asked for.

        The momentum rate, desired and admissible alike, is the one that the torques would cause if the ground
        held the feet like glue, and so are the foot wrenches and the CoP: they may well be impossible.
        """
        carrying = self.footing.on_the_ground(dynamics, reference.stance, reference.ground)
        if not carrying:
            return self._fallback(dynamics, reference, memory, NO_FOOT)
        try:
            command = self._next_set_point(dynamics, reference, gains, memory)
        except SolverError as error:
            return self._fallback(dynamics, reference, memory, str(error))
        torque = self._servo_torque(dynamics, command, gains)
        torque += gains.weight_compensation * holding_torque(
            dynamics, weight_on_feet(self.robot, dynamics, carrying)
        )
        torque = np.clip(torque, -self.robot.effort_limit, self.robot.effort_limit)
        acceleration, wrench = motion_of_held_feet(dynamics, torque, carrying, reference.ground)
        rate = momentum_rate(dynamics, acceleration)
        height = float(dynamics.sole_position[list(carrying), 2].mean())
        cop = cop_from_momentum_rate(rate, dynamics.com_in_world, self.robot.mass, height)
        return ControlOutput(
            torque=torque,
            acceleration=acceleration,
            momentum_rate_desired=rate,
            momentum_rate_admissible=rate,
            foot_wrench_admissible=wrench,
            cop_desired=cop,
            cop_admissible=cop,
            failure=None,
            memory=command,
        )

    def desired_momentum(
        self, dynamics: Dynamics, reference: Reference, gains: ResolvedMomentumGains, q: np.ndarray
    ) -> np.ndarray:
        """h_d = [l_d; k_d] about the CoM of a set-point q (6,), N s and N m s.

        l_d = m [dr_d + kappa (r_d - T (dr - dr_d) - r*)], with r the real CoM, r* that of the set-point, and the
        lead T in x and y only: vertically it would meet both closed chains of the legs and, on G1, put a pole of
        the sampled loop at -0.95, that is torques that alternate from tick to tick.
        k_d the reference's, and rate I_G e_R to turn the pelvis of the set-point upright.
        """
        model, data = self.robot.model, self._data
        com = pin.centerOfMass(model, data, q)
        pelvis = pin.updateFramePlacement(model, data, self.robot.pelvis).rotation
        lead = gains.com_lead * (dynamics.com_velocity - reference.com_velocity)
        lead[2] = 0.0
        ahead = reference.com - lead
        linear = reference.com_velocity + gains.com_rate * (ahead - com)
        tilt = pin.log3(reference.pelvis_rotation @ pelvis.T)
        angular = reference.angular_momentum + gains.pelvis_rate * (dynamics.locked_inertia @ tilt)
        return np.concatenate([self.robot.mass * linear, angular])

    def _next_set_point(
        self, dynamics: Dynamics, reference: Reference, gains: ResolvedMomentumGains, memory: SetPoint
    ) -> SetPoint:
        """The set-point one step further along the rates of Eq. 25."""
        stay = np.zeros(self.robot.nv)
        stay[6:] = gains.posture_rate * (reference.posture - memory.q[7:])
        if reference.posture_rate is not None:
            stay[6:] += reference.posture_rate
        goal = MomentumGoal(
            self.desired_momentum(dynamics, reference, gains, memory.q), reference.controlled, stay
        )
        if reference.stance not in self._rates:
            self._rates[reference.stance] = PlacoRates(self.robot, reference.stance, self.timestep)
        footholds = carried_footholds(memory.footholds, reference.ground, self.timestep)
        rates = self._rates[reference.stance].solve(memory.q, footholds[list(reference.stance)], goal)
        q = self.robot.integrate(memory.q, rates * self.timestep)
        return replace(memory, q=q, v=rates, footholds=footholds)

    def _servo_torque(
        self, dynamics: Dynamics, command: SetPoint, gains: ResolvedMomentumGains
    ) -> np.ndarray:
        """Tau = k [(theta* - theta) + T (theta*' - theta')] (na,), N m, as at the end of the tick.

        A drive is faster than a tick: its torque is the one of k and T once the joints have moved on under that
        torque, (H + S^T D S) a = S^T tau_0 and tau = tau_0 - D S a with D = k (T dt + dt^2). They are taken to
        move as on a robot in the air; a foot on the ground only holds them.
        """
        dt, state = self.timestep, dynamics.state
        stiffness = gains.servo_stiffness * self.robot.effort_limit
        ahead = gains.servo_damping + dt
        behind = command.q[7:] - state.q[7:] + gains.servo_damping * command.v[6:] - ahead * state.v[6:]
        torque, yielding = np.zeros(self.robot.nv), np.zeros(self.robot.nv)
        torque[6:], yielding[6:] = stiffness * behind, stiffness * ahead * dt
        moved = np.linalg.solve(dynamics.mass_matrix + np.diag(yielding), torque)
        return (torque - yielding * moved)[6:]

    def _fallback(
        self, dynamics: Dynamics, reference: Reference, memory: SetPoint, reason: str
    ) -> ControlOutput:
        """The posture held by joint springs, and why; the set-point waits."""
        nothing = without_ground(self.robot, dynamics, memory)
        return replace(
            nothing,
            torque=hold_posture(self.robot, dynamics, reference),
            failure=in_words(reference, reason),
        )


def carried_footholds(footholds: np.ndarray, ground: FootGround, timestep: float) -> np.ndarray:
    """Footholds one step later on plates that move: the v_c of Eq. 24 (F, 4, 4), m; the same while all are still.

    Args:
        footholds: poses of the soles (F, 4, 4), m.
        ground: the plates under the feet.
        timestep: s.
    """
    if not ground.velocity.any():
        return footholds
    carried = footholds.copy()
    for foot, pose in enumerate(footholds):
        velocity = velocity_at(
            np.ascontiguousarray(pose[:3, 3]), ground.position[foot], ground.velocity[foot]
        )
        carried[foot, :3, 3] += timestep * velocity[:3]
        carried[foot, :3, :3] = pin.exp3(timestep * velocity[3:]) @ pose[:3, :3]
    return carried
