"""What every controller is given and what it answers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np

from momentum_lab.momentum.directions import ALL, Directions
from momentum_lab.momentum.foot_ground import FootGround
from momentum_lab.robot.state import Dynamics

SLACKS = ("com x", "com y", "com z", "pelvis x", "pelvis y", "pelvis z", "swing foot", "posture")
"""What slacks are called, in the order of a recording; m/s^2 for a position, rad/s^2 for a rotation."""


@dataclass(frozen=True, slots=True)
class Reference:
    """What the robot shall do; F is the number of feet.

    Attributes:
        com: desired centre of mass r_d in the world (3,), m.
        com_velocity: its desired velocity (3,), m/s.
        com_acceleration: its desired acceleration (3,), m/s^2.
        angular_momentum: desired angular momentum k_d about the CoM (3,), N m s.
        angular_momentum_rate: how fast k_d changes (3,), N m; None: it does not.
        posture: desired joint angles (na,), rad.
        posture_rate: how fast the desired joint angles change (na,), rad/s; None: they do not.
        pelvis_rotation: desired pelvis axes in the world (3, 3).
        stance: the feet that carry the robot, as indices.
        ground: the plates under the feet, as the robot is told of them.
        controlled: which of l_x, l_y, l_z, k_x, k_y, k_z are asked for; the others are left free
            (section 5.3.1).
        planner: what makes the rates that are asked for out of Eqs. 37 and 38, a row of Table 1.
    """

    com: np.ndarray
    com_velocity: np.ndarray
    com_acceleration: np.ndarray
    angular_momentum: np.ndarray
    posture: np.ndarray
    pelvis_rotation: np.ndarray
    stance: tuple[int, ...]
    ground: FootGround
    controlled: Directions = ALL
    planner: str = "momentum"
    posture_rate: np.ndarray | None = None
    angular_momentum_rate: np.ndarray | None = None

    def posture_ahead(self, time: float) -> np.ndarray:
        """The posture so much later if it keeps its rate (na,), rad.

        A law k (theta_d - theta) - d theta' becomes k (theta_d - theta) + d (theta_d' - theta') when it is given
        the posture d / k ahead.
        """
        return self.posture if self.posture_rate is None else self.posture + time * self.posture_rate


@dataclass(frozen=True, slots=True)
class ControlOutput:
    """A controller's answer and its reasons; momentum rates about the CoM, linear before angular.

    Attributes:
        torque: joint torques (na,), N m.
        acceleration: the generalized acceleration they are meant to cause (nv,).
        momentum_rate_desired: what the feedback laws ask for (6,), N and N m.
        momentum_rate_admissible: what the ground can give of it (6,), N and N m.
        foot_wrench_admissible: ground on each foot about the sole origin, world axes (F, 6).
        cop_desired: CoP that the desired rates need (2,), m.
        cop_admissible: CoP of the admissible wrenches (2,), m.
        failure: why the torque is the fallback torque; None when it is not.
        memory: what the controller wants to be given at the next tick.
        slack: what the goals have to do without, by the names of `SLACKS`, m/s^2 and rad/s^2; empty where a law
            has no slacks.
    """

    torque: np.ndarray
    acceleration: np.ndarray
    momentum_rate_desired: np.ndarray
    momentum_rate_admissible: np.ndarray
    foot_wrench_admissible: np.ndarray
    cop_desired: np.ndarray
    cop_admissible: np.ndarray
    failure: str | None
    memory: Any
    slack: Mapping[str, float] = field(default_factory=dict)


class Controller(Protocol):
    """A balance controller: a function of what it is given, with no state of its own."""

    def initial_memory(self, dynamics: Dynamics) -> Any:
        """What the first tick is given as memory."""
        ...

    def compute(
        self, dynamics: Dynamics, reference: Reference, gains: Any, priority: float, memory: Any
    ) -> ControlOutput:
        """Torques for one tick.

        Args:
            dynamics: the state with everything computed.
            reference: what the robot shall do.
            gains: an instance of the controller's dataclass of gains.
            priority: 0 keeps linear momentum, 1 keeps angular momentum, when the ground cannot give both.
            memory: what the previous tick has returned.
        """
        ...
