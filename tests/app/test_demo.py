"""The lab that plays by itself: it waits, plays scene after scene, and stops as soon as somebody is there."""

from __future__ import annotations

import pytest

from momentum_lab.app.demo import Demo, Scene, programme
from momentum_lab.robot.model import RobotModel
from momentum_lab.scenario import sides
from momentum_lab.session import Session

PATIENCE = 30.0


class Lab:
    """A lab with a clock that is set by hand."""

    def __init__(self, patience: float | None = PATIENCE) -> None:
        self.now = 1000.0
        self.done: list[str] = []
        self.demo = Demo(
            self._play, lambda: self.done.append("left"), lambda: "g1", patience, lambda: self.now
        )

    def _play(self, scene: Scene) -> None:
        self.done.append(scene.caption)

    def wait(self, seconds: float) -> None:
        self.now += seconds
        self.demo.tick()


@pytest.fixture
def lab() -> Lab:
    return Lab()


def test_it_never_plays_unless_it_is_asked_to():
    lab = Lab(patience=None)
    lab.wait(1e6)
    assert lab.done == []


def test_a_touch_resets_the_wait(lab):
    lab.wait(PATIENCE - 0.1)
    lab.demo.touch()
    lab.wait(PATIENCE - 0.1)
    assert lab.done == []
    lab.wait(0.2)
    assert lab.done == [programme("g1")[0].caption]


def test_scenes_follow_each_other_and_begin_again(lab):
    scenes = programme("g1")
    lab.wait(PATIENCE)
    for scene in scenes:
        assert lab.demo.scene == scene
        lab.wait(scene.seconds - 0.1)
        assert lab.demo.scene == scene
        lab.wait(0.1)
    assert lab.done == [*(scene.caption for scene in scenes), scenes[0].caption]


def test_the_first_touch_stops_it_at_once_and_only_once(lab):
    lab.wait(PATIENCE)
    lab.demo.touch()
    lab.demo.touch()
    assert lab.demo.scene is None
    assert lab.done[1:] == ["left"]
    lab.wait(PATIENCE - 0.1)
    assert lab.done[1:] == ["left"]
    lab.wait(0.1)
    assert len(lab.done) == 3


@pytest.mark.parametrize("name", ["talos", "g1"])
def test_every_scene_can_be_played_and_nobody_falls_who_should_not(name, request):
    robot: RobotModel = request.getfixturevalue(name)
    for scene in programme(name):
        session = Session(sides(scene.scenario)[0], robot)
        while session.time < min(scene.seconds, 2.5):
            session.tick()
        assert session.fall is None, scene.caption


def test_a_robot_that_knows_no_kick_plays_the_rest():
    all_scenes, fewer = programme("g1"), programme("human")
    assert [s.caption for s in fewer] == [s.caption for s in all_scenes if not s.scenario.motion]
    assert len(fewer) < len(all_scenes)
