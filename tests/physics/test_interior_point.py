"""The contact of a robot that lies: the laws themselves, other solvers, and how little work it is."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
import pytest

from momentum_lab.physics import contact, simulator
from momentum_lab.physics.contact import Contacts, ContactSolution, solve_contact, solve_lying
from momentum_lab.physics.ground import Ground
from momentum_lab.physics.interior_point import cone_impulses, eliminated, products, until_boundary
from momentum_lab.physics.simulator import Simulator
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.posture import standing_posture
from momentum_lab.robot.state import State
from tests.conftest import assert_close
from tests.physics.problems import least_contact_energy

DT = 1e-3
PRECISION = 1e-8
Arguments = tuple[np.ndarray, np.ndarray, np.ndarray, Contacts, float]


@lru_cache(maxsize=2)
def lying(robot: RobotModel) -> list[tuple[Arguments, ContactSolution]]:
    """What was solved for, tick by tick, while a limp robot that leans forward falls, and lies for a second."""
    solved: list[tuple[Arguments, ContactSolution]] = []

    def noting(*arguments) -> ContactSolution:
        solution = solve_lying(*arguments)
        solved.append((arguments, solution))
        return solution

    state = State(standing_posture(robot), np.zeros(robot.nv))
    state.v[0] = 0.3
    world = Simulator(robot, Ground.level(2, robot.spec.friction), DT)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(simulator, "solve_lying", noting)
        for _ in range(2500):
            damping = -robot.effort_limit * state.v[6:] / 6.0
            state = world.step(robot.at(state), damping, (), 0.0).state
    return solved


def terms(arguments: Arguments) -> tuple[np.ndarray, np.ndarray]:
    """W and g by plain linear algebra."""
    mass_matrix, impulse, velocity, contacts, _ = arguments
    J = contacts.jacobian
    drift = J @ (velocity + np.linalg.solve(mass_matrix, impulse))
    drift[2::3] += contact.closing_speed(contacts.gap, DT)
    return J @ np.linalg.solve(mass_matrix, J.T), drift


def test_all_points_obey_signorini_and_coulomb(robot):
    """Every tick: carry or lift, within the cone, and what slides is braked fully against its sliding."""
    for arguments, solution in lying(robot):
        _, drift = terms(arguments)
        contacts, impulse = arguments[3], solution.impulse
        velocity = (contacts.jacobian @ solution.velocity).reshape(-1, 3)
        opening = velocity[:, 2] + contact.closing_speed(contacts.gap, DT)
        most = contacts.friction * impulse[:, 2]
        speed = np.linalg.norm(velocity[:, :2], axis=1)
        braking = most * speed + (impulse[:, :2] * velocity[:, :2]).sum(axis=1)
        scale = 1e-10 * np.abs(drift).max()  # rounding of the way over generalized velocities
        assert impulse[:, 2].min() >= 0.0
        assert (np.linalg.norm(impulse[:, :2], axis=1) - most).max() <= 1e-12
        assert opening.min() > -PRECISION - scale
        assert np.abs(impulse[:, 2] * opening).max() < 2 * PRECISION + scale
        assert np.abs(braking).max() < 2 * PRECISION + scale


@pytest.mark.parametrize("opening", [0.11, 1.0, 10.0])
def test_a_point_that_hovers_is_not_touched_at_all(opening):
    """A fall begins with the first touch of another body than the feet: next to nothing would be a fall."""
    drift = np.array([0.3, 0.0, -1.0, 0.0, 0.2, opening])
    impulse, violation, _ = cone_impulses(np.eye(6), drift, np.array([0.7, 0.7]), PRECISION)
    assert violation <= PRECISION
    assert abs(impulse[2] - 1.0) < 2 * PRECISION  # the other one carries what it has to
    assert np.array_equal(impulse[3:], np.zeros(3))


def test_velocities_are_those_of_pinocchios_admm(robot):
    """Where that converges; it is right to 1e-6 m/s of its points, which light links multiply."""
    compared = 0
    for arguments, solution in lying(robot)[::50]:
        delassus, drift = terms(arguments)
        impulse, residual, iterations = contact._by_admm(delassus, drift, arguments[3].friction)
        if iterations < 2000 and residual < 1e-6:
            other, own = (delassus @ each + drift for each in (impulse, solution.impulse.ravel()))
            assert_close(own, other, 2e-4)
            compared += 1
    assert compared > 10


def test_impulses_at_rest_are_those_of_an_interior_point_method_for_cones(rng):
    """Clarabel's, for stacks of points that share a body: the program is Coulomb's law when nothing slides."""
    for _ in range(20):
        points = int(rng.integers(1, 12))
        rows = rng.normal(size=(3 * points, 3 * points))
        delassus, friction = rows @ rows.T / points, np.full(points, 5.0)
        drift = -delassus @ np.tile([0.0, 0.0, 1.0], points)
        answer, violation, _ = cone_impulses(delassus, drift, friction, 1e-10)
        assert violation <= 1e-10
        assert_close(answer, least_contact_energy(delassus, drift, friction).ravel(), 1e-5)


def test_a_fallen_robot_takes_few_iterations(robot):
    """A dozen systems of equations a tick, where ADMM took hundreds, and hardly ever its help."""
    iterations = np.array([solution.iterations for _, solution in lying(robot)])
    assert len(iterations) > 1000
    assert np.median(iterations) <= 14
    assert np.mean(iterations > 20) < 1e-3


def test_a_fallen_robot_is_solved_for_with_points_near_the_floor_only(robot):
    """None that is farther than a centimetre, also of soles on edge."""
    assert all(arguments[3].gap.max() < 0.01 for arguments, _ in lying(robot))
    assert min(len(arguments[3].gap) for arguments, _ in lying(robot)[-500:]) > 3


def test_admm_helps_when_there_is_no_answer(robot, monkeypatch):
    arguments, solution = lying(robot)[-1]
    monkeypatch.setattr(contact, "cone_impulses", lambda *_: (np.zeros(0), np.nan, 40))
    J = arguments[3].jacobian
    assert_close(J @ solve_lying(*arguments).velocity, J @ solution.velocity, 2e-4)


def test_it_says_when_it_finds_no_answer():
    nothing = cone_impulses(np.eye(3), np.array([0.0, 0.0, -1.0]), np.array([0.5]), 0.0)
    assert nothing[1] > 0.0
    unknown = cone_impulses(np.full((3, 3), np.nan), np.zeros(3), np.array([0.5]), PRECISION)
    assert not unknown[1] <= PRECISION


@pytest.mark.parametrize("velocity", [[0.0, 0.0, 0.0], [0.6, -0.8, 0.0], [0.0, 0.0, -2.0], [1.0, 0.0, 1.0]])
@pytest.mark.parametrize("gap", [0.0, 4e-4, -1e-3])
def test_one_point_moves_as_by_the_solver_of_soles(velocity, gap):
    contacts = Contacts(np.eye(6, 3), np.eye(3, 6), np.array([gap]), np.array([0.4]), np.zeros(6))
    arguments = 7.0 * np.eye(3), DT * np.array([3.0, 0.0, -70.0]), np.array(velocity), contacts, DT
    assert_close(solve_lying(*arguments).velocity, solve_contact(*arguments).velocity, 3e-8)


def inside(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Three points well inside their cones (3, 7), and their friction."""
    points, friction = rng.uniform(-0.3, 0.3, size=(3, 7)), rng.uniform(0.4, 1.0, size=3)
    points[:, [2, 5, 6]] = rng.uniform(1.5, 2.0, size=(3, 3))
    return points, friction


def differentiated(function: Callable[[np.ndarray], np.ndarray], points: np.ndarray) -> np.ndarray:
    """Central differences of a function of points by every one of their 7 numbers (3, ..., 7)."""
    steps = 1e-6 * np.eye(7)
    return np.stack([(function(points + step) - function(points - step)) / 2e-6 for step in steps], axis=-1)


def test_elimination_of_the_slip_agrees_with_finite_differences(rng):
    """Whatever impulses change by, with d(u, s) = E w - D d(b, n) there is a d psi that changes products by w."""
    points, friction = inside(rng)
    slopes = differentiated(lambda moved: products(moved, friction), points)
    answer, stiffness = eliminated(points, friction)
    for i in range(3):
        impulse, wanted = rng.normal(size=3), rng.normal(size=4)
        speed = answer[i] @ wanted - stiffness[i] @ impulse
        missing = wanted - slopes[i] @ np.concatenate([impulse, speed, [0.0]])
        slip = slopes[i][:, 6] @ missing / (slopes[i][:, 6] @ slopes[i][:, 6])
        assert_close(slopes[i][:, 6] * slip, missing, 1e-8)


def test_the_way_to_the_boundary_of_a_cone(rng):
    for _ in range(200):
        point, move = rng.normal(size=3), rng.normal(size=3)
        point[0] = np.linalg.norm(point[1:]) + rng.uniform(0.0, 1.0)
        way = until_boundary(*point, *move)
        before, after = (point + part * min(way, 1e6) * move for part in (0.999, 1.001))
        assert np.linalg.norm(before[1:]) <= before[0] + 1e-9
        assert way == np.inf or np.linalg.norm(after[1:]) > after[0]
