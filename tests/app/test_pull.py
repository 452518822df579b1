"""From a drag to a push: where the pointer's ray meets the plane, how strong, and in which steps."""

from __future__ import annotations

import math

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.app.pull import Drag, Grip, Scale, WayBack, body_of, finite, grip, lifted, pulled
from momentum_lab.errors import InputError
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.physics.push import Push
from momentum_lab.robot.posture import standing_posture
from tests.conftest import assert_close

POINT = np.array([0.1, -0.05, 1.1])
GRIP = Grip("trunk", (0.1, 0.0, 0.2))


def eye_at(azimuth: float, elevation: float, distance: float = 4.0) -> np.ndarray:
    """One that is near the point, from so many degrees about the vertical and above."""
    a, e = math.radians(azimuth), math.radians(elevation)
    away = np.array([math.cos(a) * math.cos(e), math.sin(a) * math.cos(e), math.sin(e)])
    return POINT + distance * away


def pointer_over(eye: np.ndarray, target: np.ndarray) -> np.ndarray:
    """Where the ray through a target meets the plane across a view that does not quite go through the point."""
    ray, into = target - eye, POINT + [0.05, 0.1, -0.2] - eye
    return eye + ray * ((POINT - eye) @ into) / (ray @ into)


@pytest.mark.parametrize("azimuth", [0.0, -62.0, 135.0])
@pytest.mark.parametrize("elevation", [30.0, 50.0, 85.0])
@pytest.mark.parametrize("distance", [(0.3, 0.0), (0.0, -0.25), (-0.2, 0.15)])
def test_the_tip_of_the_arrow_is_under_the_pointer(azimuth, elevation, distance):
    eye = eye_at(azimuth, elevation)
    end = pointer_over(eye, POINT + [*distance, 0.0])
    assert_close(pulled(eye, POINT, end), np.array([*distance, 0.0]), 1e-9)


def test_a_flat_view_is_no_lever():
    """From the side, a pointer that rises by a centimetre is no pull over metres, and still one away from the eye."""
    eye = eye_at(0.0, 2.0)
    distance = pulled(eye, POINT, POINT + [0.0, 0.0, 0.01])
    assert distance[0] == pytest.approx(-0.01 / math.sin(math.radians(20.0)), rel=0.01)
    assert abs(distance[1]) < 1e-6
    assert_close(pulled(eye, POINT, POINT + [0.0, 0.2, 0.0]), np.array([0.0, 0.2, 0.0]), 1e-9)


def test_a_pull_as_long_as_the_arrow_of_the_weight_is_the_weight(talos):
    scale = Scale.of(talos, 0.877, 1.0, 5000.0)
    weight = talos.mass * GRAVITY
    assert np.linalg.norm(scale.force(np.array([0.0, 1.4 * 0.877, 0.0]))) == pytest.approx(weight)
    twice = Scale.of(talos, 0.877, 2.0, 5000.0)
    assert_close(twice.force(np.array([0.4, 0.2, 0.0])), 0.5 * scale.force(np.array([0.4, 0.2, 0.0])), 1e-9)
    assert_close(scale.length(scale.force(np.array([0.4, 0.2, 0.0]))), np.array([0.4, 0.2, 0.0]), 1e-12)


def test_a_long_pull_is_the_strongest_and_a_tiny_one_none():
    scale = Scale(700.0, 650.0)
    assert_close(scale.force(np.array([3e8, 0.0, 4e8])), np.array([390.0, 0.0, 520.0]), 1e-6)
    assert not scale.force(np.array([0.018, 0.0, 0.0])).any()  # 12.6 N of 650 N
    assert scale.force(np.array([0.02, 0.0, 0.0])).any()


def test_a_pulse_is_what_the_sliders_can_show():
    push = GRIP.pulse(np.array([-100.3, 57.8, 0.0]), 0.25)
    assert push == Push(force=116.0, duration=0.25, direction_deg=150.0, body="trunk", point=(0.1, 0.0, 0.2))


def test_a_resting_hand_that_trembles_holds_the_same_push():
    steady = GRIP.piece(np.array([130.0, 1.0, 0.0]), 650.0)
    assert GRIP.piece(np.array([131.5, -2.0, 0.0]), 650.0) == steady
    assert steady.force == 130.0
    assert (
        GRIP.piece(np.array([140.0, 0.0, 0.0]), 650.0).force == 143.0
    )  # steps of a hundredth of the strongest: 6.5 N
    assert GRIP.piece(np.array([130.0, 13.0, 0.0]), 650.0).direction_deg == 5.0
    assert GRIP.piece(np.array([650.0, 0.0, 0.0]), 650.0).force == 650.0


def test_a_grip_keeps_its_place_on_the_body(talos):
    q = standing_posture(talos)
    joint = talos.model.getJointId("arm_left_7_joint")
    held = grip(talos, q, joint, POINT)
    data = talos.model.createData()
    pin.framesForwardKinematics(talos.model, data, q)
    assert held.body == "left_hand"
    frame = talos.frame(talos.spec.push_bodies["left_hand"])
    assert_close(data.oMf[frame].act(np.array(held.point)), POINT, 1e-3)


def test_every_part_of_a_robot_has_a_name(robot):
    for joint in range(1, robot.model.njoints):
        name, frame = body_of(robot, joint)
        assert robot.model.frames[frame].parentJoint == joint
        assert robot.frame(robot.spec.push_bodies.get(name, name)) == frame


def test_a_push_that_was_lifted_keeps_all_three_components():
    push = GRIP.pulse(np.array([0.0, -30.0, 40.0]), 0.1)
    assert (push.force, push.direction_deg, push.elevation_deg) == (50.0, -90.0, 53.0)
    assert GRIP.pulse(np.array([0.0, 0.0, -50.0]), 0.1).elevation_deg == -90.0
    assert GRIP.piece(np.array([100.0, 0.0, 10.0]), 650.0).elevation_deg == 5.0


@pytest.mark.parametrize("azimuth", [0.0, -62.0, 135.0])
@pytest.mark.parametrize("elevation", [-10.0, 11.0, 50.0])
@pytest.mark.parametrize(("sideways", "up"), [(0.0, 0.3), (0.2, -0.25), (-0.3, 0.0)])
def test_in_the_upright_plane_the_tip_is_under_the_pointer_too(azimuth, elevation, sideways, up):
    eye, a = eye_at(azimuth, elevation), math.radians(azimuth)
    distance = np.array([-sideways * math.sin(a), sideways * math.cos(a), up])
    assert_close(lifted(eye, POINT, pointer_over(eye, POINT + distance)), distance, 1e-9)


def test_a_view_from_straight_above_lifts_nobody_to_the_sky():
    eye = POINT + [0.0, 0.0, 4.0]
    moved = lifted(eye, POINT, POINT + [0.01, 0.0, 0.0])
    assert np.linalg.norm(moved) < 0.1


def test_a_hand_is_back_only_after_it_has_been_away():
    way = WayBack()
    assert [way.is_back(off) for off in (0.0, 0.01, 0.04, 0.01, 0.2, 0.03, 0.02)] == [False] * 6 + [True]


def test_how_far_a_pointer_is_off_is_told_in_heights_of_the_picture():
    places = (tuple(POINT), tuple(POINT), (0.0, 0.0, 0.0))
    assert Drag.checked(places, ((0.5, 0.5), (0.7, 0.5), (1000, 500))).off == pytest.approx(0.4)
    assert Drag.checked(places, ((0.5, 0.5), (0.5, 0.7), (1000, 500))).off == pytest.approx(0.2)
    for size in ((0, 500), (1000, -1), (1000, math.nan), None):
        with pytest.raises(InputError, match=r"^picture: got "):
            Drag.checked(places, ((0.5, 0.5), (0.7, 0.5), size))


@pytest.mark.parametrize(
    "value", [None, "abc", (1.0, 2.0), (1.0, math.nan, 0.0), (math.inf, 0.0, 0.0), [[1.0]] * 3]
)
def test_what_is_no_place_is_refused(value):
    with pytest.raises(InputError, match=r"drag: got .*; allowed: 3"):
        finite(value, 3, "drag")
