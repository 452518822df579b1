"""Eqs. 24 to 26 by their optimality conditions, by a quadratic program and by Kajita's own partition."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from momentum_lab.control.qp import QuadraticProgram, solve
from momentum_lab.momentum.resolved import null_space, resolved_rates
from momentum_lab.momentum.wrench import skew
from momentum_lab.robot.state import Dynamics
from tests.conftest import assert_close

ALL = (True,) * 6
# Section 5.3.1: linear momentum and the angular momentum about the vertical.
KAJITA = (True, True, True, False, False, True)
STATES = 20


def question(dynamics: Dynamics, rng: np.random.Generator, feet=(0, 1)) -> dict[str, np.ndarray]:
    """Feet that move, a momentum and a reference, all of ordinary size."""
    size = dynamics.state.v.size
    return {
        "constraint_map": dynamics.sole_jacobian[list(feet)].reshape(-1, size),
        "constraint_velocity": rng.normal(scale=0.1, size=6 * len(feet)),
        "centroidal_map": dynamics.centroidal_map,
        "momentum": rng.normal(scale=10.0, size=6),
        "reference": rng.normal(scale=0.3, size=size),
    }


def nearest_to_reference(asked: dict[str, np.ndarray], rows: np.ndarray) -> np.ndarray:
    """The same rates by Lagrange's multipliers: v - v_ref = E^T mu with E v = e, E = [J_c; S A_G]."""
    equations = np.vstack([asked["constraint_map"], asked["centroidal_map"][rows]])
    goals = np.concatenate([asked["constraint_velocity"], asked["momentum"][rows]])
    size, count = asked["reference"].size, len(equations)
    system = np.block([[np.eye(size), equations.T], [equations, np.zeros((count, count))]])
    return np.linalg.solve(system, np.concatenate([asked["reference"], goals]))[:size]


@pytest.mark.parametrize("controlled", [ALL, KAJITA, (False,) * 6, (True, False, False, False, True, False)])
def test_feet_momentum_and_reference_in_this_order(random_dynamics, rng, controlled):
    """Feet to 1e-9, momentum of the controlled rows to 1e-7, and Lagrange's answer for the rest."""
    rows = np.array(controlled)
    for dynamics in random_dynamics[:STATES]:
        asked = question(dynamics, rng)
        rates = resolved_rates(**asked, controlled=controlled)
        assert_close(asked["constraint_map"] @ rates, asked["constraint_velocity"], 1e-9)
        assert_close((asked["centroidal_map"] @ rates)[rows], asked["momentum"][rows], 1e-7)
        assert_close(rates, nearest_to_reference(asked, rows), 1e-8)


def test_any_subset_of_the_six_directions_is_met(random_dynamics, rng):
    asked = question(random_dynamics[0], rng)
    for controlled in itertools.product((True, False), repeat=6):
        rows = np.array(controlled)
        rates = resolved_rates(**asked, controlled=controlled)
        assert_close((asked["centroidal_map"] @ rates)[rows], asked["momentum"][rows], 1e-6)


def test_the_quadratic_program_has_the_same_answer(random_dynamics, rng):
    """The chapter's practical way: min |v - v_ref|^2 subject to J_c v = v_c and A_G v = h_d, by DAQP."""
    for dynamics in random_dynamics[:STATES]:
        asked = question(dynamics, rng)
        size, free = dynamics.state.v.size, np.full(dynamics.state.v.size, np.inf)
        goals = np.concatenate([asked["constraint_velocity"], asked["momentum"]])
        program = QuadraticProgram(
            hessian=np.eye(size),
            gradient=-asked["reference"],
            matrix=np.vstack([asked["constraint_map"], asked["centroidal_map"]]),
            lower=np.concatenate([-free, goals]),
            upper=np.concatenate([free, goals]),
        )
        assert_close(resolved_rates(**asked), solve(program).x, 1e-9)


def test_the_least_squares_of_eq_25_has_the_same_answer(random_dynamics, rng):
    """min |h_d - A_G v|^2 + ridge |v - v_ref|^2 subject to J_c v = v_c.

    Along a direction of singular value s of A_G N the ridge keeps the part ridge / (s^2 + ridge) of the way.
    """
    for dynamics in random_dynamics[:STATES]:
        asked = question(dynamics, rng)
        momentum_map, size = asked["centroidal_map"], dynamics.state.v.size
        free, ridge = np.full(size, np.inf), 1e-4
        program = QuadraticProgram(
            hessian=momentum_map.T @ momentum_map + ridge * np.eye(size),
            gradient=-momentum_map.T @ asked["momentum"] - ridge * asked["reference"],
            matrix=asked["constraint_map"],
            lower=np.concatenate([-free, asked["constraint_velocity"]]),
            upper=np.concatenate([free, asked["constraint_velocity"]]),
        )
        rates = resolved_rates(**asked)
        slowest = np.linalg.svd(momentum_map @ null_space(asked["constraint_map"]))[1].min()
        way = np.linalg.norm(rates - asked["reference"])
        assert np.linalg.norm(solve(program).x - rates) < 1.001 * way * ridge / slowest**2


def test_a_momentum_out_of_reach_is_missed_as_little_as_possible(robot, random_dynamics, rng):
    """All joints but those of one leg locked: the gradient of Eq. 25 vanishes along every motion left."""
    for dynamics in random_dynamics[:STATES]:
        asked = question(dynamics, rng, feet=(0,))
        locked = np.delete(np.eye(robot.nv)[6:], robot.soles[0].joints[:3], axis=0)
        asked["constraint_map"] = np.vstack([asked["constraint_map"], locked])
        asked["constraint_velocity"] = np.concatenate([asked["constraint_velocity"], np.zeros(len(locked))])
        rates = resolved_rates(**asked)
        missed = asked["momentum"] - asked["centroidal_map"] @ rates
        assert np.abs(missed).max() > 0.1
        left = null_space(asked["constraint_map"])
        assert_close(missed @ asked["centroidal_map"] @ left, 0.0, 1e-7)


def test_a_reference_that_already_does_it_is_the_answer(random_dynamics, rng):
    for dynamics in random_dynamics[:STATES]:
        asked = question(dynamics, rng)
        asked["constraint_velocity"] = asked["constraint_map"] @ asked["reference"]
        asked["momentum"] = asked["centroidal_map"] @ asked["reference"]
        assert_close(resolved_rates(**asked), asked["reference"], 1e-8)


def kajita_rates(robot, dynamics: Dynamics, asked, rows: np.ndarray) -> np.ndarray:
    """Kajita's own road: leg rates from the feet (Eq. 24), base and free joints from the momentum.

    [l; k] = C xi + M theta'; legs: theta_i' = J_i^-1 (xi_Fi - R_i xi), with the base twist xi in world axes.
    """
    base, free = pelvis_twist_map(robot, dynamics), np.array(robot.upper_body)
    momentum_map = np.hstack(
        [dynamics.centroidal_map[:, :6] @ np.linalg.inv(base), dynamics.centroidal_map[:, 6:]]
    )
    twist_map, goal = momentum_map[:, :6].copy(), asked["momentum"].copy()
    legs = []
    for foot, sole in enumerate(robot.soles):
        jacobian = dynamics.sole_jacobian[foot][:, 6 + sole.joints]
        inverse = np.linalg.pinv(jacobian)
        carried = np.eye(6)
        carried[:3, 3:] = -skew(dynamics.sole_position[foot] - base_position(dynamics))
        velocity = asked["constraint_velocity"][6 * foot : 6 * foot + 6]
        leg = momentum_map[:, 6 + sole.joints]
        twist_map -= leg @ inverse @ carried
        goal -= leg @ inverse @ velocity
        legs.append((sole.joints, inverse, carried, velocity))
    unknown = np.hstack([twist_map, momentum_map[:, 6 + free]])[rows]
    reference = np.concatenate([base @ asked["reference"][:6], asked["reference"][6 + free]])
    inverse = np.linalg.pinv(unknown)
    answer = inverse @ goal[rows] + (np.eye(len(reference)) - inverse @ unknown) @ reference
    rates = np.zeros(robot.nv)
    rates[:6] = np.linalg.solve(base, answer[:6])
    rates[6 + free] = answer[6:]
    for joints, leg_inverse, carried, velocity in legs:
        rates[6 + joints] = leg_inverse @ (velocity - carried @ answer[:6])
    return rates


def base_position(dynamics: Dynamics) -> np.ndarray:
    return dynamics.state.q[:3]


def pelvis_twist_map(robot, dynamics: Dynamics) -> np.ndarray:
    """Base velocity in base axes -> in world axes."""
    x, y, z, w = dynamics.state.q[3:7]
    rotation = (w * w - x * x - y * y - z * z) * np.eye(3) + 2.0 * (
        np.outer((x, y, z), (x, y, z)) + w * skew(np.array((x, y, z)))
    )
    both = np.zeros((6, 6))
    both[:3, :3] = both[3:, 3:] = rotation
    return both


@pytest.mark.parametrize("controlled", [ALL, KAJITA])
def test_kajitas_partition_moves_feet_and_momentum_the_same(robot, random_dynamics, rng, controlled):
    """His rates obey Eqs. 24 and 15; they are those of Eq. 26 once these are told to be their reference."""
    rows = np.array(controlled)
    for dynamics in random_dynamics[:STATES]:
        asked = question(dynamics, rng)
        his = kajita_rates(robot, dynamics, asked, rows)
        assert_close(asked["constraint_map"] @ his, asked["constraint_velocity"], 1e-8)
        assert_close((asked["centroidal_map"] @ his)[rows], asked["momentum"][rows], 1e-6)
        assert_close(resolved_rates(**{**asked, "reference": his}, controlled=controlled), his, 1e-7)
        ours = resolved_rates(**asked, controlled=controlled)
        again = kajita_rates(robot, dynamics, {**asked, "reference": ours}, rows)
        assert_close(again, ours, 1e-7)
