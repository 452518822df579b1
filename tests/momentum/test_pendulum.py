"""The linear inverted pendulum, integrated exactly with the matrix exponential."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import expm

from momentum_lab.errors import InputError
from momentum_lab.momentum.ground import GRAVITY, cmp_from_force
from momentum_lab.momentum.pendulum import (
    capture_point,
    flywheel_reach,
    orbital_energy,
    pendulum_frequency,
    pendulum_impulse_bound,
    predict_dcm,
)
from tests.conftest import assert_close

MASS, HEIGHT = 50.0, 0.8
OMEGA = np.sqrt(9.81 / HEIGHT)


def test_frequency_is_that_of_a_falling_pendulum():
    assert pendulum_frequency(9.81) == pytest.approx(1.0, abs=1e-15)
    assert pendulum_frequency(HEIGHT) == pytest.approx(OMEGA, abs=1e-12)
    assert pendulum_frequency(9.81e-4) == pytest.approx(100.0, abs=1e-12)


@pytest.mark.parametrize("height", [0.0, -0.1, float("nan")])
def test_there_is_no_pendulum_below_the_ground(height):
    assert np.isnan(pendulum_frequency(height))
    assert np.isnan(capture_point(np.array([0.0, 0.0, height]), np.ones(3))).all()


def test_com_comes_to_rest_above_the_capture_point(rng):
    for _ in range(20):
        com, velocity, height = _random_pendulum(rng)
        capture = capture_point(com, velocity, height)
        com_later, velocity_later = _fall(com, velocity, capture, 4.0 / OMEGA)
        assert_close(com_later - capture, (com[:2] - capture) * np.exp(-4.0), 1e-9)
        assert_close(velocity_later, -OMEGA * (com_later - capture), 1e-9)


def test_capture_point_is_under_a_com_at_rest():
    assert_close(capture_point(np.array([0.3, -0.2, 0.8]), np.zeros(3)), [0.3, -0.2], 0.0)


def test_dcm_prediction(rng):
    for _ in range(20):
        com, velocity, height = _random_pendulum(rng)
        pivot, duration = rng.uniform(-0.1, 0.1, 2), rng.uniform(0.0, 1.0)
        com_later, velocity_later = _fall(com, velocity, pivot, duration)
        predicted = predict_dcm(capture_point(com, velocity, height), pivot, OMEGA, duration)
        assert_close(predicted, com_later + velocity_later / OMEGA, 1e-9)


def test_the_cmp_drives_the_dcm(rng):
    """d xi/dt = omega (xi - s) with the CMP of Eq. 22, whatever the angular momentum does."""
    for _ in range(20):
        com, velocity, height = _random_pendulum(rng)
        force = np.append(rng.normal(scale=100.0, size=2), MASS * GRAVITY)
        dcm_rate = velocity[:2] + force[:2] / MASS / OMEGA
        dcm, cmp = capture_point(com, velocity, height), cmp_from_force(force, com, height)
        assert_close(dcm_rate, OMEGA * (dcm - cmp), 1e-9)


def test_orbital_energy_stays(rng):
    for _ in range(20):
        com, velocity, _ = _random_pendulum(rng)
        pivot = rng.uniform(-0.1, 0.1, 2)
        com_later, velocity_later = _fall(com, velocity, pivot, 0.4)
        later = orbital_energy(np.append(com_later, 0.0), np.append(velocity_later, 0.0), pivot, OMEGA)
        assert_close(later, orbital_energy(com, velocity, pivot, OMEGA), 1e-9)


def test_orbital_energy_vanishes_with_the_cop_on_the_capture_point(rng):
    com, velocity, height = _random_pendulum(rng)
    capture = capture_point(com, velocity, height)
    assert_close(orbital_energy(com, velocity, capture, OMEGA), np.zeros(2), 1e-9)


def test_orbital_energy_is_kinetic_above_the_cop():
    com, velocity = np.array([0.3, -0.1, HEIGHT]), np.array([0.4, -0.6, 0.0])
    assert_close(orbital_energy(com, velocity, com[:2], OMEGA), [0.08, 0.18], 1e-12)


@pytest.mark.parametrize(("speed", "passes"), [(0.40, True), (0.30, False)])
def test_sign_of_orbital_energy_tells_whether_the_com_passes_the_cop(speed, passes):
    com, velocity, pivot = np.array([-0.1, 0.0, HEIGHT]), np.array([speed, 0.0, 0.0]), np.zeros(2)
    com_later, _ = _fall(com, velocity, pivot, 3.0)
    assert bool(com_later[0] > 0.0) is passes
    assert bool(orbital_energy(com, velocity, pivot, OMEGA)[0] > 0.0) is passes


@pytest.mark.parametrize("duration", [0.01, 0.1, 0.4])
def test_flywheel_catches_exactly_its_reach(duration):
    """+tau, then -tau: the capture point ends on the CoP, the flywheel at rest."""
    torque = 60.0
    reach = flywheel_reach(torque, duration, OMEGA, MASS)
    dcm, angular_momentum = reach, 0.0
    for tau in (torque, -torque):
        dcm = _dcm_under_constant_moment(dcm, tau, duration)
        angular_momentum += tau * duration
    assert dcm == pytest.approx(0.0, abs=1e-9)
    assert angular_momentum == 0.0


def test_short_strong_lurch_reaches_inertia_times_angle():
    """Delta -> I theta / (m z_c)."""
    inertia, angle, duration = 4.0, 0.5, 1e-5
    torque = inertia * angle / duration**2
    limit = inertia * angle / (MASS * HEIGHT)
    assert flywheel_reach(torque, duration, OMEGA, MASS) == pytest.approx(limit, rel=1e-4)


@pytest.mark.parametrize("duration", [1e-6, 0.01, 0.1, 0.5])
def test_bounding_push_leaves_the_capture_point_on_the_edge(duration):
    edge = 0.09
    force = pendulum_impulse_bound(MASS, OMEGA, edge, duration) / duration
    system = np.array([[0.0, 1.0, 0.0], [OMEGA**2, 0.0, force / MASS - OMEGA**2 * edge], [0.0, 0.0, 0.0]])
    position, velocity, _ = expm(system * duration) @ [0.0, 0.0, 1.0]
    assert position + velocity / OMEGA == pytest.approx(edge, abs=1e-9)


def test_instantaneous_push_is_the_limit_and_longer_pushes_may_be_larger():
    bounds = [pendulum_impulse_bound(MASS, OMEGA, 0.09, duration) for duration in (0.0, 1e-12, 0.1, 0.2)]
    assert bounds[0] == pytest.approx(MASS * OMEGA * 0.09, abs=1e-12)
    assert bounds[1] == pytest.approx(bounds[0], rel=1e-9)
    assert bounds[0] < bounds[2] < bounds[3]


@pytest.mark.parametrize("duration", [-0.1, float("nan")])
def test_push_duration_must_not_be_negative(duration):
    with pytest.raises(InputError, match=r"^duration: got (-0.1|nan); allowed: 0 s or more$"):
        pendulum_impulse_bound(MASS, OMEGA, 0.09, duration)


def _random_pendulum(rng):
    """CoM 0.8 m above a ground of random height, moving."""
    height = rng.normal()
    com = np.append(rng.uniform(-0.2, 0.2, 2), height + HEIGHT)
    return com, np.append(rng.uniform(-0.5, 0.5, 2), 0.0), height


def _fall(com, velocity, pivot, duration):
    """r'' = omega^2 (r - p), both axes."""
    flow = expm(np.array([[0.0, 1.0], [OMEGA**2, 0.0]]) * duration)
    offset, speed = flow @ np.array([com[:2] - pivot, velocity[:2]])
    return pivot + offset, speed


def _dcm_under_constant_moment(dcm, moment, duration):
    """xi' = omega (xi - s) with s = p + k_dot_y / (m g) and the CoP at 0 (Eq. 23)."""
    system = np.array([[OMEGA, -OMEGA * moment / (MASS * 9.81)], [0.0, 0.0]])
    return float((expm(system * duration) @ [dcm, 1.0])[0])
