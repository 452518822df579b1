"""Boxes under the feet: where the plates are, and only where the ground is not the floor."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.app.plate_scene import PlateScene
from momentum_lab.scenario import changed, load_scenario
from momentum_lab.session import Session
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
    scene.draw(np.array([pose(0.04, 0.0, 0.0), pose(0.0, 0.0, 0.0)]), (0.7, 0.7), True)
    assert list(client.scene.nodes) == ["/plates/0"]
    # A plate that is level with the floor would be hidden in it: the top is a millimetre above what carries.
    assert_close(top_of(client.scene.nodes["/plates/0"]), [0.02, 0.0, 0.101], 1e-12)
    poses = np.array([pose(0.0, 0.08, 0.2), pose(0.0, -0.08, -0.2)])
    scene.draw(poses, (0.7, 0.2), True)
    for foot in (0, 1):
        box, sole = client.scene.nodes[f"/plates/{foot}"], talos.soles[foot]
        middle = np.append((sole.lower + sole.upper) / 2, 0.001)
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


@pytest.mark.parametrize("name", ["slopes", "board", "ice"])
def test_boxes_are_where_the_feet_are(g1, name):
    """The top of each box is under the middle of its sole, in the run that is drawn."""
    session = Session(changed(load_scenario(name), robot="g1"), robot=g1)
    for _ in range(1200):
        session.tick()
    client, sample = FakeClient(), session.recording.latest
    PlateScene(client, g1).draw(sample["ground_pose"], tuple(session.ground.friction(1.2)), True)
    for foot, sole in enumerate(g1.soles):
        middle = np.append((sole.lower + sole.upper) / 2, 0.001)
        there = pin.XYZQUATToSE3(sample["sole_pose"][foot]).act(middle)
        assert np.abs(top_of(client.scene.nodes[f"/plates/{foot}"]) - there).max() < 0.01
