"""Eqs. 48 to 59: the CoP bounds over links and over the centroidal momentum, against each other."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.momentum.ground import cop_from_momentum_rate
from momentum_lab.momentum.segment_cop import (
    Edges,
    centroidal_rows,
    link_moments,
    polygon_edges,
    rectangle_edges,
    segment_cop,
    segment_rows,
)
from momentum_lab.momentum.segments import segments
from momentum_lab.momentum.support import support_margin, support_polygon
from momentum_lab.robot.state import State
from tests.conftest import assert_close

G = 9.81
GROUND = -0.3
# A foot's rectangle, and a support of two feet that is none.
LOWER, UPPER = np.array([-0.1, -0.06]), np.array([0.09, 0.05])
HULL = np.array([[-0.1, -0.15], [0.09, -0.14], [0.11, 0.1], [-0.05, 0.16]])


@pytest.fixture(scope="module")
def cases(robot, random_states, random_dynamics):
    """Links, dynamics, an acceleration with some weight on the ground, and the momentum rate (Eq. 20)."""
    rng = np.random.default_rng(2)
    found = []
    for state, dynamics in zip(random_states, random_dynamics, strict=True):
        rate = np.zeros(6)
        while abs(rate[2] / (robot.mass * G) + 1.0) < 0.1 or not rate.any():
            a = 5.0 * rng.normal(size=robot.nv)
            rate = dynamics.centroidal_map @ a + dynamics.centroidal_bias
        found.append((segments(robot, state), dynamics, a, rate))
    return found


def test_cop_of_the_links_is_that_of_the_momentum_rate(robot, cases):
    """Eqs. 48, 49 with the gyroscopic moment against Eq. 21, both on a ground that is not at zero."""
    for links, dynamics, a, rate in cases:
        expected = cop_from_momentum_rate(rate, dynamics.com_in_world, robot.mass, GROUND)
        found = segment_cop(links, links.stacked_acceleration(a), GROUND)
        assert_close(found, expected, 1e-8 * max(1.0, np.abs(expected).max()))


def test_moments_of_the_links_change_their_spins(robot, cases):
    """Eqs. 50, 51 with their gyroscopic moment: d/dt (I_i omega_i), by central differences along the motion."""
    eps = 1e-5

    def spins(state, a, time):
        q = robot.integrate(state.q, time * (state.v + 0.5 * time * a))
        moved = segments(robot, State(q, state.v + time * a))
        return np.einsum("nij,nj->ni", moved.inertia, moved.spin)

    for links, dynamics, a, _ in cases[:10]:
        numeric = (spins(dynamics.state, a, eps) - spins(dynamics.state, a, -eps)) / (2 * eps)
        found = link_moments(links, links.stacked_acceleration(a).reshape(6, -1)[3:].T)
        assert_close(found, numeric, 1e-5)


def test_without_the_gyroscopic_moment_it_is_not(robot, cases):
    """Eqs. 50 and 51 as printed: diagonal inertia, no omega x I omega."""
    worst = 0.0
    for links, dynamics, a, rate in cases:
        y = links.stacked_acceleration(a).reshape(6, -1)
        tau = np.einsum("nii,in->ni", links.inertia, y[3:]).sum(0)
        force = links.mass * (y[2] + G)
        height = links.mass * (links.position[:, 2] - GROUND)
        x = (force @ links.position[:, 0] - height @ y[0] - tau[1]) / force.sum()
        exact = cop_from_momentum_rate(rate, dynamics.com_in_world, robot.mass, GROUND)
        worst = max(worst, abs(x - exact[0]))
    assert worst > 1e-3


def test_segment_rows_are_the_normal_force_times_the_distance(robot, cases):
    """H_r y_r'' - K_r = f_z [p_x - x_max, x_min - p_x, p_y - y_max, y_min - p_y]."""
    for links, dynamics, a, rate in cases:
        H, K = segment_rows(links, rectangle_edges(LOWER, UPPER), GROUND)
        p = cop_from_momentum_rate(rate, dynamics.com_in_world, robot.mass, GROUND)
        beyond = np.array([p[0] - UPPER[0], LOWER[0] - p[0], p[1] - UPPER[1], LOWER[1] - p[1]])
        fz = rate[2] + robot.mass * G
        scale = robot.mass * G + np.abs(rate).max()
        assert_close((H @ links.stacked_acceleration(a) - K) / scale, fz * beyond / scale, 1e-8)


def test_the_printed_rows_of_equation_53(cases):
    """Row 1 by the printed blocks: -(m r_z) | 0 | m r_x - x_max m | 0 | -I_y, K = g (m x_max - m^T r_x)."""
    for links, *_ in cases[:5]:
        H, K = segment_rows(links, rectangle_edges(LOWER, UPPER))
        m, r = links.mass, links.position
        blocks = H[0].reshape(6, -1)
        assert_close(blocks[0], -m * r[:, 2], 1e-12)
        assert_close(blocks[1], 0.0 * m, 0.0)
        assert_close(blocks[2], m * r[:, 0] - UPPER[0] * m, 1e-12)
        assert_close(blocks[4], -links.inertia[:, 1, 1], 1e-12)
        gyroscopic = np.cross(links.spin, np.einsum("nij,nj->ni", links.inertia, links.spin)).sum(0)
        assert K[0] == pytest.approx(G * (m.sum() * UPPER[0] - m @ r[:, 0]) + gyroscopic[1], abs=1e-9)


@pytest.mark.parametrize("edges", [rectangle_edges(LOWER, UPPER), polygon_edges(HULL)])
def test_both_forms_agree(robot, cases, edges: Edges):
    """H_r (J_r a + Psi_r) <= K_r and G a <= h are the same rows in a: coefficients and bounds (Eq. 60)."""
    for links, dynamics, a, rate in cases:
        H, K = segment_rows(links, edges, GROUND)
        matrix, bound = centroidal_rows(
            dynamics.centroidal_map,
            dynamics.centroidal_bias,
            dynamics.com_in_world,
            robot.mass,
            edges,
            GROUND,
        )
        weight = robot.mass * G
        assert_close(H @ links.stacked_jacobian() / weight, matrix / weight, 1e-6)
        assert_close((K - H @ links.stacked_bias()) / weight, bound / weight, 1e-6)
        p = cop_from_momentum_rate(rate, dynamics.com_in_world, robot.mass, GROUND)
        fz = rate[2] + weight
        scale = weight + np.abs(rate).max()
        assert_close((matrix @ a - bound) / scale, fz * (edges.normal @ p - edges.offset) / scale, 1e-8)


def test_edges_of_a_polygon_measure_distance(rng):
    polygon = support_polygon(rng.normal(size=(9, 2)))
    edges = polygon_edges(polygon)
    for point in rng.normal(size=(50, 2)):
        inside = (edges.offset - edges.normal @ point).min()
        margin = support_margin(point, polygon)
        assert (inside > 0.0) == (margin > 0.0)
        if margin > 0.0:
            assert inside == pytest.approx(margin, abs=1e-12)


def test_a_rectangle_is_a_polygon():
    corners = np.array([LOWER, [UPPER[0], LOWER[1]], UPPER, [LOWER[0], UPPER[1]]])
    a, b = rectangle_edges(LOWER, UPPER), polygon_edges(corners)
    order = [1, 3, 2, 0]
    assert_close(a.normal, b.normal[order], 1e-12)
    assert_close(a.offset, b.offset[order], 1e-12)
