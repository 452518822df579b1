"""What a robot knows of the ground it stands on: it is told, or it feels it through its soles."""

from __future__ import annotations

from typing import Literal, get_args

import numpy as np

from momentum_lab.errors import InputError
from momentum_lab.momentum.foot_ground import FootGround
from momentum_lab.robot.state import Dynamics

GroundSense = Literal["told", "felt"]
GROUND_SENSES: tuple[GroundSense, ...] = get_args(GroundSense)


def felt_ground(dynamics: Dynamics, pressed: np.ndarray, before: FootGround) -> FootGround:
    """The ground that soles feel: where a pressed sole is, there is a plate, as it lies and as fast as it is.

    It is not expected to speed up. Under a sole that nothing presses, the plate is taken to be at rest where it
    was felt last.

    Args:
        dynamics: the state with everything computed.
        pressed: whether the force sensor of each foot feels the ground (F,).
        before: what was felt before.
    """
    velocity = np.where(pressed[:, None], dynamics.sole_jacobian @ dynamics.state.v, 0.0)
    position = np.where(pressed[:, None], dynamics.sole_position, before.position)
    rotation = np.where(pressed[:, None, None], dynamics.sole_rotation, before.rotation)
    known = position[pressed] if pressed.any() else position
    return FootGround(position, rotation, velocity, np.zeros_like(velocity), float(known[:, 2].mean()))


def ground_sense(name: str) -> GroundSense:
    """The name, if there is such a sense.

    Raises:
        InputError: there is none.
    """
    for sense in GROUND_SENSES:
        if name == sense:
            return sense
    raise InputError("ground_sense", name, f"one of {', '.join(GROUND_SENSES)}")
