"""What a robot knows of the ground it stands on: it is told, or it feels it through its soles."""

from __future__ import annotations

from typing import Literal, get_args

import numpy as np

from momentum_lab.errors import InputError
from momentum_lab.momentum.foot_ground import FootGround
from momentum_lab.robot.state import Dynamics

GroundSense = Literal["told", "felt"]
GROUND_SENSES: tuple[GroundSense, ...] = get_args(GroundSense)


def sensed(sense: GroundSense, dynamics: Dynamics, ground: FootGround) -> FootGround:
    """The ground as the robot takes it to be.

    Told: pose, velocity and acceleration of every plate, the v_c and dv_c of Eqs. 27 and 31; a robot that knows
    when the bus brakes. Felt: a plate is where a sole is, as it lies and as fast as it is, and is not expected to
    speed up; a robot that trusts its soles.

    Args:
        sense: told or felt.
        dynamics: the state with everything computed.
        ground: the plates as they are.
    """
    if sense == "told":
        return ground
    velocity = dynamics.sole_jacobian @ dynamics.state.v
    return FootGround(
        dynamics.sole_position,
        dynamics.sole_rotation,
        velocity,
        np.zeros_like(velocity),
        float(dynamics.sole_position[:, 2].mean()),
    )


def ground_sense(name: str) -> GroundSense:
    """The name, if there is such a sense.

    Raises:
        InputError: there is none.
    """
    for sense in GROUND_SENSES:
        if name == sense:
            return sense
    raise InputError("ground_sense", name, f"one of {', '.join(GROUND_SENSES)}")
