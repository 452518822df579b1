"""The goal of standing: where the CoM, the pelvis and the joints shall be, given where the feet are."""

from __future__ import annotations

import math

import numpy as np

from momentum_lab.compiled import compiled
from momentum_lab.control.controller import Reference
from momentum_lab.control.planner import OWN
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
    """

    def __init__(self, robot: RobotModel, home: Dynamics, stance: tuple[int, ...]) -> None:
        self.stance = stance
        self.posture = home.state.q[7:].copy()
        self._centers = np.array([np.append((sole.lower + sole.upper) / 2.0, 0.0) for sole in robot.soles])
        self._share = np.array([(foot in stance) / len(stance) for foot in range(len(robot.soles))])
        center, heading = self._place(home)
        self._height = home.com_in_world[2] - center[2]
        self._pelvis = turned_about_vertical(-heading, np.ascontiguousarray(home.pelvis_rotation))
        self._still = np.zeros(3)
        self._level = np.zeros(len(robot.soles))

    def reference(self, dynamics: Dynamics, controlled: Directions = ALL, planner: str = OWN) -> Reference:
        """The goal for a state whose soles are where `dynamics` says, on level ground at height 0.

        Args:
            dynamics: the state with everything computed.
            controlled: the directions of momentum that are asked for (section 5.3.1).
            planner: a row of Table 1.
        """
        com, pelvis = standing_goal(
            dynamics.sole_position,
            dynamics.sole_rotation,
            self._centers,
            self._share,
            self._height,
            self._pelvis,
        )
        return Reference(
            com=com,
            com_velocity=self._still,
            angular_momentum=self._still,
            posture=self.posture,
            pelvis_rotation=pelvis,
            stance=self.stance,
            sole_height=self._level,
            controlled=controlled,
            planner=planner,
        )

    def _place(self, dynamics: Dynamics) -> tuple[np.ndarray, float]:
        return stance_place(dynamics.sole_position, dynamics.sole_rotation, self._centers, self._share)


@compiled("Tuple((f8[::1], f8))(f8[:, ::1], f8[:, :, ::1], f8[:, ::1], f8[::1])")
def stance_place(
    position: np.ndarray, rotation: np.ndarray, centers: np.ndarray, share: np.ndarray
) -> tuple[np.ndarray, float]:
    """Where the stance feet are: mean of their soles' centres (3,), m, and mean direction about the vertical, rad.

    Args:
        position: sole origins in the world (F, 3), m.
        rotation: axes of the soles in the world (F, 3, 3).
        centers: middle of each sole in its frame (F, 3), m.
        share: what each foot counts in the mean (F,).
    """
    center, forward = np.zeros(3), np.zeros(3)
    for foot in range(len(share)):
        center += share[foot] * (position[foot] + rotation[foot] @ centers[foot])
        forward += share[foot] * rotation[foot][:, 0]
    return center, math.atan2(forward[1], forward[0])


@compiled("f8[:, ::1](f8, f8[:, ::1])")
def turned_about_vertical(angle: float, rotation: np.ndarray) -> np.ndarray:
    """R_z(angle) R: axes (3, 3) turned about the vertical of the world by an angle, rad."""
    c, s = math.cos(angle), math.sin(angle)
    turned = np.empty((3, 3))
    turned[0] = c * rotation[0] - s * rotation[1]
    turned[1] = s * rotation[0] + c * rotation[1]
    turned[2] = rotation[2]
    return turned


@compiled("Tuple((f8[::1], f8[:, ::1]))(f8[:, ::1], f8[:, :, ::1], f8[:, ::1], f8[::1], f8, f8[:, ::1])")
def standing_goal(
    position: np.ndarray,
    rotation: np.ndarray,
    centers: np.ndarray,
    share: np.ndarray,
    com_height: float,
    pelvis: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """r_d (3,), m, above the middle of the stance feet, and pelvis axes (3, 3) that face where they face.

    Args:
        position: see `stance_place` for this and the next three (F, 3), m.
        rotation: (F, 3, 3).
        centers: (F, 3), m.
        share: (F,).
        com_height: of r_d, m.
        pelvis: pelvis axes of a robot that faces along x (3, 3).
    """
    com, heading = stance_place(position, rotation, centers, share)
    com[2] = com_height
    return com, turned_about_vertical(heading, pelvis)
