"""When the ground cannot give both momentum rates, which one gives way (the chapter's Fig. 7)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from momentum_lab.compiled import compiled
from momentum_lab.momentum.ground import GRAVITY, cop_coordinates, ground_reaction_force
from momentum_lab.momentum.polygon import closest_in_polygon
from momentum_lab.momentum.support import clamp_tangential_force, project_on_friction_cone

# The ground always carries at least this part of the weight, so that a CoP exists.
_LEAST_WEIGHT = 0.1


@dataclass(frozen=True, slots=True)
class Compromise:
    """What is asked of the ground after the priority has spoken.

    Attributes:
        force: net ground reaction force f (3,), N.
        angular_rate: dk/dt about the CoM that goes with it (3,), N m.
        cop_desired: CoP that both desired rates together need (2,), m.
        cop_admissible: the nearest point of the safe support polygon (2,), m.
    """

    force: np.ndarray
    angular_rate: np.ndarray
    cop_desired: np.ndarray
    cop_admissible: np.ndarray


def compromise(
    desired_rate: np.ndarray,
    com_in_world: np.ndarray,
    mass: float,
    polygon: np.ndarray,
    ground_height: float,
    friction: float,
    priority: float,
) -> Compromise:
    """The net force and angular rate nearest to the desired ones, by priority.

    The desired force (Eq. 39) goes into the friction cone and the desired CoP (Eqs. 40, 41) to the nearest
    point p of the safe polygon. Priority 0 (Fig. 7 left) keeps the force and moves it to p; angular momentum
    gives way. Priority 1 (Fig. 7 right) keeps f_z and dk/dt and tilts the force; linear momentum gives way:

        f_x = ((r_x - p_x) f_z - dk_y/dt) / z_c,  f_y = ((r_y - p_y) f_z + dk_x/dt) / z_c.

    Where the cone stops the tilt, f_z is kept and dk/dt gives way too.
    In between, the force is the mean of the two, weighted by the priority.

    Args:
        desired_rate: [dl/dt; dk/dt] desired (6,), N and N m.
        com_in_world: r_G (3,), m.
        mass: m, kg.
        polygon: safe support polygon, counter-clockwise (K, 2), m.
        ground_height: z_0, m.
        friction: Coulomb coefficient to count on.
        priority: from 0 to 1.

    Returns:
        The compromise; both desired rates themselves when they are admissible.
    """
    return Compromise(
        *_compromise(desired_rate, com_in_world, mass, polygon, ground_height, friction, priority)
    )


@compiled("f8[::1](f8[::1], f8, f8)")
def _within_cone(force: np.ndarray, friction: float, mass: float) -> np.ndarray:
    projected = project_on_friction_cone(force, friction).copy()
    projected[2] = max(projected[2], _LEAST_WEIGHT * mass * GRAVITY)
    return projected


@compiled("UniTuple(f8[::1], 4)(f8[::1], f8[::1], f8, f8[:, ::1], f8, f8, f8)")
def _compromise(
    desired_rate: np.ndarray,
    com: np.ndarray,
    mass: float,
    polygon: np.ndarray,
    ground_height: float,
    friction: float,
    priority: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    force = _within_cone(ground_reaction_force(desired_rate[:3], mass), friction, mass)
    about_com = np.concatenate((force, desired_rate[3:]))
    cop_desired = np.array(cop_coordinates(about_com, com, ground_height))
    cop = closest_in_polygon(cop_desired, polygon)
    dx, dy, height = cop[0] - com[0], cop[1] - com[1], com[2] - ground_height
    k_x, k_y, k_z = desired_rate[3:]
    if priority > 0.0:
        fz = force[2]
        tilted = np.array([-(dx * fz + k_y) / height, (k_x - dy * fz) / height, fz])
        force = (1.0 - priority) * force + priority * clamp_tangential_force(tilted, friction)
    fx, fy, fz = force
    angular_rate = np.array([dy * fz + height * fy, -height * fx - dx * fz, k_z])
    return force, angular_rate, cop_desired, cop
