"""Eqs. 1, 2, 21 to 23 and 39 to 41: forces under the feet against the momentum they cause."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.momentum.centroidal import momentum_rate
from momentum_lab.momentum.ground import (
    GRAVITY,
    GroundReaction,
    cmp_cop_gap,
    cmp_from_force,
    cop_from_momentum_rate,
    cop_from_wrench,
    ground_reaction_force,
    ground_wrench_from_momentum_rate,
    momentum_rate_from_reaction,
    momentum_rate_from_wrenches,
    reaction_from_momentum_rate,
    sole_cop,
)
from momentum_lab.momentum.wrench import shift_wrench, wrench_in_frame_axes, y_up_from_z_up, z_up_from_y_up
from tests.conftest import assert_close, random_rotation, yaw_rotation

MASS = 61.0


def test_gravity_is_pinocchios(robot):
    assert_close(robot.model.gravity.linear, [0.0, 0.0, -GRAVITY], 0.0)


def test_momentum_rate_is_gravity_plus_contacts_plus_push(robot, random_dynamics, rng):
    """Eqs. 1 and 2 with two feet and a push, against forward dynamics and Eq. 20."""
    for dynamics in random_dynamics:
        wrenches, points = rng.normal(scale=100.0, size=(3, 6)), np.zeros((3, 3))
        wrenches[2, 3:] = 0.0
        joints = [robot.model.frames[sole.frame].parentJoint for sole in robot.soles]
        joints.append(robot.model.frames[robot.trunk].parentJoint)
        points[:2], points[2] = dynamics.sole_position, dynamics.com_in_world + rng.normal(scale=0.3, size=3)
        a = _forward_dynamics(robot, dynamics.state, rng.normal(size=robot.na), wrenches, points, joints)
        expected = momentum_rate(dynamics, a)
        rate = momentum_rate_from_wrenches(wrenches, points, dynamics.com_in_world, robot.mass)
        assert_close(rate, expected, 1e-8)


def test_a_push_through_the_com_changes_linear_momentum_only(rng):
    com, push = rng.normal(size=3), np.array([[120.0, 30.0, 0.0, 0.0, 0.0, 0.0]])
    rate = momentum_rate_from_wrenches(push, com[None], com, MASS)
    assert_close(rate, [120.0, 30.0, -MASS * GRAVITY, 0.0, 0.0, 0.0], 1e-12)


def test_in_flight_only_gravity_acts():
    rate = momentum_rate_from_wrenches(np.zeros((0, 6)), np.zeros((0, 3)), np.ones(3), MASS)
    assert_close(rate, [0.0, 0.0, -MASS * GRAVITY, 0.0, 0.0, 0.0], 0.0)


def test_six_numbers_for_six(rng):
    """(f, p, tau_n) -> momentum rate -> (f, p, tau_n), and the other way round."""
    for _ in range(50):
        com, height = rng.normal(size=3), rng.normal()
        rate = rng.normal(scale=100.0, size=6)
        reaction = reaction_from_momentum_rate(rate, com, MASS, height)
        assert_close(momentum_rate_from_reaction(reaction, com, MASS), rate, 1e-9)
        chosen = GroundReaction(
            rng.normal(size=3) + np.array([0.0, 0.0, 600.0]),
            np.append(rng.normal(size=2), height),
            rng.normal(),
        )
        again = reaction_from_momentum_rate(momentum_rate_from_reaction(chosen, com, MASS), com, MASS, height)
        assert_close(again.force, chosen.force, 1e-9)
        assert_close(again.cop_in_world, chosen.cop_in_world, 1e-9)
        assert again.normal_moment == pytest.approx(chosen.normal_moment, abs=1e-9)


def test_reaction_moment_is_the_chapters_cross_product(rng):
    """Eq. 1 written with a cross product."""
    force, cop, com = rng.normal(size=(3, 3))
    rate = momentum_rate_from_reaction(GroundReaction(force, cop, 2.5), com, MASS)
    assert_close(rate[3:], np.cross(cop - com, force) + np.array([0.0, 0.0, 2.5]), 1e-12)


def test_cop_is_the_mean_of_the_contact_points_weighted_with_their_normal_forces(rng):
    for _ in range(50):
        forces, points = _pressing_forces(rng, ground_height=0.3)
        about = rng.normal(size=3)
        moment = np.cross(points - about, forces).sum(axis=0)
        wrench = np.concatenate((forces.sum(axis=0), moment))
        expected = np.average(points[:, :2], axis=0, weights=forces[:, 2])
        assert_close(cop_from_wrench(wrench, about, 0.3), expected, 1e-9)


def test_cop_of_a_whole_robot(robot, random_dynamics, rng):
    """Eq. 21 from the momentum rate of forward dynamics, against the forces that were applied."""
    pelvis = robot.model.frames[robot.pelvis].parentJoint
    for dynamics in random_dynamics:
        com, height = dynamics.com_in_world, dynamics.com_in_world[2] - 0.8
        forces, points = _pressing_forces(rng, height)
        wrenches = np.hstack((forces, np.zeros_like(forces)))
        a = _forward_dynamics(
            robot, dynamics.state, np.zeros(robot.na), wrenches, points, [pelvis] * len(points)
        )
        rate = momentum_rate(dynamics, a)
        reaction = reaction_from_momentum_rate(rate, com, robot.mass, height)
        expected = np.average(points[:, :2], axis=0, weights=forces[:, 2])
        assert_close(cop_from_momentum_rate(rate, com, robot.mass, height), expected, 1e-9)
        assert_close(reaction.cop_in_world, np.append(expected, height), 1e-9)
        assert_close(reaction.force, forces.sum(axis=0), 1e-8)
        moment_at_cop = np.cross(points - reaction.cop_in_world, forces).sum(axis=0)
        assert_close(moment_at_cop, [0.0, 0.0, reaction.normal_moment], 1e-7)


def test_over_another_plane_the_cop_slides_along_the_force_and_keeps_its_normal_moment(rng):
    """All these points lie on one line, the one along f on which the moment is vertical."""
    for _ in range(50):
        rate, com = rng.normal(scale=50.0, size=6), rng.normal(size=3)
        here, above = (reaction_from_momentum_rate(rate, com, MASS, height) for height in (0.0, 0.4))
        assert_close(np.cross(above.cop_in_world - here.cop_in_world, here.force), np.zeros(3), 1e-9)
        assert above.normal_moment == pytest.approx(here.normal_moment, abs=1e-9)


def test_cmp_lies_on_the_line_of_force_through_the_com(rng):
    """Eq. 22: no moment about the CoM if the force acted at the CMP."""
    for _ in range(50):
        force, com, height = rng.normal(size=3) + np.array([0.0, 0.0, 5.0]), rng.normal(size=3), rng.normal()
        cmp = np.append(cmp_from_force(force, com, height), height)
        assert_close(np.cross(cmp - com, force), np.zeros(3), 1e-9)


def test_gap_between_cop_and_cmp_is_the_moment_arm(rng):
    """Eq. 23 as the difference of Eqs. 22 and 21."""
    for _ in range(50):
        rate, com, height = rng.normal(scale=100.0, size=6), rng.normal(size=3), rng.normal()
        force = ground_reaction_force(rate[:3], MASS)
        cop = cop_from_momentum_rate(rate, com, MASS, height)
        gap = cmp_cop_gap(rate[3:], force[2])
        assert_close(cmp_from_force(force, com, height) - cop, gap, 1e-9)
        assert np.hypot(*gap) == pytest.approx(np.hypot(rate[3], rate[4]) / abs(force[2]), abs=1e-12)


def test_rotation_with_a_forward_push_puts_the_cmp_ahead_of_the_cop():
    """Nose down is rotation about +y; it needs the force to pass behind the CoM."""
    gap = cmp_cop_gap(np.array([0.0, 30.0, 0.0]), 300.0)
    assert_close(gap, [0.1, 0.0], 1e-15)


def test_moving_the_cop_back_under_the_same_force_turns_the_body_forward(rng):
    """What a desired CoP beyond the toes costs: dk_a - dk_d = (p_a - p_d) x f, here +y and nothing else but yaw."""
    com, force = rng.normal(size=3), np.array([-80.0, 0.0, 600.0])
    desired, admissible = np.array([0.13, 0.0, 0.0]), np.array([0.09, 0.0, 0.0])
    rates = [
        momentum_rate_from_reaction(GroundReaction(force, p, 0.0), com, MASS) for p in (desired, admissible)
    ]
    assert_close(rates[1] - rates[0], [0.0, 0.0, 0.0, 0.0, 0.04 * 600.0, 0.0], 1e-10)


def test_standing_still_everything_is_under_the_com():
    com, rest = np.array([0.02, -0.1, 0.9]), np.zeros(6)
    assert_close(ground_reaction_force(rest[:3], MASS), [0.0, 0.0, MASS * GRAVITY], 1e-12)
    assert_close(cop_from_momentum_rate(rest, com, MASS), com[:2], 1e-15)
    assert_close(cmp_from_force(ground_reaction_force(rest[:3], MASS), com), com[:2], 1e-15)


def test_ground_wrench_is_the_momentum_rate_without_gravity(rng):
    rate, com = rng.normal(size=6), rng.normal(size=3)
    wrench = ground_wrench_from_momentum_rate(rate, MASS)
    assert_close(momentum_rate_from_wrenches(wrench[None], com[None], com, MASS), rate, 1e-12)
    assert_close(wrench[:3], ground_reaction_force(rate[:3], MASS), 0.0)


def test_sole_cop_on_a_tilted_sole(rng):
    """The mean of the corners in the sole's own axes, whatever the sole's attitude."""
    for _ in range(50):
        forces, corners = _pressing_forces(rng, ground_height=0.0)
        rotation, origin = random_rotation(rng), rng.normal(size=3)
        points_in_world, forces_in_world = corners @ rotation.T + origin, forces @ rotation.T
        about_world_origin = np.concatenate(
            (forces_in_world.sum(axis=0), np.cross(points_in_world, forces_in_world).sum(axis=0))
        )
        wrench = wrench_in_frame_axes(shift_wrench(about_world_origin, np.zeros(3), origin), rotation)
        assert_close(sole_cop(wrench), np.average(corners[:, :2], axis=0, weights=forces[:, 2]), 1e-9)


def test_points_do_not_exist_without_a_normal_force():
    sideways = np.array([3.0, 1.0, 0.0, 0.2, 0.1, 0.0])
    falling = np.array([0.0, 0.0, -MASS * GRAVITY, 0.0, 0.0, 0.0])
    com = np.array([0.0, 0.0, 0.9])
    points = (
        cop_from_wrench(sideways, com),
        sole_cop(sideways),
        cmp_from_force(sideways[:3], com),
        cmp_cop_gap(sideways[3:], 0.0),
        cop_from_momentum_rate(falling, com, MASS),
        reaction_from_momentum_rate(falling, com, MASS).cop_in_world[:2],
    )
    assert np.isnan(points).all()


def test_printed_eqs_21_to_23_hold_in_y_up_axes(rng):
    for _ in range(50):
        rate, com = rng.normal(scale=100.0, size=6), rng.normal(size=3)
        f, tau, r = (y_up_from_z_up(x) for x in (ground_reaction_force(rate[:3], MASS), rate[3:], com))
        p = _printed_eq_21(f, tau, r)
        s = np.array([r[0] - f[0] / f[1] * r[1], 0.0, r[2] - f[2] / f[1] * r[1]])
        assert_close(z_up_from_y_up(p)[:2], cop_from_momentum_rate(rate, com, MASS), 1e-9)
        assert_close(z_up_from_y_up(s)[:2], cmp_from_force(ground_reaction_force(rate[:3], MASS), com), 1e-9)
        assert_close([s[0] - p[0], s[2] - p[2]], [-tau[2] / f[1], tau[0] / f[1]], 1e-9)


def test_eq_21_with_y_and_z_merely_exchanged_is_wrong(rng):
    """A reflection: the sign of every moment is lost."""
    swapped = [0, 2, 1]
    rate, com = rng.normal(scale=100.0, size=6), rng.normal(size=3)
    force = ground_reaction_force(rate[:3], MASS)
    p = _printed_eq_21(force[swapped], rate[3:][swapped], com[swapped])[swapped]
    assert np.linalg.norm(p[:2] - cop_from_momentum_rate(rate, com, MASS)) > 0.1


def test_eqs_40_and_41_as_printed_are_wrong_and_corrected_are_right(rng):
    """Two slips: r_Gz opens Eq. 40 in place of r_Gx, and g enters the denominators without its sign."""
    worst_axis = worst_sign = 0.0
    for _ in range(50):
        rate, com = rng.normal(scale=100.0, size=6), rng.normal(size=3)
        expected = cop_from_momentum_rate(rate, com, MASS)
        l_dot, k_dot, r = (y_up_from_z_up(x) for x in (rate[:3], rate[3:], com))
        f = l_dot + np.array([0.0, MASS * GRAVITY, 0.0])

        def cop(first_term, denominator, f=f, r=r, k_dot=k_dot):
            x = first_term - (f[0] * r[1] - k_dot[2]) / denominator
            z = r[2] - (f[2] * r[1] + k_dot[0]) / denominator
            return z_up_from_y_up(np.array([x, 0.0, z]))[:2]

        assert_close(cop(r[0], l_dot[1] + MASS * GRAVITY), expected, 1e-9)
        worst_axis = max(worst_axis, np.abs(cop(r[2], l_dot[1] + MASS * GRAVITY) - expected).max())
        worst_sign = max(worst_sign, np.abs(cop(r[0], l_dot[1] - MASS * GRAVITY) - expected).max())
    assert worst_axis > 0.1
    assert worst_sign > 0.1


def test_points_move_and_turn_with_the_world(rng):
    turn, shift = yaw_rotation(np.deg2rad(137.0)), np.array([100.0, -30.0, 0.7])
    rate, com = rng.normal(scale=100.0, size=6), rng.normal(size=3)
    turned_rate, moved_com = np.kron(np.eye(2), turn) @ rate, turn @ com + shift
    here = reaction_from_momentum_rate(rate, com, MASS)
    there = reaction_from_momentum_rate(turned_rate, moved_com, MASS, ground_height=0.7)
    assert_close(there.cop_in_world, turn @ here.cop_in_world + shift, 1e-9)
    assert_close(there.force, turn @ here.force, 1e-9)
    assert there.normal_moment == pytest.approx(here.normal_moment, abs=1e-9)
    cmp = cmp_from_force(there.force, moved_com, 0.7)
    assert_close(cmp, turn[:2, :2] @ cmp_from_force(here.force, com) + shift[:2], 1e-9)


def _printed_eq_21(f, tau, r):
    return np.array(
        [r[0] - f[0] / f[1] * r[1] + tau[2] / f[1], 0.0, r[2] - f[2] / f[1] * r[1] - tau[0] / f[1]]
    )


def _pressing_forces(rng, ground_height):
    """Eight forces that push, at points of a horizontal plane around the origin."""
    points = np.column_stack((rng.uniform(-0.2, 0.2, (8, 2)), np.full(8, ground_height)))
    forces = np.column_stack((rng.normal(scale=30.0, size=(8, 2)), rng.uniform(10.0, 200.0, 8)))
    return forces, points


def _forward_dynamics(robot, state, torque, wrenches, points, joints):
    """Acceleration under world-axes wrenches at world points, each acting on the link of a joint."""
    model, data = robot.model, robot.model.createData()
    pin.forwardKinematics(model, data, state.q)
    external = pin.StdVec_Force()
    external.extend([pin.Force.Zero() for _ in range(model.njoints)])
    for wrench, point, joint in zip(wrenches, points, joints, strict=True):
        placement = pin.SE3(data.oMi[joint].rotation, data.oMi[joint].translation - point)
        external[joint] += placement.actInv(pin.Force(wrench))
    generalised = np.concatenate((np.zeros(6), torque))
    return pin.aba(model, model.createData(), state.q, state.v, generalised, external)
