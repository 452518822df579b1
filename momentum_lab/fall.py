"""When a robot counts as fallen."""

from __future__ import annotations

from dataclasses import dataclass

from momentum_lab.physics.simulator import Step
from momentum_lab.robot.state import Dynamics

# A robot whose CoM is lower than this part of its standing height has fallen.
_FALLEN_HEIGHT = 0.6


@dataclass(frozen=True, slots=True)
class Fall:
    """When the robot fell, and why it counts as fallen.

    Attributes:
        time: simulated time, s.
        reason: in words.
    """

    time: float
    reason: str


def fall_of(
    time: float, dynamics: Dynamics, step: Step, ground_height: float, standing_height: float
) -> Fall | None:
    """When and why a robot has fallen; None while it stands.

    Args:
        time: of the run, s.
        dynamics: the robot at the start of a step.
        step: the step.
        ground_height: height of the ground under the robot, m.
        standing_height: of the CoM above the ground when the robot stands, m.
    """
    if any(step.other_wrench.tolist()):
        return Fall(time, "something other than a sole touched the ground")
    height = dynamics.com_in_world[2] - ground_height
    if height < _FALLEN_HEIGHT * standing_height:
        return Fall(time, f"the CoM sank to {height:.2f} m")
    return None
