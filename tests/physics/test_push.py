"""Pushes deliver what they say: this impulse, at this point, in this time."""

from __future__ import annotations

import dataclasses

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.errors import InputError
from momentum_lab.physics.ground import Ground
from momentum_lab.physics.push import Push, apply_pushes
from momentum_lab.physics.simulator import Simulator
from momentum_lab.robot.state import State
from tests.conftest import assert_close, random_state

FORCE = 123.0
AREA_UNDER = {"rectangle": 1.0, "half-sine": 2.0 / np.pi}


@pytest.mark.parametrize("shape", AREA_UNDER)
@pytest.mark.parametrize("timestep", [1e-4, 7e-4, 1e-3, 2e-3])
@pytest.mark.parametrize(("start", "duration"), [(0.5, 0.1), (0.1234, 0.0137), (0.2, 3e-4), (0.0, 0.7)])
def test_the_impulse_is_exact_for_any_duration_and_timestep(shape, timestep, start, duration):
    push = Push(force=FORCE, duration=duration, start=start, shape=shape)
    ticks = np.arange(0, round((start + duration) / timestep) + 3) * timestep
    delivered = timestep * sum(push.mean_force(time, timestep) for time in ticks)
    assert delivered == pytest.approx(FORCE * duration * AREA_UNDER[shape], rel=1e-9)
    assert push.impulse == pytest.approx(delivered, rel=1e-9)


@pytest.mark.parametrize("shape", AREA_UNDER)
def test_the_force_has_its_shape_in_time(shape):
    """The peak is the force; a half sine is symmetric and starts and ends at zero."""
    push = Push(force=FORCE, duration=0.2, start=1.0, shape=shape)
    middle = push.mean_force(1.1 - 5e-7, 1e-6)
    assert middle == pytest.approx(FORCE, rel=1e-6)
    early, late = push.mean_force(1.03, 1e-6), push.mean_force(1.17 - 1e-6, 1e-6)
    assert early == pytest.approx(late, rel=1e-6)
    expected = FORCE if shape == "rectangle" else FORCE * np.sin(np.pi * 0.03 / 0.2)
    assert early == pytest.approx(expected, rel=1e-4)
    assert push.mean_force(0.99, 1e-3) == 0.0
    assert push.mean_force(1.21, 1e-3) == 0.0


@pytest.mark.parametrize("shape", AREA_UNDER)
def test_a_velocity_change_becomes_a_force_for_a_mass(shape):
    push = Push(velocity_change=0.24, duration=0.1, shape=shape).sized_for(50.0)
    assert push.impulse == pytest.approx(50.0 * 0.24)
    assert push.force == pytest.approx(120.0 / AREA_UNDER[shape])
    assert push.velocity_change is None
    sized = Push(force=FORCE)
    assert sized.sized_for(50.0) == sized


@pytest.mark.parametrize("sizes", [{}, {"force": 10.0, "velocity_change": 0.1}])
def test_a_push_needs_one_size(sizes):
    with pytest.raises(InputError, match="either a force"):
        Push(**sizes).sized_for(50.0)


@pytest.mark.parametrize(
    ("field", "value", "allowed"),
    [
        ("force", -1.0, "from 0 to 5000 N"),
        ("force", np.nan, "from 0 to 5000 N"),
        ("duration", 0.0, "above 0 to 10 s"),
        ("duration", np.inf, "above 0 to 10 s"),
        ("direction_deg", 361.0, "from -360 to 360 degrees"),
        ("start", -0.1, "from 0 to 3600 s"),
        ("height", 0.0, "above 0 to 3 m"),
        ("height", np.nan, "above 0 to 3 m"),
    ],
)
def test_a_push_is_made_of_numbers_in_their_ranges(field, value, allowed):
    with pytest.raises(InputError, match=f"{field}: got {value}; allowed: {allowed}"):
        Push(**{"force": 10.0, field: value}).sized_for(50.0)


@pytest.mark.parametrize(
    ("degrees", "direction"),
    [(0, [1, 0, 0]), (90, [0, 1, 0]), (180, [-1, 0, 0]), (-90, [0, -1, 0]), (45, [0.5**0.5, 0.5**0.5, 0])],
)
def test_directions_are_forward_then_left(degrees, direction):
    assert_close(Push(force=1.0, direction_deg=degrees).direction, direction, 1e-12)


def test_generalized_forces_do_the_work_of_the_force(robot, rng):
    """Virtual power: tau . v = F . velocity of the pushed body's point, by finite differences."""
    for body in (None, "head", "left_hand"):
        state = random_state(robot, rng)
        dynamics = robot.at(state)
        push = Push(force=FORCE, direction_deg=33.0, height=1.1, start=0.0, body=body)
        applied = apply_pushes(robot, robot.model.createData(), dynamics, (push,), 0.0, 1e-3)
        link = robot.trunk if body is None else robot.frame(robot.spec.push_bodies[body])
        data = robot.model.createData()
        pin.framesForwardKinematics(robot.model, data, state.q)
        point = push.point_of_action(dynamics, data.oMf[link])
        fixed_to_link = data.oMf[link].actInv(point)
        places = []
        for eps in (-1e-6, 1e-6):
            pin.framesForwardKinematics(robot.model, data, robot.integrate(state.q, eps * state.v))
            places.append(data.oMf[link].act(fixed_to_link))
        velocity = (places[1] - places[0]) / 2e-6
        power = FORCE * push.direction @ velocity
        assert applied.generalized @ state.v == pytest.approx(power, rel=1e-6, abs=1e-5)


def in_flight(robot, pushes, height=2.0):
    """One step of a robot at rest in the air, and the momentum it has gained about its CoM."""
    dynamics = robot.at(airborne(robot, height))
    simulator = Simulator(robot, Ground.level(2, 0.7), 1e-3)
    step = simulator.step(dynamics, np.zeros(robot.na), pushes, 0.0)
    return dynamics, step, dynamics.centroidal_map @ step.state.v


def airborne(robot, height):
    state = random_state(robot, np.random.default_rng(4))
    q = state.q.copy()
    q[2] = height
    return State(q, np.zeros(robot.nv))


def test_a_push_through_the_com_changes_linear_momentum_only(robot):
    dt = 1e-3
    _, step, gained = in_flight(robot, (Push(force=FORCE, direction_deg=90.0, start=0.0),))
    assert_close(gained, [0.0, FORCE * dt, -robot.mass * 9.81 * dt, 0.0, 0.0, 0.0], 1e-9)
    assert_close(step.momentum_rate, gained / dt, 1e-6)


def test_a_push_at_a_height_adds_its_moment_about_the_com(robot):
    """dk = (c - r) x F dt: above the CoM a forward push turns the robot forward, about +y."""
    dt = 1e-3
    dynamics = robot.at(airborne(robot, 2.0))
    above = dynamics.com_in_world[2] + 0.4 - dynamics.sole_position[:, 2].min()
    push = Push(force=FORCE, start=0.0, height=above)
    _, step, gained = in_flight(robot, (push,))
    assert_close(gained[3:], [0.0, 0.4 * FORCE * dt, 0.0], 1e-9)
    assert_close(gained[:2], [FORCE * dt, 0.0], 1e-9)
    com = dynamics.com_in_world
    about_origin = np.cross(com + np.array([0.0, 0.0, 0.4]), [FORCE, 0.0, 0.0])
    assert_close(step.push_wrench, [FORCE, 0.0, 0.0, *about_origin], 1e-9)


def test_which_body_is_pushed_changes_the_motion_and_not_the_momentum(robot):
    momenta, motions = [], []
    for body in (None, "head", "left_hand"):
        _, step, gained = in_flight(robot, (Push(force=FORCE, start=0.0, body=body),))
        momenta.append(gained)
        motions.append(step.state.v)
    assert_close(momenta[1:], [momenta[0]] * 2, 1e-9)
    assert np.abs(motions[2] - motions[0]).max() > 1e-3


def test_pushes_add_up_and_none_is_none(robot):
    dynamics = robot.at(airborne(robot, 2.0))
    pushes = (Push(force=50.0, start=0.0), Push(force=20.0, start=0.0, direction_deg=90.0, body="head"))
    data = robot.model.createData()
    both = apply_pushes(robot, data, dynamics, pushes, 0.0, 1e-3)
    alone = [apply_pushes(robot, data, dynamics, (push,), 0.0, 1e-3) for push in pushes]
    for field in dataclasses.fields(both):
        total = sum(getattr(one, field.name) for one in alone)
        assert_close(getattr(both, field.name), total, 1e-12)
    assert apply_pushes(robot, data, dynamics, pushes, 0.2, 1e-3) is None


def test_a_push_lasts_as_long_as_it_says(robot):
    """Over a flight: force times duration, also when it starts and ends between two ticks.

    The momentum of a limp robot whose limbs start to swing is integrated to first order in the step only.
    """
    push = Push(force=FORCE, duration=0.0137, start=0.0105)
    state = airborne(robot, 3.0)
    simulator = Simulator(robot, Ground.level(2, 0.7), 1e-3)
    impulse = np.zeros(6)
    for tick in range(40):
        step = simulator.step(robot.at(state), np.zeros(robot.na), (push,), tick * 1e-3)
        impulse += 1e-3 * step.push_wrench
        state = step.state
    assert impulse[0] == pytest.approx(FORCE * 0.0137, rel=1e-9)
    assert robot.at(state).momentum[0] == pytest.approx(FORCE * 0.0137, rel=0.02)


@pytest.mark.parametrize("elevation", [-90.0, -30.0, 0.0, 45.0, 90.0])
def test_a_push_may_point_up_or_down(elevation):
    """The force has its whole strength whichever way it points; what points up is missing over the ground."""
    push = Push(force=FORCE, direction_deg=90.0, elevation_deg=elevation)
    flat, up = np.cos(np.radians(elevation)), np.sin(np.radians(elevation))
    assert_close(push.direction, [0.0, flat, up], 1e-12)
    assert_close(push.along, [0.0, 1.0], 1e-12)
    assert push.horizontal_part == pytest.approx(flat, abs=1e-12)


def test_how_a_push_points_is_told_to_people():
    assert Push(direction_deg=90.0).towards == "90°"
    assert Push(direction_deg=-45.0, elevation_deg=30.0).towards == "-45°, 30° up"
    assert Push(elevation_deg=-30.0).towards == "0°, 30° down"


@pytest.mark.parametrize("elevation", [91.0, -91.0, float("nan")])
def test_nothing_points_further_up_than_up(elevation):
    with pytest.raises(InputError, match=r"elevation_deg: got .*; allowed: from -90 to 90 degrees"):
        Push(force=FORCE, elevation_deg=elevation).sized_for(50.0)
