"""Momentum about the centre of mass and the map A_G from joint rates to it (Eqs. 3 to 20).

Two roads lead to A_G. `link_by_link` walks the chapter's: velocities, Jacobian, inertias, momenta and their
projection to the CoM. `RobotModel.at` takes Pinocchio's recursion, fast enough for every tick; the functions
that take a `Dynamics` start from there. Both are linear first, and a test holds them together.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from momentum_lab.momentum.wrench import skew
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics, State


@dataclass(frozen=True, slots=True)
class LinkMomenta:
    """Every stage on the way from joint rates to the centroidal momentum; N links, linear before angular.

    Attributes:
        joint_names: the joint that carries each link (N,).
        transforms: velocity of the parent link -> velocity of the link, Eq. 4 (N, 6, 6).
        velocities: v_i at the link's origin, link axes, Eq. 3 (N, 6), m/s and rad/s.
        system_jacobian: J, all link velocities from the joint rates, Eqs. 5 to 7 (6N, nv).
        inertias: I_i about the link's origin, link axes, Eqs. 9, 10 (N, 6, 6).
        momenta: h_i about the link's origin, link axes, Eq. 8 (N, 6), N s and N m s.
        projection: X_G, velocity of a frame at the CoM -> link velocities, Eq. 13 (6N, 6).
        momenta_about_com: each link's share of h_G about the CoM, world axes, Eq. 12 (N, 6), N s and N m s.
        com_in_world: r_G, Eq. 14 (3,), m.
        centroidal_map: A_G = X_G^T I J, Eq. 19 (6, nv).
        centroidal_bias: dA_G/dt v, the rate of h_G at zero joint acceleration, Eq. 20 (6,), N and N m.
        momentum: h_G = sum of momenta_about_com, Eq. 12 (6,), N s and N m s.
    """

    joint_names: tuple[str, ...]
    transforms: np.ndarray
    velocities: np.ndarray
    system_jacobian: np.ndarray
    inertias: np.ndarray
    momenta: np.ndarray
    projection: np.ndarray
    momenta_about_com: np.ndarray
    com_in_world: np.ndarray
    centroidal_map: np.ndarray
    centroidal_bias: np.ndarray
    momentum: np.ndarray


@dataclass(frozen=True, slots=True)
class KineticEnergy:
    """Kinetic energy in three shares that do not mix.

    Attributes:
        translation: of the CoM, J.
        rotation: of the body locked in its posture, turning with the average angular velocity, J.
        internal: of the links (and rotors) relative to that average motion, J.
    """

    translation: float
    rotation: float
    internal: float


@dataclass(frozen=True, slots=True)
class InertiaEllipsoid:
    """A solid ellipsoid of uniform density with the robot's mass and rotational inertia.

    Attributes:
        semi_axes: half lengths (3,), m.
        axes: directions of the semi-axes in the world, one per column (3, 3).
    """

    semi_axes: np.ndarray
    axes: np.ndarray


def motion_transform(rotation: np.ndarray, displacement: np.ndarray) -> np.ndarray:
    """The velocity of a rigid body at another point and in other axes.

    X = [[E, -E S(p)], [0, E]]: Eq. 4, and with E from world to link axes and p = o_i - r_G also Eq. 13.

    Args:
        rotation: E, components in the old axes -> components in the new axes (3, 3).
        displacement: p, from the old point to the new one, in the old axes (3,), m.

    Returns:
        X, [v; omega] at the old point -> [v; omega] at the new point (6, 6).
    """
    transform = np.zeros((6, 6))
    transform[:3, :3] = transform[3:, 3:] = rotation
    transform[:3, 3:] = -rotation @ skew(displacement)
    return transform


def spatial_inertia(mass: float, com: np.ndarray, inertia_about_com: np.ndarray) -> np.ndarray:
    """The inertia of one link about the origin of its frame.

    I = [[m 1, m S(c)^T], [m S(c), I_cm + m S(c) S(c)^T]] (Eqs. 9, 10).

    Args:
        mass: m, kg.
        com: c, the link's CoM in its frame (3,), m.
        inertia_about_com: I_cm, link axes (3, 3), kg m^2.

    Returns:
        I, [v; omega] -> [l; k] about the origin (6, 6).
    """
    lever = skew(com)
    inertia = np.zeros((6, 6))
    inertia[:3, :3] = mass * np.eye(3)
    inertia[3:, :3] = mass * lever
    inertia[:3, 3:] = mass * lever.T
    inertia[3:, 3:] = inertia_about_com + mass * lever @ lever.T
    return inertia


def link_by_link(robot: RobotModel, state: State) -> LinkMomenta:
    """The chapter's own road to the centroidal momentum, for reading and for tests.

    v_i = X_i v_p(i) + Phi_i qdot_i (Eq. 3), h_i = I_i v_i (Eq. 8), h_G = X_G^T h (Eq. 12),
    A_G = X_G^T I J (Eq. 19).

    Args:
        robot: the robot; links welded together by fixed joints count as one.
        state: configuration (nq,) and velocity (nv,).

    Returns:
        Every intermediate quantity, linear first.
    """
    model, data = robot.model, robot.model.createData()
    pin.forwardKinematics(model, data, state.q)
    transforms, velocities, jacobian, accelerations = _walk_the_tree(model, data, state.v)
    links = range(1, model.njoints)
    bodies = [model.inertias[i] for i in links]
    inertias = np.array([spatial_inertia(body.mass, body.lever, body.inertia) for body in bodies])
    frames = [data.oMi[i] for i in links]
    com_of_links = [frame.act(body.lever) for frame, body in zip(frames, bodies, strict=True)]
    com = np.average(com_of_links, axis=0, weights=[body.mass for body in bodies])
    projection = np.array([motion_transform(frame.rotation.T, frame.translation - com) for frame in frames])
    momenta = _times(inertias, velocities)
    momentum_rates = _times(inertias, accelerations) + _times(_wrench_cross(velocities), momenta)
    momenta_about_com = _times(projection.transpose(0, 2, 1), momenta)
    return LinkMomenta(
        joint_names=tuple(model.names[1:]),
        transforms=transforms,
        velocities=velocities,
        system_jacobian=jacobian.reshape(-1, model.nv),
        inertias=inertias,
        momenta=momenta,
        projection=projection.reshape(-1, 6),
        momenta_about_com=momenta_about_com,
        com_in_world=com,
        centroidal_map=np.einsum("nji,njk->ik", projection, inertias @ jacobian),
        centroidal_bias=np.einsum("nji,nj->i", projection, momentum_rates),
        momentum=momenta_about_com.sum(axis=0),
    )


def momentum_rate(dynamics: Dynamics, acceleration: np.ndarray) -> np.ndarray:
    """The rate of the centroidal momentum.

    dh_G/dt = A_G a + dA_G/dt v (Eq. 20).

    Args:
        dynamics: the robot at one state.
        acceleration: a, rate of the components of v (nv,), m/s^2 and rad/s^2.

    Returns:
        [dl/dt; dk/dt] about the CoM, world axes (6,), N and N m.
    """
    return dynamics.centroidal_map @ acceleration + dynamics.centroidal_bias


def locked_spatial_inertia(dynamics: Dynamics, mass: float) -> np.ndarray:
    """The inertia of the robot about its CoM with all joints locked.

    I_G = X_G^T I X_G = blkdiag(m 1, locked rotational inertia).

    Args:
        dynamics: the robot at one state.
        mass: m, kg.

    Returns:
        I_G, world axes (6, 6), kg and kg m^2.
    """
    inertia = np.zeros((6, 6))
    inertia[:3, :3] = mass * np.eye(3)
    inertia[3:, 3:] = dynamics.locked_inertia
    return inertia


def average_velocity(dynamics: Dynamics) -> np.ndarray:
    """The velocity the robot would have if it carried its momentum as one rigid body.

    v_G = I_G^-1 h_G (Orin, Goswami, Lee 2013): the CoM velocity and the average angular velocity. The latter
    does not integrate to an orientation.

    Args:
        dynamics: the robot at one state.

    Returns:
        [v; omega] at the CoM, world axes (6,), m/s and rad/s.
    """
    spin = np.linalg.solve(dynamics.locked_inertia, dynamics.momentum[3:])
    return np.concatenate((dynamics.com_velocity, spin))


def kinetic_energy(dynamics: Dynamics) -> KineticEnergy:
    """Kinetic energy, split into what the centroidal momentum carries and the rest.

    T = 1/2 v^T H v = 1/2 v_G^T I_G v_G + internal, with v_G = I_G^-1 h_G and internal >= 0.

    Args:
        dynamics: the robot at one state; its mass matrix H includes the rotors.

    Returns:
        The three shares, J.
    """
    velocity, average = dynamics.state.v, average_velocity(dynamics)
    total = 0.5 * float(velocity @ dynamics.mass_matrix @ velocity)
    translation = 0.5 * float(average[:3] @ dynamics.momentum[:3])
    rotation = 0.5 * float(average[3:] @ dynamics.momentum[3:])
    return KineticEnergy(translation, rotation, total - translation - rotation)


def inertia_ellipsoid(locked_inertia: np.ndarray, mass: float) -> InertiaEllipsoid:
    """The uniform solid ellipsoid that has the robot's mass and locked rotational inertia.

    a_i = sqrt(5 (I_j + I_k - I_i) / (2 m)), with the principal inertias I (reaction mass pendulum, Lee and
    Goswami 2007).

    Args:
        locked_inertia: rotational inertia about the CoM, world axes (3, 3), kg m^2.
        mass: m, kg.

    Returns:
        Semi-axes, m, and their directions in the world.
    """
    principal, axes = np.linalg.eigh(locked_inertia)
    squared = 5.0 / (2.0 * mass) * (principal.sum() - 2.0 * principal)
    return InertiaEllipsoid(semi_axes=np.sqrt(np.maximum(squared, 0.0)), axes=axes)


def _walk_the_tree(
    model: pin.Model, data: pin.Data, joint_rates: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Transforms, velocities, Jacobians and zero-joint-acceleration accelerations of all links (Eq. 3)."""
    transform = np.zeros((model.njoints, 6, 6))
    velocity = np.zeros((model.njoints, 6))
    acceleration = np.zeros((model.njoints, 6))
    jacobian = np.zeros((model.njoints, 6, model.nv))
    for i in range(1, model.njoints):
        parent, placement = model.parents[i], data.liMi[i]
        columns = slice(model.idx_vs[i], model.idx_vs[i] + model.nvs[i])
        modes = data.joints[i].S.reshape(6, model.nvs[i])
        joint_velocity = modes @ joint_rates[columns]
        transform[i] = motion_transform(placement.rotation.T, placement.translation)
        velocity[i] = transform[i] @ velocity[parent] + joint_velocity
        acceleration[i] = transform[i] @ acceleration[parent] + _motion_cross(velocity[i]) @ joint_velocity
        jacobian[i] = transform[i] @ jacobian[parent]
        jacobian[i][:, columns] += modes
    return transform[1:], velocity[1:], jacobian[1:], acceleration[1:]


def _motion_cross(velocity: np.ndarray) -> np.ndarray:
    """The rate of a motion vector that is carried along with a velocity, as a matrix (6, 6)."""
    cross = np.zeros((6, 6))
    cross[:3, :3] = cross[3:, 3:] = skew(velocity[3:])
    cross[:3, 3:] = skew(velocity[:3])
    return cross


def _wrench_cross(velocities: np.ndarray) -> np.ndarray:
    """The rate of momenta that are carried along with their links, as matrices (N, 6, 6)."""
    return np.array([-_motion_cross(velocity).T for velocity in velocities])


def _times(matrices: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """One matrix times one vector, for each link."""
    return np.einsum("nij,nj->ni", matrices, vectors)
