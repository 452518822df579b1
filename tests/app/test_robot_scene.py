"""The tree of frames puts every mesh where the robot's kinematics says."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.app.robot_scene import RobotScene
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.recording import Layout
from momentum_lab.robot.geometry import LinkMesh
from momentum_lab.robot.posture import standing_posture
from tests.app.fakes import FakeClient, FakeScene
from tests.conftest import random_state

TRIANGLE = (np.eye(3, dtype=np.float32), np.array([[0, 1, 2]], dtype=np.uint32))


@pytest.fixture
def loaded(talos) -> LoadedRobot:
    meshes = tuple(LinkMesh(joint, *TRIANGLE, (0.5, 0.5, 0.5)) for joint in (1, 7, talos.model.njoints - 1))
    return LoadedRobot(talos, meshes, Layout.of(talos))


@pytest.fixture
def client() -> FakeClient:
    return FakeClient()


def in_world(scene: FakeScene, name: str) -> pin.SE3:
    """Placement of a node from those of all its ancestors."""
    placement, path = pin.SE3.Identity(), ""
    for part in name.strip("/").split("/"):
        path += f"/{part}"
        if path in scene.nodes:
            w, x, y, z = scene.nodes[path].wxyz
            local = pin.SE3(pin.Quaternion(w, x, y, z).matrix(), np.array(scene.nodes[path].position))
            placement = placement * local
    return placement


def assert_drawn(loaded: LoadedRobot, client: FakeClient, q: np.ndarray, tolerance: float) -> None:
    model, data = loaded.model.model, loaded.model.model.createData()
    pin.forwardKinematics(model, data, q)
    for name, node in client.scene.nodes.items():
        if node.method == "add_mesh_simple":
            joint = int(name.split("/")[-2])
            drawn = in_world(client.scene, name)
            np.testing.assert_allclose(drawn.homogeneous, data.oMi[joint].homogeneous, atol=tolerance)


def test_start(loaded, client):
    q = standing_posture(loaded.model)
    RobotScene(client, loaded, q)
    assert_drawn(loaded, client, q, 1e-9)


def test_any_posture(loaded, client, rng):
    scene = RobotScene(client, loaded, standing_posture(loaded.model))
    for _ in range(5):
        q = random_state(loaded.model, rng).q
        scene.draw(q)
        assert_drawn(loaded, client, q, 1e-9)


def test_slow_motion_does_not_drift(loaded, client):
    # Steps too small to be sent add up to something that is.
    q = standing_posture(loaded.model)
    scene = RobotScene(client, loaded, q)
    for _ in range(100):
        q = q.copy()
        q[7:] += 1e-4
        q[0] += 1e-4
        scene.draw(q)
        assert_drawn(loaded, client, q, 5e-3)


def test_only_what_moves_is_sent(loaded, client):
    q = standing_posture(loaded.model)
    scene = RobotScene(client, loaded, q)
    for node in client.scene.nodes.values():
        node.wxyz = node.position = None
    moved = q.copy()
    moved[7 + 3] += 0.1
    scene.draw(moved)
    sent = [node.name.split("/")[-1] for node in client.scene.nodes.values() if node.wxyz is not None]
    assert sent == [str(3 + 2)]


def test_a_posture_that_is_not_a_number_is_not_drawn(loaded, client):
    q = standing_posture(loaded.model)
    scene = RobotScene(client, loaded, q)
    broken = q.copy()
    broken[9] = np.nan
    scene.draw(broken)
    assert_drawn(loaded, client, q, 1e-9)


def test_see_through(loaded, client):
    scene = RobotScene(client, loaded, standing_posture(loaded.model))
    meshes = [node for node in client.scene.nodes.values() if node.method == "add_mesh_simple"]
    scene.see_through(True)
    assert all(0.0 < mesh.opacity < 1.0 for mesh in meshes)
    scene.see_through(False)
    assert all(mesh.opacity is None for mesh in meshes)


def test_a_second_tree_has_a_root_a_color_and_an_end_of_its_own(loaded, client):
    first = RobotScene(client, loaded, standing_posture(loaded.model))
    ghost = RobotScene(client, loaded, standing_posture(loaded.model), "/ghost", (1, 2, 3))
    ghost.fade(0.4)
    meshes = [node for node in client.scene.nodes.values() if node.method == "add_mesh_simple"]
    assert {node.color for node in meshes if node.name.startswith("/ghost")} == {(1, 2, 3)}
    assert {node.color for node in meshes if node.name.startswith("/robot")} == {(0.5, 0.5, 0.5)}
    ghost.remove()
    first.draw(standing_posture(loaded.model))
    assert client.scene.nodes["/ghost/1"].removed
    assert not client.scene.nodes["/robot/1"].removed
