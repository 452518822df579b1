"""Marks become nodes of the scene, and only what has changed is sent."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.app.mark_scene import MarkScene
from momentum_lab.app.marks import ALL_LABELS, FEW_LABELS, PRESETS, STYLES
from momentum_lab.app.overlays import Mark, Picture, overlays
from tests.app.fakes import FakeClient

AT = (0.1, 0.2, 0.3)


@pytest.fixture
def client() -> FakeClient:
    return FakeClient()


@pytest.fixture
def scene(client) -> MarkScene:
    return MarkScene(client, size=0.88)


def test_every_mark_can_be_drawn(scene, client, saturated, talos, pushed):
    marks = overlays(saturated, Picture(talos, pushed.pushes[0], 0.005))
    scene.draw(marks, PRESETS["everything"], labelled=ALL_LABELS)
    assert {f"/marks/{key}" for key in STYLES} == {n for n in client.scene.nodes if n.startswith("/marks")}


def test_only_what_is_switched_on_is_drawn(scene, client, standing, talos):
    scene.draw(overlays(standing, Picture(talos)), PRESETS["minimal"], labelled=())
    assert set(client.scene.nodes) == {f"/marks/{key}" for key in PRESETS["minimal"] - {"push"}}


def test_what_disappears_is_hidden_and_comes_back(scene, client):
    mark = Mark("com", (AT,))
    for marks, visible in (([mark], True), ([], False), ([mark], True)):
        scene.draw(marks, {"com"}, labelled=ALL_LABELS)
        assert client.scene.nodes["/marks/com"].visible == visible
        assert client.scene.nodes["/labels/com"].visible == visible


def test_a_switched_off_mark_is_hidden(scene, client):
    scene.draw([Mark("com", (AT,))], {"com"}, labelled=ALL_LABELS)
    scene.draw([Mark("com", (AT,))], set(), labelled=ALL_LABELS)
    assert not client.scene.nodes["/marks/com"].visible


def test_a_mark_moves(scene, client):
    scene.draw([Mark("cop", (AT,))], {"cop"}, labelled=())
    scene.draw([Mark("cop", ((0.5, 0.6, 0.7),))], {"cop"}, labelled=())
    np.testing.assert_allclose(client.scene.nodes["/marks/cop"].batched_positions, [[0.5, 0.6, 0.7]])


def test_a_mark_that_stays_is_not_sent_again(scene, client):
    scene.draw([Mark("cop", (AT,))], {"cop"}, labelled=ALL_LABELS)
    node, label = client.scene.nodes["/marks/cop"], client.scene.nodes["/labels/cop"]
    node.batched_positions = label.position = None
    scene.draw([Mark("cop", ((0.1001, 0.2, 0.3),))], {"cop"}, labelled=ALL_LABELS)
    assert node.batched_positions is None
    assert label.position is None


def test_a_polygon_may_change_its_number_of_corners(scene, client):
    square = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0))
    scene.draw([Mark("support", square)], {"support"}, labelled=())
    scene.draw([Mark("support", (*square, (-0.5, 0.5, 0.0)))], {"support"}, labelled=())
    node = client.scene.nodes["/marks/support"]
    assert node.vertices.shape == (5, 3)
    assert node.faces.tolist() == [[0, 1, 2], [0, 2, 3], [0, 3, 4]]


def test_per_foot_marks_may_lose_a_foot(scene, client):
    scene.draw([Mark("foot_cop", (AT, AT))], {"foot_cop"}, labelled=())
    scene.draw([Mark("foot_cop", (AT,))], {"foot_cop"}, labelled=())
    node = client.scene.nodes["/marks/foot_cop"]
    assert node.batched_positions.shape == (1, 3)
    assert node.batched_wxyzs.shape == (1, 4)


def test_labels_can_be_switched_off(scene, client):
    scene.draw([Mark("com", (AT,))], {"com"}, labelled=ALL_LABELS)
    scene.draw([Mark("com", (AT,))], {"com"}, labelled=())
    assert not client.scene.nodes["/labels/com"].visible
    assert client.scene.nodes["/marks/com"].visible


def test_a_small_picture_has_few_labels(scene, client, saturated, talos, pushed):
    marks = overlays(saturated, Picture(talos, pushed.pushes[0], 0.005))
    scene.draw(marks, PRESETS["everything"], labelled=FEW_LABELS)
    assert {n for n in client.scene.nodes if n.startswith("/labels")} == {f"/labels/{k}" for k in FEW_LABELS}


def test_everything_can_leave(scene, client):
    scene.draw([Mark("com", (AT,)), Mark("cop", (AT,))], {"com", "cop"}, labelled=ALL_LABELS)
    nodes = list(client.scene.nodes.values())
    scene.remove()
    assert all(node.removed for node in nodes)
