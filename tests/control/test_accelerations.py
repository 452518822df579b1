"""Eq. 34: accelerations that give the admissible momentum rate with the feet still."""

from __future__ import annotations

import dataclasses

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.control import accelerations
from momentum_lab.control.accelerations import MotionWeights, contact_constraint
from momentum_lab.control.qp import certify, solve, solve_reference
from momentum_lab.errors import SolverError
from momentum_lab.robot.state import State
from tests.conftest import assert_close
from tests.control.situations import (
    BOTH,
    G,
    accelerations_for,
    feet_for,
    goal,
    home,
    moments_of_a_push,
    null_space,
    swaying,
)

WEIGHTS = MotionWeights(
    momentum=0.99, pelvis=1.0, stiffness=25.0, damping=10.0, contact_rate=50.0, joint_limit_rate=25.0
)
# The chapter's own Eq. 34: an upright pelvis is an extension and competes with the momentum.
CHAPTER = dataclasses.replace(WEIGHTS, pelvis=0.0)
STANCES = [BOTH, (0,), (1,)]


def modest_rate(robot, rng) -> np.ndarray:
    """A momentum rate of the size of recovery from a small push, with a CoP well inside each sole."""
    return robot.mass * rng.uniform(-0.1, 0.1, 6) * [1.0, 1.0, 1.0, 0.5, 0.5, 0.1]


@pytest.fixture
def problems(monkeypatch):
    """Every quadratic program that is solved for accelerations."""
    seen = []

    def watching(problem):
        seen.append(problem)
        return solve(problem)

    monkeypatch.setattr(accelerations, "solve", watching)
    return seen


def test_the_contact_constraint_is_the_rate_of_the_sole_velocities(robot, rng):
    """Eq. 31, J_c a + dJ_c v by finite differences of the sole velocities; without error dv_c = 0."""
    dynamics = swaying(robot, rng)
    matrix, target = contact_constraint(dynamics, BOTH, goal(robot, dynamics), contact_rate=0.0)
    a, eps = rng.normal(size=robot.nv), 1e-5

    def sole_velocities(sign):
        v = dynamics.state.v + sign * eps * a
        q = robot.integrate(dynamics.state.q, sign * eps * (dynamics.state.v + 0.5 * sign * eps * a))
        moved = robot.at(State(q, v))
        return (moved.sole_jacobian @ v).ravel()

    numeric = (sole_velocities(1.0) - sole_velocities(-1.0)) / (2 * eps)
    assert_close(matrix @ a - target, numeric, 1e-5)


def test_feet_at_rest_and_flat_are_asked_for_nothing(robot):
    """Up to kappa^2 times the 20 micrometres and microradians that the posture is accurate to."""
    dynamics = home(robot)
    _, target = contact_constraint(dynamics, BOTH, goal(robot, dynamics), contact_rate=50.0)
    assert_close(target, np.zeros(12), 50.0**2 * 2e-5)


@pytest.mark.parametrize(
    ("twist", "row"), [((0, 0, 1e-3, 0, 0, 0), 2), ((0, 0, 0, 1e-3, 0, 0), 3), ((0, 0, 0, 0, 1e-3, 0), 4)]
)
def test_a_foot_that_is_off_the_ground_or_tilted_is_pulled_back(robot, twist, row):
    """The whole robot raised by 1 mm or tilted by 1 mrad about a sole: -kappa^2 times the error."""
    dynamics = home(robot)
    base = pin.XYZQUATToSE3(dynamics.state.q[:7])
    pivot = pin.SE3(np.eye(3), dynamics.sole_position[0])
    moved = pivot * pin.exp6(pin.Motion(np.array(twist, dtype=float))) * pivot.inverse() * base
    state = State(np.concatenate([pin.SE3ToXYZQUAT(moved), dynamics.state.q[7:]]), np.zeros(robot.nv))
    tilted = robot.at(state)
    _, target = contact_constraint(tilted, BOTH, goal(robot, tilted), contact_rate=50.0)
    assert target[row] == pytest.approx(-(50.0**2) * 1e-3, rel=0.05)


def test_a_foot_that_has_slipped_stays_there(robot):
    dynamics = home(robot)
    q = dynamics.state.q.copy()
    q[:2] += [0.3, -0.2]
    slipped = robot.at(State(q, dynamics.state.v))
    _, target = contact_constraint(slipped, BOTH, goal(robot, slipped), contact_rate=50.0)
    assert_close(target, np.zeros(12), 50.0**2 * 2e-5)


@pytest.mark.parametrize("stance", STANCES)
def test_stance_feet_get_exactly_the_acceleration_they_shall_have(robot, rng, stance):
    for _ in range(5):
        dynamics = swaying(robot, rng, stance)
        reference = goal(robot, dynamics, stance)
        matrix, target = contact_constraint(dynamics, stance, reference, WEIGHTS.contact_rate)
        feet = feet_for(robot, dynamics, modest_rate(robot, rng), stance)
        a = accelerations_for(robot, dynamics, feet, reference, WEIGHTS)
        assert_close(matrix @ a, target, 1e-6)


@pytest.mark.parametrize("stance", STANCES)
def test_the_momentum_rate_is_met_where_feet_and_momentum_are_independent(robot, rng, stance):
    """rank [J_c; A_G] = c + 6 and no joint near its limit: A_G a + dA_G v is the admissible rate."""
    for _ in range(5):
        dynamics = swaying(robot, rng, stance, speed=0.1)
        reference = goal(robot, dynamics, stance)
        jacobian = dynamics.sole_jacobian[list(stance)].reshape(-1, robot.nv)
        assert np.linalg.matrix_rank(np.vstack([jacobian, dynamics.centroidal_map])) == 6 * len(stance) + 6
        feet = feet_for(robot, dynamics, modest_rate(robot, rng), stance)
        a = accelerations_for(robot, dynamics, feet, reference, CHAPTER)
        missed = dynamics.centroidal_map @ a + dynamics.centroidal_bias - feet.momentum_rate
        assert np.abs(missed).max() < 1e-3 * robot.mass * G


def test_momentum_and_posture_together_are_met_in_double_support(robot, rng):
    """Feet, momentum and upper body are as many equations as unknowns: w_b does not matter (Eq. 34)."""
    dynamics = swaying(robot, rng, speed=0.1)
    reference, feet = goal(robot, dynamics), feet_for(robot, dynamics, modest_rate(robot, rng))
    wanted = 25.0 * (reference.posture - dynamics.state.q[7:]) - 10.0 * dynamics.state.v[6:]
    for weight in (0.9, 0.99):
        weights = dataclasses.replace(CHAPTER, momentum=weight)
        a = accelerations_for(robot, dynamics, feet, reference, weights)
        missed = dynamics.centroidal_map @ a + dynamics.centroidal_bias - feet.momentum_rate
        assert np.abs(missed).max() < 1e-3 * robot.mass * G
        assert_close(a[6 + robot.upper_body], wanted[robot.upper_body], 0.02)


def test_every_program_of_a_push_is_solved_like_the_reference_solves_it(robot, problems):
    """DAQP against Clarabel's interior point method, and the residuals of its answer.

    Bounds that yield are firm for the reference; where they have to yield the two are different questions.
    """
    for dynamics in moments_of_a_push(robot, every=60):
        rate = np.zeros(6)
        rate[:3] = -16.0 * robot.mass * (dynamics.com_in_world - goal(robot, dynamics).com)
        accelerations_for(robot, dynamics, feet_for(robot, dynamics, rate), goal(robot, dynamics), WEIGHTS)
    compared = 0
    for problem in problems:
        solution = solve(problem)
        certificate = certify(problem, solution.x, solution.multipliers)
        assert max(certificate.primal, certificate.dual) < 1e-7
        values = problem.values(solution.x)
        if (values > problem.lower - 1e-6).all() and (values < problem.upper + 1e-6).all():
            assert_close(solution.x, solve_reference(problem), 1e-3)
            compared += 1
    assert compared > 5


def test_the_answer_is_the_minimum_of_the_objective(robot, rng):
    """Eq. 34's objective, written out here, is flat in every direction that keeps the feet still."""
    dynamics = swaying(robot, rng, speed=0.2)
    reference, feet = goal(robot, dynamics), feet_for(robot, dynamics, modest_rate(robot, rng))
    best = accelerations_for(robot, dynamics, feet, reference, WEIGHTS)
    per_inertia = np.linalg.inv(dynamics.locked_inertia)
    joints, state = robot.upper_body, dynamics.state
    posture = 25.0 * (reference.posture - state.q[7:])[joints] - 10.0 * state.v[6:][joints]
    turn = pin.log3(dynamics.pelvis_rotation @ reference.pelvis_rotation.T)
    pelvis = -25.0 * turn - 10.0 * dynamics.pelvis_jacobian[3:] @ state.v

    def objective(a):
        missed = feet.momentum_rate - dynamics.centroidal_map @ a - dynamics.centroidal_bias
        momentum = np.sum((missed[:3] / robot.mass) ** 2) + np.sum((per_inertia @ missed[3:]) ** 2)
        upper = np.sum((posture - a[6 + joints]) ** 2)
        trunk = np.sum((pelvis - dynamics.pelvis_jacobian[3:] @ a - dynamics.pelvis_bias[3:]) ** 2)
        return 0.99 * momentum + 0.01 * (upper + trunk) + 1e-6 * a @ a

    free = null_space(dynamics.sole_jacobian.reshape(-1, robot.nv))
    for direction in free.T:
        slope = (objective(best + 0.1 * direction) - objective(best - 0.1 * direction)) / 0.2
        assert abs(slope) < 1e-5


def test_a_joint_brakes_before_its_limit(robot):
    """Near its limit, moving towards it and wanted beyond it: the critically damped acceleration, not more.

    The joint is to turn back 0.03 rad before the stop, and is 0.02 rad beyond that point already.
    """
    dynamics = home(robot)
    joint = robot.upper_body[0]
    q, v = dynamics.state.q.copy(), np.zeros(robot.nv)
    q[7 + joint] = robot.position_upper[joint] - 0.01
    v[6 + joint] = 0.3
    close = robot.at(State(q, v))
    posture = q[7:].copy()
    posture[joint] += 1.0
    reference = dataclasses.replace(goal(robot, close), posture=posture)
    a = accelerations_for(robot, close, feet_for(robot, close, np.zeros(6)), reference, WEIGHTS)
    assert a[6 + joint] == pytest.approx(25.0**2 * (0.01 - 0.03) - 2 * 25.0 * 0.3, abs=1e-2)


def test_the_answer_turns_with_the_robot(robot, rng):
    """Turned about the vertical, the same joint accelerations: the momentum error is weighed in no special axes."""
    dynamics = swaying(robot, rng)
    turn = pin.exp3(np.array([0.0, 0.0, 2.0]))
    q = dynamics.state.q.copy()
    q[:3] = turn @ q[:3]
    q[3:7] = pin.Quaternion(turn @ pin.Quaternion(q[3:7]).toRotationMatrix()).coeffs()
    turned = robot.at(State(q, dynamics.state.v))
    rate = modest_rate(robot, rng)
    answers = []
    for state, asked in ((dynamics, rate), (turned, np.concatenate([turn @ rate[:3], turn @ rate[3:]]))):
        feet = feet_for(robot, state, asked)
        answers.append(accelerations_for(robot, state, feet, goal(robot, state), WEIGHTS))
    assert_close(answers[1], answers[0], 1e-6)


def test_feet_that_cannot_stay_are_named(robot, monkeypatch):
    """A robot whose left foot is asked to rise and to stay at once."""
    dynamics = home(robot)
    both_ways = dataclasses.replace(dynamics, sole_jacobian=dynamics.sole_jacobian.copy())
    both_ways.sole_jacobian[1] = both_ways.sole_jacobian[0]
    both_ways.sole_position[1, 2] += 0.01
    feet = feet_for(robot, dynamics, np.zeros(6))
    with pytest.raises(SolverError, match=r"cannot be met: contact of the (left|right) foot \(short by"):
        accelerations_for(robot, both_ways, feet, goal(robot, dynamics), WEIGHTS)
