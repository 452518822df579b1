"""Eq. 25 on PlaCo's kinematics solver: feet as told, then the momentum, then a reference, within joint limits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from momentum_lab.control.placo_body import follow, placo_body
from momentum_lab.errors import SolverError
from momentum_lab.momentum.directions import Directions, axes
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import State

# The reference against the momentum, 1/kg^2 for m/s and likewise for rad/s: what it costs the momentum is of
# this size too. PlaCo's own pull towards zero motion is kept far below.
_REFERENCE_WEIGHT = 1e-5
_RIDGE = 1e-12
# A joint comes to a limit no faster than with this time constant, s.
_ARRIVAL = 0.05


@dataclass(frozen=True, slots=True)
class MomentumGoal:
    """What the joint rates shall do.

    Attributes:
        momentum: h_d = [l_d; k_d] about the CoM (6,), N s and N m s.
        controlled: which of its directions are asked for.
        reference: rates to stay near where feet and momentum leave a choice (nv,), m/s and rad/s.
    """

    momentum: np.ndarray
    controlled: Directions
    reference: np.ndarray


class PlacoRates:
    """Eq. 25 for one robot on some of its feet.

    PlaCo's unknown is one step of the configuration, v dt. Its centroidal momentum task knows angular momentum
    only; linear momentum is asked for as the CoM's step l_d dt / m. Both are weighed so that the sum of squares
    is |S (h_d - A_G v)|^2 dt^2.

    Args:
        robot: the robot.
        stance: the feet whose poses are kept, as indices.
        timestep: dt, s.
    """

    def __init__(self, robot: RobotModel, stance: tuple[int, ...], timestep: float) -> None:
        self.robot = robot
        self.stance = stance
        self.timestep = timestep
        self._body = placo_body(robot)
        model = self._body.model
        self._limits = model.lowerPositionLimit.copy(), model.upperPositionLimit.copy()
        self._solver = solver = self._body.make_solver()
        solver.dt = timestep
        solver.problem.regularization = _RIDGE
        solver.enable_joint_limits(True)
        solver.enable_velocity_limits(True)
        here = np.eye(4)
        self._feet = [solver.add_frame_task(robot.spec.feet[robot.soles[i].name].frame, here) for i in stance]
        for foot, task in zip(stance, self._feet, strict=True):
            task.configure(robot.soles[foot].name, "hard")
        self._com = solver.add_com_task(np.zeros(3))
        self._com.configure("linear momentum", "soft", robot.mass**2)
        self._angular = solver.add_centroidal_momentum_task(np.zeros(3))
        self._angular.configure("angular momentum", "soft", timestep**2)
        self._pelvis = solver.add_frame_task(robot.spec.pelvis, here)
        self._pelvis.configure("pelvis", "soft", _REFERENCE_WEIGHT, _REFERENCE_WEIGHT)
        self._joints = solver.add_joints_task()
        self._joints.configure("joints", "soft", _REFERENCE_WEIGHT)

    def solve(self, q: np.ndarray, footholds: np.ndarray, goal: MomentumGoal) -> np.ndarray:
        """The rates that bring the feet to their footholds within one step and obey the goal (Eqs. 24, 25).

        The answer depends on the arguments alone: PlaCo's state is set from them.

        Args:
            q: configuration (nq,), m and rad.
            footholds: where the stance feet shall be (S, 4, 4), m.
            goal: momentum and reference.

        Returns:
            v (nv,), m/s and rad/s.

        Raises:
            SolverError: the feet cannot be where they shall be within the limits of the joints.
        """
        dt = self.timestep
        self._slow_down_before_limits(q[7:])
        follow(self._body, State(q, np.zeros(self.robot.nv)))
        for task, foothold in zip(self._feet, footholds, strict=True):
            task.T_world_frame = foothold
        linear_axes, angular_axes = axes(goal.controlled)
        self._com.mask.set_axises(linear_axes, "task")
        self._com.target_world = self._body.com_world() + goal.momentum[:3] * (dt / self.robot.mass)
        self._angular.mask.set_axises(angular_axes, "task")
        self._angular.L_world = goal.momentum[3:]
        self._refer_to(q, goal.reference)
        try:
            return self._solver.solve(False) / dt
        except RuntimeError as error:
            raise SolverError(f"PlaCo finds no joint rates: {error}") from error

    def _slow_down_before_limits(self, angle: np.ndarray) -> None:
        """Let no joint (na,) cover more of its way to a limit in this step than dt / T: it arrives without a blow."""
        model, share = self._body.model, self.timestep / _ARRIVAL
        lower, upper = self._limits
        above, below = np.maximum(upper[7:] - angle, 0.0), np.maximum(angle - lower[7:], 0.0)
        low, high = lower.copy(), upper.copy()
        high[7:] = np.minimum(upper[7:], angle + share * above)
        low[7:] = np.maximum(lower[7:], angle - share * below)
        model.lowerPositionLimit, model.upperPositionLimit = low, high

    def _refer_to(self, q: np.ndarray, reference: np.ndarray) -> None:
        """Pelvis and joints one step along the reference rates."""
        dt = self.timestep
        base = self._body.get_T_world_fbase()
        moved = base @ pin.exp6(reference[:6] * dt).homogeneous
        self._pelvis.T_world_frame = (
            moved @ np.linalg.inv(base) @ self._body.get_T_world_frame(self.robot.spec.pelvis)
        )
        angles = (q[7:] + reference[6:] * dt).tolist()
        self._joints.set_joints(dict(zip(self.robot.joint_names, angles, strict=True)))
