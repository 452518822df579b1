"""The momentum regulator on a robot: where it stands, which way it faces, how far off it is."""

from __future__ import annotations

import math

import numpy as np
import pinocchio as pin

from momentum_lab.control.controller import Reference
from momentum_lab.control.momentum_lqr import LqrCosts, OperatingPoint, momentum_feedback
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics


class RegulatedMomentum:
    """Desired momentum rates by the linear-quadratic regulator of the robot's standing posture.

    The operating point is what the posture makes of it: the CoM above the middle of the stance soles. It is
    expressed in the heading of the first stance foot, so it is the same wherever the robot stands and looks.

    Args:
        robot: the robot.
    """

    def __init__(self, robot: RobotModel) -> None:
        self._robot = robot
        self._data = robot.model.createData()
        self._base = pin.neutral(robot.model)[:7]
        self._centers = [np.append((sole.lower + sole.upper) / 2.0, 0.0) for sole in robot.soles]
        self._known: tuple[tuple[bytes, tuple[int, ...]], OperatingPoint] | None = None

    def rate(self, dynamics: Dynamics, reference: Reference, costs: LqrCosts) -> np.ndarray:
        """[dl_d; dk_d] (6,), N and N m: the last rows of (A - B K) (r - r_d, l - l_d, k - k_d), and m ddr_d."""
        point = self.operating_point(reference.posture, reference.stance)
        forward = dynamics.sole_rotation[reference.stance[0], :, 0]
        turn = pin.utils.rotate("z", math.atan2(forward[1], forward[0]))
        error = np.stack(
            [
                dynamics.com_in_world - reference.com,
                dynamics.momentum[:3] - self._robot.mass * reference.com_velocity,
                dynamics.momentum[3:] - reference.angular_momentum,
            ]
        )
        rate = momentum_feedback(point, costs)[3:] @ (error @ turn).ravel()
        rate = (rate.reshape(2, 3) @ turn.T).ravel()
        rate[:3] += self._robot.mass * reference.com_acceleration
        return rate

    def operating_point(self, posture: np.ndarray, stance: tuple[int, ...]) -> OperatingPoint:
        """Where the stance soles are when the joints are at `posture` (na,) and the CoM is above their middle."""
        key = posture.tobytes(), stance
        if self._known is None or key != self._known[0]:
            self._known = key, self._compute(posture, stance)
        return self._known[1]

    def _compute(self, posture: np.ndarray, stance: tuple[int, ...]) -> OperatingPoint:
        model, data = self._robot.model, self._data
        q = np.concatenate([self._base, posture])
        pin.framesForwardKinematics(model, data, q)
        com = pin.centerOfMass(model, data, q)
        placements = [data.oMf[self._robot.soles[foot].frame] for foot in stance]
        level = placements[0].rotation.T
        centers = [
            level @ (placement.act(self._centers[foot]) - com)
            for foot, placement in zip(stance, placements, strict=True)
        ]
        aside = np.append(np.mean(centers, axis=0)[:2], 0.0)
        arms = (tuple(np.round(center - aside, 6).tolist()) for center in centers)
        return OperatingPoint(self._robot.mass, tuple(arms))
