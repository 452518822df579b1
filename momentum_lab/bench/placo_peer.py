"""PlaCo's whole-body controller on the same robot, for comparison; it takes no part in the lab's own physics."""

from __future__ import annotations

import numpy as np
import placo

from momentum_lab.robot.model import RobotModel, Sole
from momentum_lab.robot.posture import _bare_urdf
from momentum_lab.robot.state import State

_FRICTION = 0.6
_POSTURE_WEIGHT = 1e-2
# PlaCo's default cost on torques drags its CoM task away by up to 0.5 m/s^2 on TALOS.
_TORQUE_COST = 1e-9


class PlacoPeer:
    """A standing robot in PlaCo: planar contacts of both soles, a CoM task and a soft posture.

    PlaCo centres a contact on its frame; its rectangle is the largest such one within the sole.

    Args:
        robot: the robot.
        home: the standing state, which is what it shall keep.
        timestep: s.
    """

    def __init__(self, robot: RobotModel, home: State, timestep: float) -> None:
        self.robot = robot
        self.body = placo.RobotWrapper(str(robot.urdf), placo.Flags.ignore_collisions, _bare_urdf(robot))
        self.solver = placo.DynamicsSolver(self.body)
        self.solver.dt = timestep
        self.solver.torque_cost = _TORQUE_COST
        self.follow(home)
        self.contacts = [self._contact(sole) for sole in robot.soles]
        self.solver.add_com_task(self.body.com_world()).configure("com", "soft", 1.0)
        posture = self.solver.add_joints_task()
        angles = zip(robot.joint_names, home.q[7:].tolist(), strict=True)
        posture.set_joints(dict(angles))
        posture.configure("posture", "soft", _POSTURE_WEIGHT)

    def follow(self, state: State) -> None:
        """Put PlaCo's robot into a state."""
        self.body.state.q, self.body.state.qd = state.q, state.v
        self.body.update_kinematics()

    def solve(self) -> np.ndarray:
        """Joint torques (na,), N m: one call of DynamicsSolver.solve(); NaN if it fails."""
        result = self.solver.solve()
        return result.tau[6:] if result.success else np.full(self.robot.na, np.nan)

    def _contact(self, sole: Sole) -> placo.Contact6D:
        frame = self.robot.spec.feet[sole.name].frame
        task = self.solver.add_frame_task(frame, self.body.get_T_world_frame(frame))
        task.configure(sole.name, "hard")
        contact = self.solver.add_planar_contact(task)
        contact.length, contact.width = 2.0 * np.minimum(-sole.lower, sole.upper)
        contact.mu = _FRICTION
        return contact
