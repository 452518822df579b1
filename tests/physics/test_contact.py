"""One law of contact: Signorini and Coulomb, against closed forms, other solvers and itself."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.errors import SimulationError
from momentum_lab.physics.contact import Contacts, solve_contact
from tests.conftest import assert_close
from tests.physics.problems import least_contact_energy, problem_at
from tests.runs import PUSH_END, PUSH_START, forward_push, played

DT = 1e-3
G = 9.81
MASS = 7.0
MU = 0.4
# Velocities are right to 1e-9 m/s, which is 7e-6 N for 7 kg in a millisecond, times the levers of a box.
SOLVER = 1e-4


def point_mass(velocity: list[float], force: list[float], gap: float = 0.0, friction: float = MU):
    """A step of a point of 7 kg under gravity and a force."""
    weight = np.array(force) - [0.0, 0.0, MASS * G]
    contacts = Contacts(np.eye(6, 3), np.eye(3, 6), np.array([gap]), np.array([friction]), np.zeros(6))
    return solve_contact(MASS * np.eye(3), DT * weight, np.array(velocity), contacts, DT)


def test_a_resting_point_is_carried():
    step = point_mass([0.0, 0.0, 0.0], [0.0, 0.0, 0.0])
    assert_close(step.impulse / DT, [[0.0, 0.0, MASS * G]], SOLVER)
    assert_close(step.velocity, np.zeros(3), 1e-8)


def test_a_sliding_point_is_braked_by_mu_g():
    """m dv/dt = -mu m g, and it does not take off."""
    step = point_mass([0.6, -0.8, 0.0], [0.0, 0.0, 0.0])
    assert_close(step.impulse / DT, [[-0.6 * MU * MASS * G, 0.8 * MU * MASS * G, MASS * G]], SOLVER)
    assert_close(step.velocity, np.array([0.6, -0.8, 0.0]) * (1.0 - MU * G * DT), 1e-8)


def test_friction_holds_what_is_inside_the_cone():
    held = 0.9 * MU * MASS * G
    step = point_mass([0.0, 0.0, 0.0], [held, 0.0, 0.0])
    assert_close(step.velocity, np.zeros(3), 1e-8)
    assert_close(step.impulse / DT, [[-held, 0.0, MASS * G]], SOLVER)


def test_what_is_outside_the_cone_slides_with_the_rest():
    pull = 1.5 * MU * MASS * G
    step = point_mass([0.0, 0.0, 0.0], [0.0, pull, 0.0])
    assert_close(step.velocity, [0.0, DT * 0.5 * MU * G, 0.0], 1e-8)


def test_a_sliding_point_that_can_stop_stops():
    """A speed below mu g dt is gone within the step; friction never turns it around."""
    step = point_mass([0.5 * MU * G * DT, 0.0, 0.0], [0.0, 0.0, 0.0])
    assert_close(step.velocity, np.zeros(3), 1e-8)


def test_the_ground_does_not_pull():
    step = point_mass([0.0, 0.0, 0.0], [3.0, 0.0, 2.0 * MASS * G])
    assert_close(step.impulse, np.zeros((1, 3)), 1e-8)
    assert_close(step.velocity, [DT * 3.0 / MASS, 0.0, DT * G], 1e-8)


def test_a_gap_closes_exactly_and_a_far_ground_is_not_felt():
    landing = point_mass([0.0, 0.0, -1.0], [0.0, 0.0, 0.0], gap=4e-4)
    assert landing.velocity[2] == pytest.approx(-4e-4 / DT, abs=1e-8)
    falling = point_mass([0.0, 0.0, -1.0], [0.0, 0.0, 0.0], gap=5e-3)
    assert_close(falling.velocity, [0.0, 0.0, -1.0 - G * DT], 1e-8)


def test_a_penetration_is_undone_gently():
    """Within the step if 1 cm/s is enough, else at 50 per second, never faster than 0.2 m/s."""
    for gap, speed in ((-1e-6, 1e-3), (-1e-4, 0.01), (-1e-3, 0.05), (-0.5, 0.2)):
        step = point_mass([0.0, 0.0, 0.0], [0.0, 0.0, 0.0], gap=gap)
        assert step.velocity[2] == pytest.approx(speed, abs=1e-8)


HALF, HEIGHT = 0.1, 0.3


def box(force: list[float], velocity: np.ndarray | None = None, friction: float = 0.9):
    """A step of a box of 7 kg on four corners, its CoM 0.3 m high, pushed at the CoM."""
    inertia = np.diag([MASS] * 3 + [0.2, 0.2, 0.1])
    rows = []
    for x, y in ((-HALF, -HALF), (HALF, -HALF), (HALF, HALF), (-HALF, HALF)):
        arm = np.array([x, y, -HEIGHT])
        rows.append(np.hstack([np.eye(3), np.cross(np.eye(3), arm).T]))
    contacts = Contacts(np.eye(6), np.vstack(rows), np.zeros(4), np.full(4, friction), np.zeros(6))
    free = DT * np.array([*force, 0.0, 0.0, 0.0])
    free[2] -= DT * MASS * G
    return solve_contact(inertia, free, np.zeros(6) if velocity is None else velocity, contacts, DT)


def test_a_box_leans_on_the_corners_ahead():
    """Moments about the rear edge: the front pair carries m g / 2 + F h / (2 a)."""
    force = 0.8 * MASS * G * HALF / HEIGHT
    step = box([force, 0.0, 0.0])
    front = step.impulse[1:3, 2].sum() / DT
    assert front == pytest.approx(MASS * G / 2 + force * HEIGHT / (2 * HALF), abs=SOLVER)
    assert_close(step.velocity, np.zeros(6), 1e-7)


def test_a_box_tips_when_the_force_leaves_the_base():
    """F h > m g a: it turns about its front edge, which stays where it is; the rear lifts and carries nothing."""
    force = 1.3 * MASS * G * HALF / HEIGHT
    step = box([force, 0.0, 0.0])
    turn = (force * HEIGHT - MASS * G * HALF) / (0.2 + MASS * (HEIGHT**2 + HALF**2))
    assert_close(step.velocity, [DT * turn * HEIGHT, 0.0, DT * turn * HALF, 0.0, DT * turn, 0.0], 1e-7)
    assert_close(step.impulse[[0, 3]], np.zeros((2, 3)), 1e-7)


def test_a_sliding_box_is_braked_by_mu_g():
    velocity = np.array([0.0, 2.0, 0.0, 0.0, 0.0, 0.0])
    step = box([0.0, 0.0, 0.0], velocity, friction=0.2)
    assert_close(step.velocity, [0.0, 2.0 - 0.2 * G * DT, 0.0, 0.0, 0.0, 0.0], 1e-7)
    assert_close(step.impulse[:, 1], -0.2 * step.impulse[:, 2], 1e-7)


def test_no_contact_is_free_motion():
    nothing = Contacts(np.zeros((0, 3)), np.zeros((0, 0)), np.zeros(0), np.zeros(0), np.zeros(0))
    step = solve_contact(MASS * np.eye(3), np.array([1.0, 2.0, 3.0]), np.ones(3), nothing, DT)
    assert_close(step.velocity, 1.0 + np.array([1.0, 2.0, 3.0]) / MASS, 1e-12)
    assert step.impulse.shape == (0, 3)


@pytest.mark.parametrize("number", [np.nan, -1.0])
def test_a_mass_matrix_that_is_none_is_said(number):
    mass_matrix = MASS * np.eye(3)
    mass_matrix[0, 0] = number
    contacts = Contacts(np.eye(6, 3), np.eye(3, 6), np.zeros(1), np.array([MU]), np.zeros(6))
    with pytest.raises(SimulationError, match="mass matrix is not positive definite"):
        solve_contact(mass_matrix, np.zeros(3), np.zeros(3), contacts, DT)


def test_standing_forces_are_those_of_a_robot_bolted_to_the_ground(robot):
    """While nothing slips or lifts: [H, -J^T; J, 0] [v+; l] = [H v + p; target], by least squares."""
    problem = problem_at(played(robot, forward_push(robot)), row=100)
    J, H = problem.contacts.jacobian, problem.mass_matrix
    rows, nv = J.shape
    kkt = np.block([[H, -J.T], [J, np.zeros((rows, rows))]])
    target = np.zeros(rows)
    target[2::3] = -problem.closing_speed
    right = np.concatenate([H @ problem.dynamics.state.v + problem.free_impulse, target])
    bolted = np.linalg.lstsq(kkt, right, rcond=1e-10)[0][nv:].reshape(-1, 3)
    assert_close(problem.foot_wrenches(problem.solve().impulse), problem.foot_wrenches(bolted), 1e-3)


def test_foot_wrenches_equal_those_of_an_interior_point_method(robot):
    """Through the push, while the heels of G1 lift and come down, with second-order cones in both solvers.

    A convex program is Coulomb's law only while nothing slides, so ticks with sliding are left out.
    """
    session, compared, lifted = played(robot, forward_push(robot)), 0, 0.0
    for row in range(round(1e3 * PUSH_START) - 5, round(1e3 * PUSH_END) + 100, 6):
        problem = problem_at(session, row)
        solution = problem.solve()
        J = problem.contacts.jacobian
        speed = np.linalg.norm((J @ solution.velocity).reshape(-1, 3)[:, :2], axis=1)
        if speed.max() > 1e-4:
            continue
        drift = J @ problem.free_velocity
        drift[2::3] += problem.closing_speed
        delassus = J @ np.linalg.solve(problem.mass_matrix, J.T)
        reference = least_contact_energy(delassus, drift, problem.contacts.friction)
        assert_close(problem.foot_wrenches(solution.impulse), problem.foot_wrenches(reference), 1e-3)
        compared, lifted = compared + 1, max(lifted, problem.contacts.gap.max())
    assert compared > 15
    assert lifted > 1e-5 or robot.spec.name == "talos"


def test_a_step_of_standing_or_a_push_is_solved_in_few_iterations(robot):
    """Corners of one flat foot ask for one motion: half of the ticks need 30 iterations, none the whole allowance."""
    session = played(robot, forward_push(robot))
    iterations = [problem_at(session, row).solve().iterations for row in range(0, 1500, 10)]
    assert np.median(iterations) < 30
    assert np.percentile(iterations, 99) < 1000
