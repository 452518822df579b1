"""The camera sees the whole robot, in every window."""

from __future__ import annotations

import math

import numpy as np
import pytest

from momentum_lab.app.camera import LOOSE, TIGHT, USUAL, VIEWS, Camera, Opening, camera_pose
from momentum_lab.app.page_plan import BAR_HEIGHT
from momentum_lab.lesson import parts
from tests.app.fakes import FakeClient

FIELD_OF_VIEW = math.radians(32.0)


def seen(point: np.ndarray, target: np.ndarray, position: np.ndarray, aspect: float) -> np.ndarray:
    """Where a point is in the picture: x and y from -1 to 1, by plain pinhole geometry."""
    forward = (target - position) / np.linalg.norm(target - position)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    ray = point - position
    depth, scale = ray @ forward, math.tan(FIELD_OF_VIEW / 2)
    return np.array([ray @ right / depth / scale / aspect, ray @ up / depth / scale])


@pytest.mark.parametrize("aspect", [0.46, 0.75, 1.6, 2.4])
@pytest.mark.parametrize("size", [0.66, 0.88])
def test_a_standing_robot_fits(aspect, size):
    center = np.array([100.0, -3.0])
    target, position = camera_pose(VIEWS["Whole robot"], size, center, Opening(aspect))
    for height in (0.0, 1.9 * size):
        for side in (-0.3, 0.3):
            point = np.array([100.0, -3.0 + side * size, height])
            assert np.abs(seen(point, target, position, aspect)).max() < 1.0


def test_on_a_phone_the_robot_is_above_the_controls():
    client = FakeClient()
    client.camera.image_width, client.camera.image_height = 390, 844
    target, position = camera_pose(VIEWS["Whole robot"], 0.88, np.zeros(2), Opening.of(client, 0.0))
    assert seen(np.zeros(3), target, position, 390 / 844)[1] > 0.2


@pytest.mark.parametrize("name", VIEWS)
def test_a_bar_covers_nothing_that_a_view_shows(name):
    client, view = FakeClient(), VIEWS[name]
    edge = -1.0 + 2.0 * BAR_HEIGHT / 800.0  # of the bar, in a picture of 800 pixels from -1 to 1
    target, position = camera_pose(view, 0.88, np.zeros(2), Opening.of(client, BAR_HEIGHT))
    assert seen(np.array([0.0, 0.0, 0.97 * view.low * 0.88]), target, position, 1.6)[1] > edge
    assert seen(np.array([0.0, 0.0, 0.93 * view.high * 0.88]), target, position, 1.6)[1] < 1.0


@pytest.mark.parametrize("height", [1, 100, 150, 160])
def test_a_window_that_is_lower_than_its_bar_shows_the_robot_upright(height):
    client = FakeClient()
    client.camera.image_height = height
    target, position = camera_pose(VIEWS["Whole robot"], 0.88, np.zeros(2), Opening.of(client, BAR_HEIGHT))
    assert 0.5 < np.linalg.norm(position - target) < 1e3
    assert (
        seen(np.array([0.0, 0.0, 1.0]), target, position, 1.6)[1]
        > seen(np.zeros(3), target, position, 1.6)[1]
    )


def test_a_push_forward_points_to_the_right_of_the_picture():
    target, position = camera_pose(VIEWS["Whole robot"], 0.88, np.zeros(2), Opening(1.0))
    ahead = seen(np.array([0.3, 0.0, 0.9]), target, position, 1.0)
    assert ahead[0] > 0.1


def test_looking_sets_the_camera():
    client = FakeClient()
    Camera(client, 0.88).look("Side", np.array([1.0, 2.0]))
    assert client.camera.look_at[:2] == pytest.approx([1.0, 2.0])
    assert client.camera.position[1] < 2.0
    assert client.camera.position[0] == pytest.approx(1.0)


def test_lessons_know_every_view():
    assert tuple(VIEWS) == parts.VIEWS


def test_from_above_forward_is_up_and_left_is_left():
    target, position = camera_pose(VIEWS["Above"], 0.88, np.zeros(2), USUAL)
    assert seen(np.array([0.3, 0.0, 0.9]), target, position, USUAL.aspect)[1] > 0.2
    assert seen(np.array([0.0, 0.3, 0.9]), target, position, USUAL.aspect)[0] < -0.1


def test_the_view_goes_along_only_when_the_robot_leaves():
    client = FakeClient()
    camera = Camera(client, 1.0)
    camera.look("Side", np.zeros(2))
    before = client.camera.position.copy()
    camera.follow(np.array([0.3, 0.0]), LOOSE)
    assert np.array_equal(client.camera.position, before)
    camera.follow(np.array([1.0, 0.0]), LOOSE)
    assert client.camera.position - before == pytest.approx([1.0 - LOOSE, 0.0, 0.0])
    camera.follow(np.array([1.0, 0.0]), TIGHT)
    assert client.camera.position - before == pytest.approx([1.0 - TIGHT, 0.0, 0.0])


@pytest.mark.parametrize("position", [np.nan, np.inf])
def test_a_camera_that_a_client_has_broken_is_left_alone(position):
    client = FakeClient()
    camera = Camera(client, 1.0)
    client.camera.position = np.full(3, position)
    camera.follow(np.array([5.0, 0.0]), LOOSE)
    assert not np.isfinite(client.camera.position).any()


def test_a_window_without_height_has_a_usual_shape():
    client = FakeClient()
    client.camera.image_height = 0
    Camera(client, 0.88).look("Whole robot", np.zeros(2))
    assert np.isfinite(client.camera.position).all()


def test_two_robots_are_looked_at_again_when_a_panel_takes_some_of_the_picture():
    client = FakeClient()
    camera, center = Camera(client, 0.9), np.zeros(2)
    for spread, goes_away in ((None, False), (np.array([0.0, 1.4]), True)):
        client.camera.image_width = 1280
        camera.look("Whole robot", center, spread)
        near = float(np.linalg.norm(client.camera.position))
        client.camera.image_width = 580
        camera.follow(center, 0.35)
        assert (np.linalg.norm(client.camera.position) > 1.1 * near) == goes_away
        person = client.camera.position = client.camera.position + 0.3
        camera.follow(center, 0.35)  # and never again: a person may have turned it
        np.testing.assert_array_equal(client.camera.position, person)
