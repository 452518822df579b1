"""Eqs. 3 to 20 on random states of both robots, every quantity by a second road."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
from scipy.linalg import block_diag

from momentum_lab.momentum.centroidal import (
    LinkMomenta,
    average_velocity,
    inertia_ellipsoid,
    kinetic_energy,
    link_by_link,
    locked_spatial_inertia,
    momentum_rate,
)
from momentum_lab.momentum.wrench import skew, swap_operator_blocks
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import State
from tests.conftest import assert_close, yaw_rotation


@pytest.fixture(scope="module")
def links(robot, random_states) -> list[LinkMomenta]:
    return [link_by_link(robot, state) for state in random_states]


@pytest.fixture(scope="module")
def kinematics(robot, random_states) -> list[pin.Data]:
    """Pinocchio's own kinematics of the random states."""
    result = []
    for state in random_states:
        data = robot.model.createData()
        pin.forwardKinematics(robot.model, data, state.q, state.v)
        pin.computeJointJacobians(robot.model, data, state.q)
        result.append(data)
    return result


def test_every_link_with_mass_takes_part(robot, links):
    assert links[0].joint_names == ("root_joint", *robot.joint_names)
    assert links[0].momenta.shape == (robot.model.njoints - 1, 6)


def test_link_transforms_in_the_chapters_order(robot, links, kinematics):
    """Eq. 4, printed form: angular first, [[E, 0], [E S(p)^T, E]]."""
    for link, data in zip(links, kinematics, strict=True):
        for transform, placement in zip(link.transforms, data.liMi[1:], strict=True):
            E, p = placement.rotation.T, placement.translation
            printed = np.block([[E, np.zeros((3, 3))], [E @ skew(p).T, E]])
            assert_close(swap_operator_blocks(transform), printed, 1e-12)
            assert_close(transform, placement.toActionMatrixInverse(), 1e-12)


def test_link_velocities(links, kinematics):
    """Eq. 3."""
    for link, data in zip(links, kinematics, strict=True):
        assert_close(link.velocities, [velocity.vector for velocity in data.v[1:]], 1e-11)


def test_system_jacobian(robot, random_states, links, kinematics):
    """Eqs. 5 to 7: rows from Pinocchio's joint Jacobians, product from the recursion."""
    for state, link, data in zip(random_states, links, kinematics, strict=True):
        rows = [pin.getJointJacobian(robot.model, data, i, pin.LOCAL) for i in range(1, robot.model.njoints)]
        assert_close(link.system_jacobian, np.vstack(rows), 1e-11)
        assert_close(link.system_jacobian @ state.v, link.velocities.ravel(), 1e-11)


def test_link_inertias_in_the_chapters_order(robot, links):
    """Eqs. 9 and 10, printed form, and Pinocchio's."""
    for inertia, body in zip(links[0].inertias, robot.model.inertias[1:], strict=True):
        m, S = body.mass, skew(body.lever)
        about_origin = body.inertia + m * S @ S.T
        printed = np.block([[about_origin, m * S], [m * S.T, m * np.eye(3)]])
        assert_close(swap_operator_blocks(inertia), printed, 1e-12)
        assert_close(inertia, body.matrix(), 1e-12)


def test_link_momenta(links):
    """Eqs. 8 and 11."""
    for link in links:
        system_inertia = block_diag(*link.inertias)
        assert_close(link.momenta.ravel(), system_inertia @ link.velocities.ravel(), 1e-11)


def test_momentum_by_elementary_mechanics(robot, links, kinematics):
    """l = sum m c_dot, k = sum (c - r_G) x m c_dot + I omega: no spatial vectors, no frames but the world."""
    for link, data in zip(links, kinematics, strict=True):
        linear, angular = np.zeros(3), np.zeros(3)
        for body, frame, twist in zip(robot.model.inertias[1:], data.oMi[1:], data.v[1:], strict=True):
            R, omega = frame.rotation, frame.rotation @ twist.angular
            com = frame.translation + R @ body.lever
            com_velocity = R @ twist.linear + np.cross(omega, R @ body.lever)
            linear += body.mass * com_velocity
            angular += np.cross(com - link.com_in_world, body.mass * com_velocity)
            angular += R @ body.inertia @ R.T @ omega
        assert_close(link.momentum, np.concatenate((linear, angular)), 1e-10)


def test_momentum_three_ways(random_states, random_dynamics, links):
    """Eqs. 12, 15 and 18 against Pinocchio's h_G."""
    for state, dynamics, link in zip(random_states, random_dynamics, links, strict=True):
        assert_close(link.momentum, dynamics.momentum, 1e-10)
        assert_close(link.centroidal_map @ state.v, dynamics.momentum, 1e-10)
        assert_close(link.projection.T @ link.momenta.ravel(), dynamics.momentum, 1e-10)
        assert_close(link.momenta_about_com.sum(axis=0), dynamics.momentum, 1e-10)


def test_centre_of_mass(robot, random_states, random_dynamics, links):
    """Eq. 14."""
    data = robot.model.createData()
    for state, dynamics, link in zip(random_states, random_dynamics, links, strict=True):
        assert_close(link.com_in_world, dynamics.com_in_world, 1e-12)
        assert_close(pin.centerOfMass(robot.model, data, state.q), dynamics.com_in_world, 1e-12)


def test_centroidal_map_by_both_roads(random_dynamics, links):
    """Eqs. 16 to 19 against Pinocchio's A_G."""
    for dynamics, link in zip(random_dynamics, links, strict=True):
        assert_close(link.centroidal_map, dynamics.centroidal_map, 1e-11)


def test_centroidal_map_from_base_rows_of_the_mass_matrix(random_dynamics, kinematics):
    """The base rows of H are the momentum about the base, so A_G is those rows seen from the CoM."""
    for dynamics, data in zip(random_dynamics, kinematics, strict=True):
        base = data.oMi[1]
        from_com = pin.SE3(base.rotation, base.translation - dynamics.com_in_world)
        expected = from_com.toDualActionMatrix() @ dynamics.mass_matrix[:6]
        assert_close(dynamics.centroidal_map, expected, 1e-11)


def test_linear_rows_are_mass_times_com_jacobian(robot, random_states, random_dynamics):
    data = robot.model.createData()
    for state, dynamics in zip(random_states, random_dynamics, strict=True):
        jacobian = pin.jacobianCenterOfMass(robot.model, data, state.q)
        assert_close(dynamics.centroidal_map[:3] / robot.mass, jacobian, 1e-11)
        assert_close(dynamics.momentum[:3] / robot.mass, dynamics.com_velocity, 1e-11)


def test_base_columns_need_world_axes_to_match_the_resolved_momentum_form(robot, random_dynamics, kinematics):
    """[[m 1, -m S(r_G - o_b)], [0, I_G]] holds for a world-aligned base velocity, not for the body-frame one."""
    for dynamics, data in zip(random_dynamics, kinematics, strict=True):
        R, arm = data.oMi[1].rotation, dynamics.com_in_world - data.oMi[1].translation
        expected = np.zeros((6, 6))
        expected[:3, :3], expected[:3, 3:] = robot.mass * np.eye(3), -robot.mass * skew(arm)
        expected[3:, 3:] = dynamics.locked_inertia
        in_body_axes = dynamics.centroidal_map[:, :6]
        in_world_axes = np.hstack((in_body_axes[:, :3] @ R.T, in_body_axes[:, 3:] @ R.T))
        assert_close(in_world_axes, expected, 1e-10)
        assert np.abs(in_body_axes - expected).max() > 1.0


def test_momentum_rate(robot, random_states, random_dynamics, rng):
    """Eq. 20 against Pinocchio's recursion for dh_G/dt and against the CoM acceleration."""
    data = robot.model.createData()
    for state, dynamics in zip(random_states, random_dynamics, strict=True):
        a = rng.normal(size=robot.nv)
        rate = momentum_rate(dynamics, a)
        expected = pin.computeCentroidalMomentumTimeVariation(robot.model, data, state.q, state.v, a).vector
        assert_close(rate, expected, 1e-9)
        pin.centerOfMass(robot.model, data, state.q, state.v, a)
        assert_close(rate[:3] / robot.mass, data.acom[0], 1e-9)


def test_bias_by_both_roads(random_dynamics, links):
    """dA_G/dt v from the links' rates at zero joint acceleration."""
    for dynamics, link in zip(random_dynamics, links, strict=True):
        assert_close(link.centroidal_bias, dynamics.centroidal_bias, 1e-9)


def test_bias_by_finite_differences(robot, random_states, random_dynamics):
    """dA_G/dt from two neighbours along the motion."""
    data, eps = robot.model.createData(), 1e-6
    for state, dynamics in zip(random_states, random_dynamics, strict=True):
        ahead, behind = (
            pin.computeCentroidalMap(
                robot.model, data, pin.integrate(robot.model, state.q, step * state.v)
            ).copy()
            for step in (eps, -eps)
        )
        assert_close(dynamics.centroidal_bias, (ahead - behind) @ state.v / (2 * eps), 1e-5)


def test_bias_is_the_base_wrench_of_inverse_dynamics_without_gravity(robot, random_dynamics, kinematics):
    """With gravity left on, as the sentence after Eq. 20 reads, the weight comes out too."""
    model = robot.model.copy()
    data = model.createData()
    for dynamics, placed in zip(random_dynamics, kinematics, strict=True):
        state, base = dynamics.state, placed.oMi[1]
        from_com = pin.SE3(base.rotation, base.translation - dynamics.com_in_world)
        found = {}
        for gravity in (0.0, -9.81):
            model.gravity.linear = np.array([0.0, 0.0, gravity])
            base_wrench = pin.rnea(model, data, state.q, state.v, np.zeros(model.nv))[:6]
            found[gravity] = from_com.act(pin.Force(base_wrench)).vector
        assert_close(found[0.0], dynamics.centroidal_bias, 1e-9)
        assert_close(found[-9.81] - found[0.0], [0.0, 0.0, robot.mass * 9.81, 0.0, 0.0, 0.0], 1e-9)


def test_locked_inertia_is_the_sum_of_projected_link_inertias(robot, random_dynamics, links):
    for dynamics, link in zip(random_dynamics, links, strict=True):
        projection = link.projection.reshape(-1, 6, 6)
        expected = sum(X.T @ inertia @ X for X, inertia in zip(projection, link.inertias, strict=True))
        assert_close(locked_spatial_inertia(dynamics, robot.mass), expected, 1e-10)


def test_average_velocity_is_the_rigid_motion_closest_to_the_links(random_dynamics, links):
    """v_G minimises the energy of the motion relative to it: a least-squares fit weighted with the inertias."""
    for dynamics, link in zip(random_dynamics, links, strict=True):
        roots = [np.linalg.cholesky(inertia).T for inertia in link.inertias]
        projection = link.projection.reshape(-1, 6, 6)
        rows = np.vstack([root @ X for root, X in zip(roots, projection, strict=True)])
        target = np.concatenate([root @ v for root, v in zip(roots, link.velocities, strict=True)])
        fit, *_ = np.linalg.lstsq(rows, target, rcond=None)
        assert_close(average_velocity(dynamics), fit, 1e-10)


def test_kinetic_energy_split(robot, random_states, random_dynamics, links):
    """Shares from the links one by one; the rotors, which carry no momentum, belong to the internal share."""
    for state, dynamics, link in zip(random_states, random_dynamics, links, strict=True):
        energy, average = kinetic_energy(dynamics), average_velocity(dynamics)
        relative = link.velocities - (link.projection @ average).reshape(-1, 6)
        of_links = 0.5 * np.einsum("ni,nij,nj->", relative, link.inertias, relative)
        of_rotors = 0.5 * robot.model.armature @ state.v**2
        assert energy.internal == pytest.approx(of_links + of_rotors, abs=1e-10)
        assert energy.internal > 0.0
        locked = 0.5 * average @ locked_spatial_inertia(dynamics, robot.mass) @ average
        assert energy.translation + energy.rotation == pytest.approx(locked, abs=1e-10)
        of_com = 0.5 * robot.mass * dynamics.com_velocity @ dynamics.com_velocity
        assert energy.translation == pytest.approx(of_com, abs=1e-10)


def test_a_locked_robot_has_no_internal_energy_and_turns_with_its_base(robot, random_states):
    for state in random_states[:10]:
        v = np.concatenate((state.v[:6], np.zeros(robot.na)))
        dynamics = robot.at(State(state.q, v))
        assert kinetic_energy(dynamics).internal == pytest.approx(0.0, abs=1e-10)
        base_rotation = pin.Quaternion(state.q[3:7]).toRotationMatrix()
        assert_close(average_velocity(dynamics)[3:], base_rotation @ v[3:6], 1e-10)


def test_ellipsoid_has_the_inertia_of_the_robot(robot, random_dynamics):
    """A uniform solid ellipsoid has m/5 (a_j^2 + a_k^2) about its axis i."""
    for dynamics in random_dynamics:
        ellipsoid = inertia_ellipsoid(dynamics.locked_inertia, robot.mass)
        squares = ellipsoid.semi_axes**2
        principal = robot.mass / 5.0 * (squares.sum() - squares)
        rebuilt = ellipsoid.axes @ np.diag(principal) @ ellipsoid.axes.T
        assert_close(rebuilt, dynamics.locked_inertia, 1e-10)


def test_ellipsoid_of_a_flat_disc_is_flat():
    disc = np.diag([0.25, 0.25, 0.5])
    assert inertia_ellipsoid(disc, 1.0).semi_axes.min() == pytest.approx(0.0, abs=1e-7)


def test_momentum_does_not_depend_on_where_the_robot_stands(robot, random_states, random_dynamics):
    for state, dynamics in zip(random_states[:10], random_dynamics, strict=False):
        q = state.q.copy()
        q[:3] += [100.0, -40.0, 3.0]
        moved = robot.at(State(q, state.v))
        assert_close(moved.momentum, dynamics.momentum, 1e-9)
        assert_close(moved.centroidal_map, dynamics.centroidal_map, 1e-9)
        assert_close(moved.centroidal_bias, dynamics.centroidal_bias, 1e-9)


def test_momentum_turns_with_the_robot(robot, random_states):
    turn = yaw_rotation(np.deg2rad(137.0))
    both = np.kron(np.eye(2), turn)
    for state in random_states[:10]:
        straight, turned = link_by_link(robot, state), link_by_link(robot, _turned(state, turn))
        assert_close(turned.com_in_world, turn @ straight.com_in_world, 1e-10)
        assert_close(turned.momentum, both @ straight.momentum, 1e-10)
        assert_close(turned.centroidal_bias, both @ straight.centroidal_bias, 1e-9)
        assert_close(turned.velocities, straight.velocities, 1e-10)


def test_momentum_is_linear_and_its_bias_quadratic_in_velocity(robot, random_states, random_dynamics):
    for state, dynamics in zip(random_states[:10], random_dynamics, strict=False):
        faster = robot.at(State(state.q, -2.0 * state.v))
        assert_close(faster.momentum, -2.0 * dynamics.momentum, 1e-10)
        assert_close(faster.centroidal_bias, 4.0 * dynamics.centroidal_bias, 1e-9)


def test_link_road_does_not_disturb_the_robot(robot: RobotModel, random_states):
    """It computes in its own memory: the robot's last result stays as it was."""
    robot.at(random_states[0])
    before = robot.data.oMf[robot.pelvis].translation.copy()
    link_by_link(robot, random_states[1])
    assert_close(robot.data.oMf[robot.pelvis].translation, before, 0.0)


def _turned(state: State, rotation: np.ndarray) -> State:
    """The same robot, turned about the world's origin."""
    q = state.q.copy()
    q[:3] = rotation @ q[:3]
    q[3:7] = pin.Quaternion(rotation @ pin.Quaternion(q[3:7]).toRotationMatrix()).coeffs()
    return State(q, state.v)
