"""Fig. 7: which momentum rate gives way, and how the two ends of the slider are joined."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.control.priority import compromise
from momentum_lab.momentum.support import project_on_friction_cone
from tests.conftest import assert_close

G = 9.81
MASS = 60.0
WEIGHT = np.array([0.0, 0.0, MASS * G])
COM = np.array([0.02, -0.01, 0.85])
FRICTION = 0.6
HEIGHT = 0.03
POLYGON = np.array([[-0.1, -0.15], [0.12, -0.15], [0.12, 0.15], [-0.1, 0.15]])
PRIORITIES = np.linspace(0.0, 1.0, 21)


def moment_free_point(force: np.ndarray, angular_rate: np.ndarray) -> np.ndarray:
    """Eqs. 40 and 41 from Eq. 1 alone: the p on the ground where dk = (p - r) x f + tau_n z, by a linear system."""
    z = HEIGHT - COM[2]
    fx, fy, fz = force
    # dk_x = y fz - z fy, dk_y = z fx - x fz with (x, y) from the CoM.
    x = (z * fx - angular_rate[1]) / fz
    y = (angular_rate[0] + z * fy) / fz
    return COM[:2] + np.array([x, y])


def asked(linear, angular) -> np.ndarray:
    return np.concatenate([linear, angular]).astype(float)


def settle(desired: np.ndarray, priority: float):
    return compromise(desired, COM, MASS, POLYGON, HEIGHT, FRICTION, priority)


TOO_MUCH = [
    pytest.param(asked([-150.0, 0.0, 0.0], [0.0, 0.0, 0.0]), id="beyond the toes"),
    pytest.param(asked([90.0, 170.0, 30.0], [5.0, -12.0, 3.0]), id="beyond a corner"),
    pytest.param(asked([10.0, -20.0, -80.0], [0.0, -120.0, 1.0]), id="too much turning"),
]
ADMISSIBLE = asked([-20.0, 15.0, 10.0], [3.0, -4.0, 1.0])


@pytest.mark.parametrize("priority", [0.0, 0.37, 1.0])
def test_what_is_admissible_is_not_touched(priority):
    answer = settle(ADMISSIBLE, priority)
    assert_close(answer.force, ADMISSIBLE[:3] + WEIGHT, 1e-9)
    assert_close(answer.angular_rate, ADMISSIBLE[3:], 1e-9)
    assert_close(answer.cop_admissible, answer.cop_desired, 1e-12)
    assert_close(answer.cop_desired, moment_free_point(answer.force, answer.angular_rate), 1e-12)


@pytest.mark.parametrize("desired", TOO_MUCH)
def test_priority_0_keeps_the_force_and_moves_it_to_the_border(desired):
    """Fig. 7 left: dl_a = dl_d and dk_d - dk_a = (p_d - p_a) x f."""
    answer = settle(desired, 0.0)
    force = desired[:3] + WEIGHT
    assert_close(answer.force, force, 1e-9)
    assert_close(answer.cop_desired, moment_free_point(force, desired[3:]), 1e-12)
    nearest = np.clip(answer.cop_desired, POLYGON.min(0), POLYGON.max(0))
    assert_close(answer.cop_admissible, nearest, 1e-12)
    assert np.linalg.norm(answer.cop_desired - nearest) > 0.01
    shift = np.append(answer.cop_desired - nearest, 0.0)
    assert_close((desired[3:] - answer.angular_rate)[:2], np.cross(shift, force)[:2], 1e-8)
    assert answer.angular_rate[2] == desired[5]


@pytest.mark.parametrize("desired", TOO_MUCH)
def test_priority_1_keeps_the_angular_rate_and_tilts_the_force(desired):
    """Fig. 7 right: dk_a = dk_d and f_z as desired; through the CoP of priority 0 goes another force."""
    answer = settle(desired, 1.0)
    border = settle(desired, 0.0).cop_admissible
    assert_close(answer.angular_rate, desired[3:], 1e-8)
    assert answer.force[2] == pytest.approx(desired[2] + MASS * G, abs=1e-9)
    assert_close(answer.cop_admissible, border, 0.0)
    assert_close(moment_free_point(answer.force, answer.angular_rate), border, 1e-12)
    # The tilt alone makes up for the way from the desired CoP to the border.
    tilt = answer.force - settle(desired, 0.0).force
    way = border - settle(desired, 0.0).cop_desired
    assert_close(tilt[:2], -way * answer.force[2] / (COM[2] - HEIGHT), 1e-8)


@pytest.mark.parametrize("desired", TOO_MUCH)
def test_in_between_the_force_moves_evenly_from_one_end_to_the_other(desired):
    """Affine, hence continuous; the CoP stays on the border all the way."""
    left, right = settle(desired, 0.0), settle(desired, 1.0)
    for priority in PRIORITIES:
        answer = settle(desired, priority)
        assert_close(answer.force, (1 - priority) * left.force + priority * right.force, 1e-9)
        between = (1 - priority) * left.angular_rate + priority * right.angular_rate
        assert_close(answer.angular_rate, between, 1e-9)
        assert_close(moment_free_point(answer.force, answer.angular_rate), left.cop_admissible, 1e-12)


@pytest.mark.parametrize("priority", [0.0, 0.5, 1.0])
def test_the_answer_does_not_jump_where_the_border_is_reached(priority):
    """Just inside and just outside the safe polygon ask for almost the same."""
    answers = []
    for nudge in (-1e-6, 1e-6):
        edge = POLYGON[1, 0] + nudge
        push = -(edge - COM[0]) * MASS * G / (COM[2] - HEIGHT)
        answers.append(settle(asked([push, 0.0, 0.0], [0.0, 0.0, 0.0]), priority))
    assert_close(answers[0].force, answers[1].force, 0.01)
    assert_close(answers[0].angular_rate, answers[1].angular_rate, 0.01)


@pytest.mark.parametrize("priority", [0.0, 0.5, 1.0])
def test_the_force_never_leaves_the_friction_cone(priority, rng):
    for _ in range(200):
        desired = np.concatenate([rng.normal(scale=800.0, size=3), rng.normal(scale=100.0, size=3)])
        force = settle(desired, priority).force
        assert force[2] >= 0.1 * MASS * G - 1e-9
        assert np.hypot(force[0], force[1]) <= FRICTION * force[2] + 1e-9


def test_a_force_outside_the_cone_is_replaced_by_the_nearest_inside():
    """And the desired CoP is that of the replaced force, so that no angular momentum is given up in vain."""
    desired = asked([600.0, 0.0, 0.0], [0.0, 0.0, 0.0])
    answer = settle(desired, 0.0)
    expected = project_on_friction_cone(np.array([600.0, 0.0, MASS * G]), FRICTION)
    assert_close(answer.force, expected, 1e-9)
    assert_close(answer.cop_desired, moment_free_point(expected, np.zeros(3)), 1e-12)


def test_the_compromise_is_the_same_wherever_the_robot_stands():
    far = np.array([80.0, -60.0])
    desired = TOO_MUCH[1].values[0]
    here = settle(desired, 0.4)
    there = compromise(desired, COM + np.append(far, 0.0), MASS, POLYGON + far, HEIGHT, FRICTION, 0.4)
    assert_close(there.force, here.force, 1e-9)
    assert_close(there.angular_rate, here.angular_rate, 1e-8)
    assert_close(there.cop_admissible - far, here.cop_admissible, 1e-12)
