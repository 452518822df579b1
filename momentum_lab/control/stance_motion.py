"""Everything a tick decides as affine functions of what is free once the feet stand still.

Two blocks of the equations of motion need no solver. The feet stand still (Eq. 31), so the first of them tells
how the free base accelerates: the robot is rooted there, as the chapter's model of section 5.2 is. The free base
has no motor (Eq. 29), so the last foot bears what the others leave over. What remains free are the accelerations
of the joints and, on two feet, the wrench of one of them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from momentum_lab.control.accelerations import contact_constraint
from momentum_lab.control.controller import Reference
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.robot.state import Dynamics

_BASE = slice(0, 6)


@dataclass(frozen=True, slots=True)
class Affine:
    """y = matrix x + offset.

    Attributes:
        matrix: (k, n).
        offset: (k,).
    """

    matrix: np.ndarray
    offset: np.ndarray

    def at(self, x: np.ndarray) -> np.ndarray:
        """Y (k,) for x (n,)."""
        return self.matrix @ x + self.offset

    def then(self, matrix: np.ndarray) -> Affine:
        """`matrix` (j, k) times this."""
        return Affine(matrix @ self.matrix, matrix @ self.offset)


@dataclass(frozen=True, slots=True)
class StanceMotion:
    """A robot on C of its S stance feet, as functions of x = [theta''; w_1 / (m g); ...; w_C-1 / (m g)] (n,).

    Wrenches in parts of the weight are numbers of the size of accelerations, which solvers like.

    Attributes:
        acceleration: generalized acceleration (nv,).
        wrench: ground on each carrying foot about its sole origin, world axes (6 C,), N and N m.
        torque: of the joints (na,), N m.
        still: rows of Eq. 31 that are not met by construction, equal to zero (6 (S - 1),).
    """

    acceleration: Affine
    wrench: Affine
    torque: Affine
    still: Affine


def stance_motion(
    dynamics: Dynamics, reference: Reference, carrying: tuple[int, ...], contact_rate: float
) -> StanceMotion:
    """What the joints' accelerations and the feet's wrenches make of the robot (Eqs. 28 to 31).

    The first carrying foot gives the base: a_b = J_b^-1 (dv_c - dJ_c v - J_s theta''). The last one bears
    w_C = J_b^-T (H_b a + C_b v + tau_g,b - sum J_i,b^T w_i); torques are those of Eq. 33.

    Args:
        dynamics: the state with everything computed.
        reference: its stance feet stay where they are.
        carrying: those of the stance feet that are on the ground, at least one.
        contact_rate: kappa, at which stance feet come to rest and lie flat, 1/s.
    """
    joints = dynamics.mass_matrix.shape[0] - 6
    size = joints + 6 * (len(carrying) - 1)
    rows, target = contact_constraint(dynamics, reference.stance, reference, contact_rate)
    first = reference.stance.index(carrying[0])
    root = slice(6 * first, 6 * first + 6)
    acceleration = _rooted(rows[root], target[root], joints, size)
    wrench = _wrenches(dynamics, acceleration, carrying, joints)
    others = np.delete(np.arange(len(target)), np.arange(len(target))[root])
    still = acceleration.then(rows[others])
    return StanceMotion(
        acceleration,
        wrench,
        _torques(dynamics, acceleration, wrench, carrying),
        Affine(still.matrix, still.offset - target[others]),
    )


def _rooted(rows: np.ndarray, target: np.ndarray, joints: int, size: int) -> Affine:
    """Accelerations (nv,) when one foot follows its target (6,)."""
    inverse = np.linalg.inv(rows[:, _BASE])
    matrix = np.zeros((6 + joints, size))
    matrix[_BASE, :joints] = -inverse @ rows[:, 6:]
    matrix[6 + np.arange(joints), np.arange(joints)] = 1.0
    offset = np.zeros(6 + joints)
    offset[_BASE] = inverse @ target
    return Affine(matrix, offset)


def _wrenches(dynamics: Dynamics, acceleration: Affine, carrying: tuple[int, ...], joints: int) -> Affine:
    """Wrenches of the carrying feet: all but the last are free, the last one follows from the base rows."""
    free = 6 * (len(carrying) - 1)
    matrix = np.zeros((free + 6, joints + free))
    weight = dynamics.mass_matrix[0, 0] * GRAVITY
    matrix[:free, joints:] = weight * np.eye(free)
    offset = np.zeros(free + 6)
    base = acceleration.then(dynamics.mass_matrix[_BASE])
    needed, bias = base.matrix, base.offset + dynamics.nonlinear_effects[_BASE]
    for i, foot in enumerate(carrying[:-1]):
        lever = weight * dynamics.sole_jacobian[foot, :, _BASE].T
        needed[:, joints + 6 * i : joints + 6 * i + 6] -= lever
    to_last = np.linalg.inv(dynamics.sole_jacobian[carrying[-1], :, _BASE].T)
    matrix[free:], offset[free:] = to_last @ needed, to_last @ bias
    return Affine(matrix, offset)


def _torques(dynamics: Dynamics, acceleration: Affine, wrench: Affine, carrying: tuple[int, ...]) -> Affine:
    """tau_s = H_s a + C_s v + tau_g,s - J_c,s^T f_c (Eq. 33)."""
    lever = dynamics.sole_jacobian[list(carrying)][:, :, 6:].reshape(6 * len(carrying), -1).T
    moved = acceleration.then(dynamics.mass_matrix[6:])
    borne = wrench.then(lever)
    offset = moved.offset + dynamics.nonlinear_effects[6:] - borne.offset
    return Affine(moved.matrix - borne.matrix, offset)
