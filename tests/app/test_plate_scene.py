"""Boxes under the feet: where the plates are, and only where the ground is not the floor."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from momentum_lab.app.plate_scene import PlateScene
from tests.app.fakes import FakeClient
from tests.conftest import assert_close


def pose(x: float, y: float, roll: float) -> np.ndarray:
    return pin.SE3ToXYZQUAT(pin.SE3(pin.utils.rotate("x", roll), np.array([x, y, 0.1])))


def top_of(box) -> np.ndarray:
    """A point in the middle of a box's upper side (3,), m."""
    w, x, y, z = box.wxyz
    thickness = box.dimensions[2]
    return box.position + pin.Quaternion(w, x, y, z).toRotationMatrix() @ [0.0, 0.0, thickness / 2]


def test_there_is_no_box_on_the_floor(talos):
    client = FakeClient()
    PlateScene(client, talos).draw(np.array([pose(0, 0, 0)] * 2), (0.7, 0.7), False)
    assert not client.scene.nodes


def test_one_platform_or_a_plate_under_each_foot(talos):
    client = FakeClient()
    scene = PlateScene(client, talos)
    scene.draw(np.array([pose(0.02, 0.0, 0.1)] * 2), (0.7, 0.7), True)
    assert_close(top_of(client.scene.nodes["/plates/0"]), [0.02, 0.0, 0.1], 1e-12)
    poses = np.array([pose(0.0, 0.08, 0.2), pose(0.0, -0.08, -0.2)])
    scene.draw(poses, (0.7, 0.2), True)
    for foot in (0, 1):
        box, sole = client.scene.nodes[f"/plates/{foot}"], talos.soles[foot]
        middle = np.append((sole.lower + sole.upper) / 2, 0.0)
        assert_close(top_of(box), pin.XYZQUATToSE3(poses[foot]).act(middle), 1e-12)
    left, right = (client.scene.nodes[f"/plates/{foot}"].color for foot in (0, 1))
    assert left != right  # ice looks like ice
    scene.remove()
    assert client.scene.nodes["/plates/1"].removed


def test_plates_at_rest_are_not_sent_again(talos):
    client = FakeClient()
    scene, poses = PlateScene(client, talos), np.array([pose(0, 0.1, 0.1), pose(0, -0.1, 0)])
    scene.draw(poses, (0.7, 0.7), True)
    box = client.scene.nodes["/plates/0"]
    box.position = "untouched"
    scene.draw(poses, (0.7, 0.7), True)
    assert box.position == "untouched"
