"""The goal of standing: where the CoM, the pelvis and the joints shall be, given where the feet are."""

from __future__ import annotations

import math

import numpy as np

from momentum_lab.compiled import compiled
from momentum_lab.control.controller import Reference
from momentum_lab.control.planner import OWN
from momentum_lab.momentum.directions import ALL, Directions
from momentum_lab.momentum.foot_ground import FootGround, acceleration_at, height_below, velocity_at
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics

_MATRIX, _VECTOR, _STACK = "f8[:, ::1]", "f8[::1]", "f8[:, :, ::1]"


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
        center, heading = stance_place(home.sole_position, home.sole_rotation, self._centers, self._share)
        self._height = home.com_in_world[2] - center[2]
        self._pelvis = turned_about_vertical(-heading, np.ascontiguousarray(home.pelvis_rotation))
        self._no_turning = np.zeros(3)

    def reference(
        self, dynamics: Dynamics, ground: FootGround, controlled: Directions = ALL, planner: str = OWN
    ) -> Reference:
        """The goal for a state whose soles are where `dynamics` says, and for the plates under them.

        Args:
            dynamics: the state with everything computed.
            ground: the plates under the feet.
            controlled: the directions of momentum that are asked for (section 5.3.1).
            planner: a row of Table 1.
        """
        com, velocity, acceleration, pelvis = standing_goal(
            dynamics.sole_position,
            dynamics.sole_rotation,
            self._centers,
            self._share,
            ground.position,
            ground.rotation,
            ground.velocity,
            ground.acceleration,
            self._height,
            self._pelvis,
        )
        return Reference(
            com=com,
            com_velocity=velocity,
            com_acceleration=acceleration,
            angular_momentum=self._no_turning,
            posture=self.posture,
            pelvis_rotation=pelvis,
            stance=self.stance,
            ground=ground,
            controlled=controlled,
            planner=planner,
        )


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


@compiled(
    f"Tuple(({_VECTOR}, {_VECTOR}, {_VECTOR}, {_MATRIX}))({_MATRIX}, {_STACK}, {_MATRIX}, {_VECTOR}, "
    f"{_MATRIX}, {_STACK}, {_MATRIX}, {_MATRIX}, f8, {_MATRIX})"
)
def standing_goal(
    position: np.ndarray,
    rotation: np.ndarray,
    centers: np.ndarray,
    share: np.ndarray,
    plate_position: np.ndarray,
    plate_rotation: np.ndarray,
    plate_velocity: np.ndarray,
    plate_acceleration: np.ndarray,
    com_height: float,
    pelvis: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """r_d (3,), m, above the middle of the stance feet, moving with it, and pelvis axes that face where they face.

    The middle is that of the plates under the soles' centres: a foot that lifts does not lift the CoM.

    Args:
        position: see `stance_place` for this and the next three (F, 3), m.
        rotation: (F, 3, 3).
        centers: (F, 3), m.
        share: (F,).
        plate_position: a point of the plate under each foot (F, 3), m.
        plate_rotation: axes of the plates, normals last (F, 3, 3).
        plate_velocity: of those points and plates (F, 6), m/s and rad/s.
        plate_acceleration: likewise (F, 6), m/s^2 and rad/s^2.
        com_height: of r_d above the plates, m.
        pelvis: pelvis axes of a robot that faces along x (3, 3).

    Returns:
        r_d, its velocity and acceleration (3,), and the axes (3, 3).
    """
    com, heading = stance_place(position, rotation, centers, share)
    ground, velocity, acceleration = 0.0, np.zeros(3), np.zeros(3)
    for foot in range(len(share)):
        center = position[foot] + rotation[foot] @ centers[foot]
        at, moving = plate_position[foot], plate_velocity[foot]
        ground += share[foot] * height_below(at, plate_rotation[foot], center[0], center[1])
        velocity += share[foot] * velocity_at(center, at, moving)[:3]
        acceleration += share[foot] * acceleration_at(center, at, moving, plate_acceleration[foot])[:3]
    com[2] = ground + com_height
    return com, velocity, acceleration, turned_about_vertical(heading, pelvis)
