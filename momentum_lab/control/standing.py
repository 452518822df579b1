"""The goal of standing: where the CoM, the pelvis and the joints shall be, given where the feet are."""

from __future__ import annotations

import math

import numpy as np

from momentum_lab.control.controller import Reference
from momentum_lab.momentum.directions import ALL, Directions
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics


class StandingGoal:
    """Stand on some feet, in the posture of a given state.

    The goal follows the feet: r_d is above the mean of the soles' centres (the chapter's choice for Eq. 38),
    the pelvis faces where the feet face. So it means the same anywhere in the world.

    Args:
        robot: the robot.
        home: the standing posture, with everything computed.
        stance: the feet that carry the robot, as indices.
        controlled: the directions of momentum that are asked for (section 5.3.1).
    """

    def __init__(
        self, robot: RobotModel, home: Dynamics, stance: tuple[int, ...], controlled: Directions = ALL
    ) -> None:
        self.stance = stance
        self.controlled = controlled
        self.posture = home.state.q[7:].copy()
        self._centers = [np.append((sole.lower + sole.upper) / 2.0, 0.0) for sole in robot.soles]
        self._height = home.com_in_world[2] - self._stance_center(home)[2]
        self._pelvis = _about_vertical(-self._heading(home)) @ home.pelvis_rotation
        self._still = np.zeros(3)

    def reference(self, dynamics: Dynamics) -> Reference:
        """The goal for a state whose soles are where `dynamics` says, on level ground at height 0."""
        com = self._stance_center(dynamics)
        com[2] = self._height
        return Reference(
            com=com,
            com_velocity=self._still,
            angular_momentum=self._still,
            posture=self.posture,
            pelvis_rotation=_about_vertical(self._heading(dynamics)) @ self._pelvis,
            stance=self.stance,
            sole_height=np.zeros(len(dynamics.sole_position)),
            controlled=self.controlled,
        )

    def _stance_center(self, dynamics: Dynamics) -> np.ndarray:
        """Mean of the centres of the stance soles in the world (3,), m."""
        total = np.zeros(3)
        for foot in self.stance:
            total += dynamics.sole_position[foot] + dynamics.sole_rotation[foot] @ self._centers[foot]
        return total / len(self.stance)

    def _heading(self, dynamics: Dynamics) -> float:
        """Mean direction of the stance feet about the vertical, rad."""
        forward = dynamics.sole_rotation[list(self.stance), :, 0].sum(0)
        return math.atan2(forward[1], forward[0])


def _about_vertical(angle: float) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
