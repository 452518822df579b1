"""What the ground does to the momentum: force, CoP and CMP (Eqs. 1, 2, 21 to 23, 39 to 41).

All equations are z up; the ground is the plane z = ground_height. A point that does not exist is NaN: CoP and
CMP while nothing presses on the ground. These functions run every tick; they work on plain numbers because
three-vectors are too short for numpy to pay off.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from momentum_lab.compiled import compiled
from momentum_lab.momentum.wrench import sum_wrenches

GRAVITY = 9.81
"""Standard gravity as Pinocchio rounds it, m/s^2."""

NO_FORCE = 1e-6
"""A normal force smaller than this is the rounding of a solver, not a contact, N."""


@dataclass(frozen=True, slots=True)
class GroundReaction:
    """The net action of the ground on the robot as one force at the CoP and a moment about the normal.

    Attributes:
        force: f, world axes (3,), N.
        cop_in_world: p, on the ground plane (3,), m.
        normal_moment: tau_n about the vertical through p, N m.
    """

    force: np.ndarray
    cop_in_world: np.ndarray
    normal_moment: float


def momentum_rate_from_wrenches(
    wrenches: np.ndarray, points: np.ndarray, com_in_world: np.ndarray, mass: float
) -> np.ndarray:
    """The momentum rate that contacts and pushes cause together with gravity.

    dl/dt = m g + sum f_i,  dk/dt = sum ((p_i - r_G) x f_i + n_i) (Eqs. 1, 2 with several wrenches). A push F
    at c is one more wrench [F; 0] at c.

    Args:
        wrenches: [f_i; n_i] about points[i], world axes (C, 6), N and N m.
        points: p_i (C, 3), m.
        com_in_world: r_G (3,), m.
        mass: m, kg.

    Returns:
        [dl/dt; dk/dt] about the CoM, world axes (6,), N and N m.
    """
    rate = sum_wrenches(wrenches, points, com_in_world)
    rate[2] -= mass * GRAVITY
    return rate


@compiled("f8[::1](f8[:], f8)")
def ground_wrench_from_momentum_rate(momentum_rate: np.ndarray, mass: float) -> np.ndarray:
    """The net external wrench about the CoM, other than gravity, that a momentum rate needs.

    [dl/dt - m g; dk/dt] (Eqs. 1, 2 solved for the forces).

    Args:
        momentum_rate: [dl/dt; dk/dt] about the CoM, world axes (6,), N and N m.
        mass: m, kg.

    Returns:
        [f; n] about the CoM, world axes (6,), N and N m.
    """
    wrench = momentum_rate.copy()
    wrench[2] += mass * GRAVITY
    return wrench


@compiled("f8[::1](f8[:], f8)")
def ground_reaction_force(linear_momentum_rate: np.ndarray, mass: float) -> np.ndarray:
    """The force the ground has to give for a rate of linear momentum.

    f = dl/dt - m g, with g = (0, 0, -9.81) (Eq. 39).

    Args:
        linear_momentum_rate: dl/dt (3,), N.
        mass: m, kg.

    Returns:
        f, world axes (3,), N.
    """
    x, y, z = linear_momentum_rate
    return np.array((x, y, z + mass * GRAVITY))


def reaction_from_momentum_rate(
    momentum_rate: np.ndarray, com_in_world: np.ndarray, mass: float, ground_height: float = 0.0
) -> GroundReaction:
    """Force, CoP and normal moment that explain a momentum rate.

    f = dl/dt - m g, p from Eq. 21, tau_n = dk_z/dt - ((p - r_G) x f)_z: the inverse of Eqs. 1 and 2, six
    numbers for six.

    Args:
        momentum_rate: [dl/dt; dk/dt] about the CoM, world axes (6,), N and N m.
        com_in_world: r_G (3,), m.
        mass: m, kg.
        ground_height: height of the ground plane, m.

    Returns:
        The ground reaction; CoP and normal moment are NaN without a normal force.
    """
    wrench = ground_wrench_from_momentum_rate(momentum_rate, mass)
    x, y = cop_coordinates(wrench, com_in_world, ground_height)
    rx, ry, _ = com_in_world.tolist()
    fx, fy, _, _, _, nz = wrench.tolist()
    normal_moment = nz - (x - rx) * fy + (y - ry) * fx
    return GroundReaction(wrench[:3], np.array((x, y, ground_height)), normal_moment)


def momentum_rate_from_reaction(
    reaction: GroundReaction, com_in_world: np.ndarray, mass: float
) -> np.ndarray:
    """The momentum rate that a ground reaction and gravity cause.

    dl/dt = m g + f (Eq. 2),  dk/dt = (p - r_G) x f + tau_n z (Eq. 1).

    Args:
        reaction: force, CoP and normal moment.
        com_in_world: r_G (3,), m.
        mass: m, kg.

    Returns:
        [dl/dt; dk/dt] about the CoM, world axes (6,), N and N m.
    """
    fx, fy, fz = reaction.force.tolist()
    rx, ry, rz = com_in_world.tolist()
    px, py, pz = reaction.cop_in_world.tolist()
    dx, dy, dz = px - rx, py - ry, pz - rz
    k_x, k_y, k_z = dy * fz - dz * fy, dz * fx - dx * fz, dx * fy - dy * fx + reaction.normal_moment
    return np.array((fx, fy, fz - mass * GRAVITY, k_x, k_y, k_z))


def cop_from_wrench(wrench: np.ndarray, point: np.ndarray, ground_height: float = 0.0) -> np.ndarray:
    """The CoP of a wrench: the point of the ground about which it has no horizontal moment.

    p_x = c_x - (n_y + (c_z - z_0) f_x) / f_z,  p_y = c_y + (n_x - (c_z - z_0) f_y) / f_z, for a wrench about
    c (Eq. 21 with the CoM as c).

    Args:
        wrench: [f; n] about the point, world axes (6,), N and N m.
        point: c (3,), m.
        ground_height: z_0, m.

    Returns:
        (p_x, p_y) in the world (2,), m; NaN without a normal force.
    """
    return np.array(cop_coordinates(wrench, point, ground_height))


def cop_from_momentum_rate(
    momentum_rate: np.ndarray, com_in_world: np.ndarray, mass: float, ground_height: float = 0.0
) -> np.ndarray:
    """The CoP that a momentum rate, measured or desired, needs.

    p_x = r_x - (f_x z_c + dk_y/dt) / f_z,  p_y = r_y - (f_y z_c - dk_x/dt) / f_z, with f = dl/dt - m g and
    z_c = r_z - z_0 (Eq. 21; Eqs. 40 and 41 with r_Gx in place of the printed r_Gz and g_y = -9.81 as g). A
    push is not the ground: subtract its wrench about the CoM from a measured rate first.

    Args:
        momentum_rate: [dl/dt; dk/dt] about the CoM, world axes (6,), N and N m.
        com_in_world: r_G (3,), m.
        mass: m, kg.
        ground_height: z_0, m.

    Returns:
        (p_x, p_y) in the world (2,), m; NaN without a normal force.
    """
    return _cop_of_rate(momentum_rate, com_in_world, mass, ground_height)


def cmp_from_force(force: np.ndarray, com_in_world: np.ndarray, ground_height: float = 0.0) -> np.ndarray:
    """The CMP: where the line through the CoM along the ground reaction force meets the ground.

    s = r_G - (f / f_z) z_c, with z_c = r_z - z_0, so that (s - r_G) x f = 0 (Eq. 22).

    Args:
        force: f, world axes (3,), N.
        com_in_world: r_G (3,), m.
        ground_height: z_0, m.

    Returns:
        (s_x, s_y) in the world (2,), m; NaN without a normal force.
    """
    return np.array(cmp_coordinates(force, com_in_world, ground_height))


def cmp_cop_gap(angular_momentum_rate: np.ndarray, normal_force: float) -> np.ndarray:
    """The way from the CoP to the CMP: the lever arm of the moment about the CoM.

    s - p = (dk_y/dt, -dk_x/dt) / f_z (Eq. 23).

    Args:
        angular_momentum_rate: dk/dt about the CoM (3,), N m.
        normal_force: f_z, N.

    Returns:
        s - p (2,), m; NaN without a normal force.
    """
    k_x, k_y, _ = angular_momentum_rate.tolist()
    fz = float(normal_force)
    if abs(fz) < NO_FORCE:
        return np.array((math.nan, math.nan))
    return np.array((k_y / fz, -k_x / fz))


@compiled("f8[::1](f8[:])")
def sole_cop(wrench_at_sole: np.ndarray) -> np.ndarray:
    """The CoP under one foot, however it is tilted.

    p = (-n_y, n_x) / f_z in the axes of the sole.

    Args:
        wrench_at_sole: [f; n] about the sole frame's origin, in its axes (6,), N and N m.

    Returns:
        (p_x, p_y) in the sole frame (2,), m; NaN without a normal force.
    """
    _, _, fz, nx, ny, _ = wrench_at_sole
    if abs(fz) < NO_FORCE:
        return np.array((math.nan, math.nan))
    return np.array((-ny / fz, nx / fz))


@compiled("UniTuple(f8, 2)(f8[:], f8[:], f8)")
def cop_coordinates(wrench: np.ndarray, point: np.ndarray, ground_height: float) -> tuple[float, float]:
    """See `cop_from_wrench`."""
    fx, fy, fz, nx, ny, _ = wrench
    cx, cy, cz = point
    if abs(fz) < NO_FORCE:
        return math.nan, math.nan
    height = cz - ground_height
    return cx - (ny + height * fx) / fz, cy + (nx - height * fy) / fz


@compiled("UniTuple(f8, 2)(f8[:], f8[:], f8)")
def cmp_coordinates(force: np.ndarray, com_in_world: np.ndarray, ground_height: float) -> tuple[float, float]:
    """See `cmp_from_force`."""
    fx, fy, fz = force
    rx, ry, rz = com_in_world
    if abs(fz) < NO_FORCE:
        return math.nan, math.nan
    slope = (rz - ground_height) / fz
    return rx - fx * slope, ry - fy * slope


@compiled("f8[::1](f8[:], f8[:], f8, f8)")
def _cop_of_rate(
    momentum_rate: np.ndarray, com_in_world: np.ndarray, mass: float, ground_height: float
) -> np.ndarray:
    wrench = ground_wrench_from_momentum_rate(momentum_rate, mass)
    return np.array(cop_coordinates(wrench, com_in_world, ground_height))
