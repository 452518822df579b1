"""What stands above a controller and decides which momentum rates it is asked for: the rows of Table 1.

Row d is the chapter's own way, and row b (resolved momentum) has no CoP to plan. The CoP of rows a and c comes
from the capture point xi = r + dr / omega, the unstable part of the pendulum: with p = xi + c (xi - r_d) it
decays as exp(-omega c t).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from momentum_lab.control.controller import Reference
from momentum_lab.errors import InputError
from momentum_lab.momentum.ground import GRAVITY, cmp_from_force, ground_reaction_force
from momentum_lab.momentum.pendulum import capture_point
from momentum_lab.momentum.polygon import closest_in_polygon
from momentum_lab.robot.state import Dynamics

# c, 1: with omega from 3.3 to 3.8 1/s it brings the capture point back at the 4 1/s of Eq. 38's default gains.
_CAPTURE_GAIN = 1.2
OWN = "momentum"
"""The planner that leaves the desired rates as they are."""


@dataclass(frozen=True, slots=True)
class Support:
    """Where the CoP may be.

    Attributes:
        mass: m, kg.
        polygon: the safe support polygon, counter-clockwise (K, 2), m.
        height: z_0, of the ground, m.
    """

    mass: float
    polygon: np.ndarray
    height: float


@dataclass(frozen=True, slots=True)
class Planner:
    """One row of Table 1.

    Attributes:
        title: the name on the screen.
        summary: what is given and what follows, in one sentence.
        plan: [dl_d; dk_d] of Eqs. 37 and 38 (6,), state, goal, support -> the rates that are asked for (6,).
    """

    title: str
    summary: str
    plan: Callable[[np.ndarray, Dynamics, Reference, Support], np.ndarray]


def planned_cop(dynamics: Dynamics, reference: Reference, support: Support, shift: np.ndarray) -> np.ndarray:
    """The CoP that brings the capture point back, as near as the support polygon allows.

    p_d = xi + c (xi - r_d) - ddr_d / omega^2 + shift, then the closest point of the polygon; xi = r + (dr - dr_d) /
    omega, so that the CoM rides with a goal that moves.

    Args:
        dynamics: the state with everything computed.
        reference: holds r_d, m, and how it moves.
        support: where the CoP may be.
        shift: how far it shall be moved for the sake of angular momentum (2,), m.

    Returns:
        p_d (2,), m.
    """
    height = dynamics.com_in_world[2] - support.height
    velocity = dynamics.com_velocity - reference.com_velocity
    capture = capture_point(dynamics.com_in_world, velocity, support.height)
    shift = shift - reference.com_acceleration[:2] * height / GRAVITY
    wanted = capture + _CAPTURE_GAIN * (capture - reference.com[:2]) + shift
    return closest_in_polygon(wanted, support.polygon)


def com_from_cop(
    desired: np.ndarray, dynamics: Dynamics, reference: Reference, support: Support
) -> np.ndarray:
    """Row a: the CoM follows from a desired CoP, as if the robot were a point mass.

    f_x / f_z = (r_x - p_x) / z_c and likewise y, that is dl = m omega^2 (r - p_d) at a constant height: the CMP
    is put where the CoP is wanted. What the angular goal dk_d asks for moves the CoP away from there.
    """
    cop = planned_cop(dynamics, reference, support, np.zeros(2))
    arm = dynamics.com_in_world[:2] - cop
    normal = ground_reaction_force(desired[:3], support.mass)[2]
    rate = desired.copy()
    rate[:2] = normal / (dynamics.com_in_world[2] - support.height) * arm
    return rate


def angular_from_cop(
    desired: np.ndarray, dynamics: Dynamics, reference: Reference, support: Support
) -> np.ndarray:
    """Row c: the rate of angular momentum follows from a desired CoP and the desired linear rate.

    dk_d = (p_d - r_G) x f_d, horizontally, with f_d = dl_d - m g (Eqs. 21, 39): the body turns as far as force
    and CoP do not fit. What Eq. 37 asks for goes into p_d, as the shift (-dk_y, dk_x) / f_z of Eq. 23.
    """
    force = ground_reaction_force(desired[:3], support.mass)
    shift = np.array([-desired[4], desired[3]]) / force[2]
    cop = planned_cop(dynamics, reference, support, shift)
    gap = cop - cmp_from_force(force, dynamics.com_in_world, support.height)
    rate = desired.copy()
    rate[3:5] = gap[1] * force[2], -gap[0] * force[2]
    return rate


def _as_desired(
    desired: np.ndarray, _dynamics: Dynamics, _reference: Reference, _support: Support
) -> np.ndarray:
    return desired


PLANNERS: dict[str, Planner] = {
    OWN: Planner(
        title="Momentum rates",
        summary="Both rates are desired; admissible forces follow (Table 1d, the chapter's way).",
        plan=_as_desired,
    ),
    "cop-to-com": Planner(
        title="CoP to CoM",
        summary="A desired CoP moves the CoM as a point mass on a pendulum (Table 1a).",
        plan=com_from_cop,
    ),
    "cop-and-force": Planner(
        title="CoP and force",
        summary="Desired CoP and linear rate decide how angular momentum has to change (Table 1c).",
        plan=angular_from_cop,
    ),
}


def planner_named(name: str) -> Planner:
    """The planner of that name.

    Raises:
        InputError: there is none.
    """
    if name not in PLANNERS:
        raise InputError("planner", name, f"one of {', '.join(PLANNERS)}")
    return PLANNERS[name]
