"""The CoP bounds of section 5.2 as linear inequalities in accelerations (Eqs. 48 to 60), in two forms.

The chapter sums over the links; the same bounds follow from the centroidal momentum with a handful of numbers.
Both multiply n . p <= b by the normal force, so both count on f_z > 0.

The chapter's tau_i = I_i omega_i' (Eqs. 50, 51) leaves out the gyroscopic moment. Here
tau_i = I_i omega_i' + omega_i x I_i omega_i with the full inertia, which makes the sums exact: omega_z' joins
the vector of Eq. 54, and the gyroscopic moment joins K_r.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.momentum.segments import Segments


@dataclass(frozen=True, slots=True)
class Edges:
    """The edges of a convex region of the ground: n_j . p <= b_j.

    Attributes:
        normal: n_j, outward (K, 2); of length 1.
        offset: b_j (K,), m.
    """

    normal: np.ndarray
    offset: np.ndarray


def rectangle_edges(lower: np.ndarray, upper: np.ndarray) -> Edges:
    """Edges of a rectangle along the axes in the order of Eq. 53: x_max, x_min, y_max, y_min.

    Args:
        lower: (x_min, y_min), m.
        upper: (x_max, y_max), m.
    """
    normal = np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
    return Edges(normal, np.array([upper[0], -lower[0], upper[1], -lower[1]]))


def polygon_edges(polygon: np.ndarray) -> Edges:
    """Edges of a convex polygon.

    Args:
        polygon: corners, counter-clockwise (K, 2) with K >= 3, m.
    """
    along = np.roll(polygon, -1, axis=0) - polygon
    normal = np.column_stack([along[:, 1], -along[:, 0]]) / np.linalg.norm(along, axis=1)[:, None]
    return Edges(normal, np.einsum("ki,ki->k", normal, polygon))


def link_moments(links: Segments, angular_acceleration: np.ndarray) -> np.ndarray:
    """The moment about its own CoM that turns each link.

    tau_i = I_i omega_i' + omega_i x I_i omega_i: Eqs. 50 (x) and 51 (y), with the full inertia and the
    gyroscopic moment that they leave out.

    Args:
        links: all links with mass.
        angular_acceleration: omega_i', world axes (N, 3), rad/s^2.

    Returns:
        tau_i, world axes (N, 3), N m.
    """
    return np.einsum("nij,nj->ni", links.inertia, angular_acceleration) + _gyroscopic(links)


def segment_cop(links: Segments, acceleration: np.ndarray, ground_height: float = 0.0) -> np.ndarray:
    """The CoP from the accelerations of all links.

    Eqs. 48, 49: p_x = [sum m_i r_xi (r_zi'' + g) - sum m_i r_zi r_xi'' - sum tau_yi] / sum m_i (r_zi'' + g),
    p_y = [sum m_i r_yi (r_zi'' + g) - sum m_i r_zi r_yi'' + sum tau_xi] / sum m_i (r_zi'' + g), with
    tau_i = I_i omega_i' + omega_i x I_i omega_i about the link's CoM and r_zi above the ground.

    Args:
        links: all links with mass.
        acceleration: y_r'' as `Segments.stacked_acceleration` gives it (6 N,).
        ground_height: height z_0 of the ground, m.

    Returns:
        p (2,), m.
    """
    linear, angular = acceleration.reshape(6, -1)[:3].T, acceleration.reshape(6, -1)[3:].T
    moment = link_moments(links, angular).sum(0)
    height = links.position[:, 2] - ground_height
    force = links.mass * (linear[:, 2] + GRAVITY)
    x = force @ links.position[:, 0] - (links.mass * height) @ linear[:, 0] - moment[1]
    y = force @ links.position[:, 1] - (links.mass * height) @ linear[:, 1] + moment[0]
    return np.array([x, y]) / force.sum()


def segment_rows(links: Segments, edges: Edges, ground_height: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """CoP bounds as rows over the accelerations of all links: H_r y_r'' <= K_r (Eqs. 52 to 59).

    For every edge, H_r y_r'' - K_r = f_z (n . p - b). With the edges of a rectangle the rows are Eq. 53's; an
    edge in any direction is n_x times the first row's moment part plus n_y times the third's.

    Args:
        links: all links with mass.
        edges: where the CoP has to stay (K edges).
        ground_height: height z_0 of the ground, m.

    Returns:
        H_r (K, 6 N) and K_r (K,), N m.
    """
    m, (rx, ry, rz) = links.mass, links.position.T
    nx, ny, b = edges.normal[:, :1], edges.normal[:, 1:], edges.offset[:, None]
    beyond = nx * rx + ny * ry - b
    height = m * (rz - ground_height)
    inertia_x, inertia_y = links.inertia[:, 0], links.inertia[:, 1]
    turning = [ny * inertia_x[:, j] - nx * inertia_y[:, j] for j in range(3)]
    gyroscopic = _gyroscopic(links).sum(0)
    constant = edges.normal[:, 1] * gyroscopic[0] - edges.normal[:, 0] * gyroscopic[1]
    rows = np.concatenate([-nx * height, -ny * height, beyond * m, *turning], axis=1)
    return rows, -GRAVITY * (beyond @ m) - constant


def centroidal_rows(
    centroidal_map: np.ndarray,
    centroidal_bias: np.ndarray,
    com_in_world: np.ndarray,
    mass: float,
    edges: Edges,
    ground_height: float = 0.0,
) -> tuple[np.ndarray, np.ndarray]:
    """The same bounds from the centroidal momentum: G a <= h, with G a - h = f_z (n . p - b).

    (n . r - b) f_z - z_c (n . f) - n_x dk_y/dt + n_y dk_x/dt <= 0 with f = A_lin a + dA_lin v - m g and
    dk/dt = A_ang a + dA_ang v (Eq. 21 times f_z).

    Args:
        centroidal_map: A_G (6, nv).
        centroidal_bias: dA_G/dt v (6,), N and N m.
        com_in_world: r_G (3,), m.
        mass: m, kg.
        edges: where the CoP has to stay (K edges).
        ground_height: height z_0 of the ground, m.

    Returns:
        G (K, nv) and h (K,), N m.
    """
    nx, ny = edges.normal.T
    beyond = edges.normal @ com_in_world[:2] - edges.offset
    height = com_in_world[2] - ground_height
    rate = np.column_stack([-height * nx, -height * ny, beyond, ny, -nx, np.zeros_like(nx)])
    return rate @ centroidal_map, -rate @ centroidal_bias - beyond * mass * GRAVITY


def _gyroscopic(links: Segments) -> np.ndarray:
    """omega_i x I_i omega_i (N, 3), N m."""
    return np.cross(links.spin, np.einsum("nij,nj->ni", links.inertia, links.spin))
