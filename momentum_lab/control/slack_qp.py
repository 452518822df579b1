"""Output tasks under CoP bounds, with slacks that say what has to wait (the chapter's section 5.2)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from momentum_lab.control import common_gains
from momentum_lab.control.controller import ControlOutput, Reference
from momentum_lab.control.fallback import NO_FOOT, hold
from momentum_lab.control.footing import Footing
from momentum_lab.control.gains import gain
from momentum_lab.control.outputs import (
    LiftedSoles,
    Output,
    Spring,
    com_output,
    least_squares,
    lightened,
    pelvis_output,
    posture_output,
    sole_output,
)
from momentum_lab.control.qp import solve
from momentum_lab.control.stance_motion import Affine, StanceMotion, stance_motion
from momentum_lab.control.stance_output import stance_output
from momentum_lab.control.stance_program import StanceBounds, StanceProgram
from momentum_lab.errors import SolverError
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics

# Keeps accelerations unique where no output decides, and the sharing of the weight between two feet.
_RIDGE = 1e-4
_EVEN_SHARE_WEIGHT = 1e-1


@dataclass(frozen=True, slots=True)
class SlackGains:
    """Gains of the controller with slacks."""

    com_stiffness: float = gain(
        16.0, "1/s^2", 0.0, 200.0, "Gamma_p of the CoM: how strongly it is pulled over the feet (Eq. 42)."
    )
    com_damping: float = gain(
        8.0, "1/s", 0.0, 60.0, "Gamma_d of the CoM: how strongly its velocity is braked (Eq. 42)."
    )
    body_stiffness: float = gain(
        16.0, "1/s^2", 0.0, 400.0, "Gamma_p of pelvis, swing foot and posture (Eq. 42)."
    )
    body_damping: float = gain(8.0, "1/s", 0.0, 60.0, "Gamma_d of pelvis, swing foot and posture (Eq. 42).")
    com_weight: float = gain(
        1e4,
        "1",
        1.0,
        1e6,
        "W of the CoM's slack (Eq. 62); the priority slider exchanges it with the others'.",
    )
    swing_weight: float = gain(10.0, "1", 0.0, 1e3, "W of the swing foot's slack (Eq. 62).")
    pelvis_weight: float = gain(10.0, "1", 0.0, 1e3, "W of the pelvis orientation's slack (Eq. 62).")
    posture_weight: float = gain(1.0, "1", 0.0, 1e3, "W of the upper body's slack (Eq. 62).")
    contact_damping: float = common_gains.contact_damping()
    safe_border: float = common_gains.safe_border()
    friction: float = common_gains.friction()
    least_foot_force: float = common_gains.least_foot_force()
    joint_limit_rate: float = common_gains.joint_limit_rate()


class SlackQP:
    """One quadratic program in joint accelerations: least slack under all bounds (Eqs. 42 to 62).

    Args:
        robot: the robot.
        timestep: time between two calls, s; unused, the law has no memory.
    """

    def __init__(self, robot: RobotModel, timestep: float) -> None:
        self.robot = robot
        self.footing = Footing(robot)
        self._lifted = LiftedSoles(robot)
        self._programs: dict[tuple[tuple[int, ...], tuple[int, ...]], StanceProgram] = {}

    def initial_memory(self, dynamics: Dynamics) -> None:
        """Nothing: the torques follow from the state."""
        return None

    def compute(
        self,
        dynamics: Dynamics,
        reference: Reference,
        gains: SlackGains,
        priority: float,
        memory: None,
    ) -> ControlOutput:
        """Torques for one tick; see `Controller.compute`.

        min sum W_k |y''_d,k - J_k a - Psi_k|^2 (Eq. 62 with the slack of Eq. 61 put in) subject to Eq. 47, the
        CoP bounds of Eq. 52 per foot, friction, f_z >= f_min, and limits of joints and torques. Priority 0
        takes the weights as they are; priority 1 exchanges the CoM's weight with that of everything else;
        between them it goes evenly on a logarithmic scale. Of the directions of momentum only the linear ones
        are outputs here (section 5.2 has no angular goal): the CoM is left free along those not asked for.
        """
        carrying = self.footing.on_the_ground(dynamics, reference.stance, reference.ground)
        if not carrying:
            return hold(self.robot, dynamics, reference, NO_FOOT, memory)
        outputs = self._outputs(dynamics, reference, gains, priority)
        motion = stance_motion(dynamics, reference, carrying, gains.contact_damping)
        program = self._program(reference.stance, carrying)
        uneven = program.centered(dynamics, motion.wrench)
        hessian, gradient = self._objective(outputs, motion, uneven)
        problem = program.problem(hessian, gradient, dynamics, motion, uneven, _bounds(gains))
        try:
            x = solve(problem).x
        except SolverError as error:
            return hold(self.robot, dynamics, reference, str(error), memory)
        acceleration = motion.acceleration.at(x)
        return stance_output(
            self.robot,
            dynamics,
            motion,
            x,
            carrying,
            desired=self._momentum_rate(dynamics, motion, unbounded(hessian, gradient, motion)),
            slack=_named_slack(outputs, acceleration),
        )

    def _outputs(
        self, dynamics: Dynamics, reference: Reference, gains: SlackGains, priority: float
    ) -> list[Output]:
        """The outputs of section 5.2 with their set-points and weights."""
        exchanged = gains.com_weight**priority
        body = Spring(gains.body_stiffness, gains.body_damping)
        com = Spring(gains.com_stiffness, gains.com_damping)
        outputs = [
            com_output(self.robot.mass, dynamics, reference, com, gains.com_weight / exchanged),
            pelvis_output(dynamics, reference, body, gains.pelvis_weight * exchanged),
        ]
        for foot in range(len(self.robot.soles)):
            if foot not in reference.stance:
                goal = self._lifted.goal(dynamics, reference.posture, foot, reference.stance[0])
                outputs.append(sole_output(dynamics, foot, goal, body, gains.swing_weight * exchanged))
        upper = self.robot.upper_body
        return [*outputs, posture_output(dynamics, reference, upper, body, gains.posture_weight * exchanged)]

    def _objective(
        self, outputs: list[Output], motion: StanceMotion, uneven: Affine
    ) -> tuple[np.ndarray, np.ndarray]:
        """Slacks (Eq. 62), and what is small enough to decide only where they do not."""
        hessian, gradient = least_squares(outputs, motion.acceleration)
        joints = np.arange(self.robot.na)
        hessian[joints, joints] += _RIDGE
        if uneven.offset.size > 6:
            hessian += _EVEN_SHARE_WEIGHT * (uneven.matrix.T @ uneven.matrix)
            gradient += _EVEN_SHARE_WEIGHT * (uneven.offset @ uneven.matrix)
        return lightened(hessian, gradient, outputs)

    def _momentum_rate(self, dynamics: Dynamics, motion: StanceMotion, x: np.ndarray) -> np.ndarray:
        """Momentum rate of x (6,), N and N m (Eq. 20)."""
        return dynamics.centroidal_map @ motion.acceleration.at(x) + dynamics.centroidal_bias

    def _program(self, stance: tuple[int, ...], carrying: tuple[int, ...]) -> StanceProgram:
        if (stance, carrying) not in self._programs:
            self._programs[stance, carrying] = StanceProgram(self.robot, stance, carrying)
        return self._programs[stance, carrying]


def unbounded(hessian: np.ndarray, gradient: np.ndarray, motion: StanceMotion) -> np.ndarray:
    """The minimiser (n,) with the feet still and no other bound: what is asked of a ground that gives all."""
    still = motion.still
    count, size = still.matrix.shape
    system = np.zeros((size + count, size + count))
    system[:size, :size] = hessian
    system[size:, :size], system[:size, size:] = still.matrix, still.matrix.T
    return np.linalg.solve(system, np.concatenate([-gradient, -still.offset]))[:size]


def _bounds(gains: SlackGains) -> StanceBounds:
    return StanceBounds(
        border=gains.safe_border,
        friction=gains.friction,
        least_force=gains.least_foot_force,
        joint_limit_rate=gains.joint_limit_rate,
    )


def _named_slack(outputs: list[Output], acceleration: np.ndarray) -> dict[str, float]:
    """Slacks by name: per axis where the output's parts have names, their length for a posture."""
    named: dict[str, float] = {}
    for output in outputs:
        slack = output.slack(acceleration)
        if output.parts:
            values = zip(output.parts, slack.tolist(), strict=True)
            named |= {f"{output.name} {part}": value for part, value in values}
        else:
            named[output.name] = float(np.linalg.norm(slack))
    return named
