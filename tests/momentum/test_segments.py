"""Eq. 60 on random states: Jacobians and biases of the links' CoMs by differences."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.momentum.segments import segments
from momentum_lab.robot.state import State
from tests.conftest import assert_close

STEP = 1e-6


def test_all_mass_is_there(robot, random_states):
    links = segments(robot, random_states[0])
    assert links.mass.sum() == pytest.approx(robot.mass, abs=1e-9)


def test_their_mean_is_the_centre_of_mass(robot, random_states, random_dynamics):
    """Eq. 14."""
    for state, dynamics in zip(random_states, random_dynamics, strict=True):
        links = segments(robot, state)
        assert_close(links.mass @ links.position / robot.mass, dynamics.com_in_world, 1e-11)


def test_velocities_are_differences_of_positions(robot, random_states):
    for state in random_states[:10]:
        links = segments(robot, state)
        ahead, behind = (
            segments(robot, State(pin.integrate(robot.model, state.q, s * STEP * state.v), state.v))
            for s in (1.0, -1.0)
        )
        assert_close(links.linear_jacobian @ state.v, (ahead.position - behind.position) / (2 * STEP), 1e-7)
        assert_close(links.angular_jacobian @ state.v, links.spin, 1e-12)


def test_accelerations_are_differences_of_velocities(robot, random_states, rng):
    """y_r'' = J_r a + Psi_r along a motion with generalized acceleration a."""
    for state in random_states[:10]:
        a = rng.normal(size=robot.nv)
        found = segments(robot, state).stacked_acceleration(a).reshape(6, -1)
        after, before = (_velocities(robot, state, a, s * STEP) for s in (1.0, -1.0))
        expected = (after - before) / (2 * STEP)
        assert_close(found.T, expected, 2e-6)


def _velocities(robot, state: State, a: np.ndarray, time: float) -> np.ndarray:
    """Velocities of the links' CoMs and their spins (N, 6), a moment later, to second order in time."""
    q = pin.integrate(robot.model, state.q, time * state.v + 0.5 * time**2 * a)
    links = segments(robot, State(q, state.v + time * a))
    return np.hstack([links.linear_jacobian @ (state.v + time * a), links.spin])


def test_links_and_centroidal_map_give_the_same_momentum_rate(robot, random_states, random_dynamics, rng):
    """Sum of m r'' and of (r - r_G) x m r'' + I omega' + omega x I omega against Eq. 20."""
    for state, dynamics in zip(random_states, random_dynamics, strict=True):
        a = rng.normal(size=robot.nv)
        links = segments(robot, state)
        rate = links.stacked_acceleration(a).reshape(6, -1)
        force = links.mass[:, None] * rate[:3].T
        moment = np.cross(links.position - dynamics.com_in_world, force)
        moment += np.einsum("nij,nj->ni", links.inertia, rate[3:].T)
        moment += np.cross(links.spin, np.einsum("nij,nj->ni", links.inertia, links.spin))
        expected = dynamics.centroidal_map @ a + dynamics.centroidal_bias
        assert_close(np.concatenate([force.sum(0), moment.sum(0)]), expected, 1e-10 * robot.mass * 9.81)
