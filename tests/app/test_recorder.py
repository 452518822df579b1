"""Recordings that play by themselves: decoded again, they hold every picture of the run and nothing to load."""

from __future__ import annotations

import base64
import re
from dataclasses import replace

import msgspec
import numpy as np
import pinocchio as pin
import pytest
import zstandard

from momentum_lab.app.recorder import html_file, viser_file
from momentum_lab.app.reel import Reel
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.errors import InputError
from momentum_lab.events import ApplyPush, Reset, SetFriction
from momentum_lab.finished import FinishedRun
from momentum_lab.physics.push import Push
from momentum_lab.recording import Recording
from momentum_lab.robot.model import RobotModel
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session

TICKS, EVERY = 500, 40
PICTURES = 13  # samples 0, 40, ..., 480


@pytest.fixture(scope="module")
def run(g1: RobotModel) -> FinishedRun:
    """Half a second with a push, and ice under one foot from 0.2 s on."""
    push = Push(force=60.0, duration=0.1, start=0.1)
    session = Session(Scenario("pushed & <seen>", robot="g1", seconds=0.5, pushes=(push,)), robot=g1)
    for tick in range(TICKS):
        if tick == 200:
            session.post(SetFriction(0.2, g1.foot_names[0]))
        session.tick()
    return FinishedRun.of(session)


@pytest.fixture(scope="module")
def recorded(run: FinishedRun) -> bytes:
    return viser_file(run)


def decoded(content: bytes) -> dict:
    """What viser's player reads."""
    size = int.from_bytes(content[:8], "little")
    inner = zstandard.ZstdDecompressor().decompress(content[8:], max_output_size=size)
    length = int.from_bytes(inner[:8], "little")
    return msgspec.msgpack.decode(inner[8 : 8 + length])


def scene_at(file: dict, time: float) -> dict[str, dict]:
    """Name -> position and orientation of every node when the player has come so far."""
    nodes: dict[str, dict] = {}
    for when, message in file["messages"]:
        if when > time + 1e-9:
            break
        node = nodes.setdefault(message.get("name", ""), {})
        if message["type"] == "SetPositionMessage":
            node["position"] = message["position"]
        if message["type"] == "SetOrientationMessage":
            node["wxyz"] = message["wxyz"]
    return nodes


def joints_in_world(nodes: dict[str, dict], root: str = "/robot") -> dict[int, pin.SE3]:
    """Joint -> placement below a node, out of the chain of nodes above it."""
    placed = {}
    for name in nodes:
        if not re.fullmatch(rf"{root}(/\d+)+", name):
            continue
        here, path = pin.SE3.Identity(), root
        for joint in name.removeprefix(root).split("/")[1:]:
            path += f"/{joint}"
            w, x, y, z = nodes[path].get("wxyz", (1.0, 0.0, 0.0, 0.0))
            at = np.array(nodes[path].get("position", (0.0, 0.0, 0.0)))
            here = here * pin.SE3(pin.Quaternion(w, x, y, z).toRotationMatrix(), at)
        placed[int(joint)] = here
    return placed


def test_it_has_all_pictures_and_lasts_as_long_as_the_run(recorded):
    file = decoded(recorded)
    times = sorted({round(when, 6) for when, _ in file["messages"]})
    assert times == [i / 25 for i in range(PICTURES)]
    assert sorted({when for when, _ in file["messages"]}) == times  # not even an ulp off
    assert file["durationSeconds"] == PICTURES / 25


@pytest.mark.parametrize("picture", [0, 5, 12])
def test_every_link_is_where_it_was(recorded, run, picture):
    model, q = run.robot.model, run.recording.column("q")[picture * EVERY]
    data = model.createData()
    pin.forwardKinematics(model, data, q)
    placed = joints_in_world(scene_at(decoded(recorded), 0.04 * picture))
    assert sorted(placed) == list(range(1, model.njoints))
    for joint, placement in placed.items():
        assert np.abs(placement.homogeneous - data.oMi[joint].homogeneous).max() < 1e-9


def test_the_marks_are_there_and_the_push_when_it_begins(recorded):
    first: dict[str, float] = {}
    for when, message in decoded(recorded)["messages"]:
        first.setdefault(message.get("name", ""), when)
    names = {key.rpartition("/")[2] for key in first if key.startswith("/marks/")}
    assert {"com", "cop", "cmp", "grf", "push"} <= names
    assert first["/marks/com"] == 0.0
    assert first["/marks/push"] == pytest.approx(0.12)  # the first picture after 0.1 s


def test_ground_that_was_changed_is_shown_from_then_on(run, recorded):
    reel = Reel.of(run, LoadedRobot(run.robot, (), run.recording.layout))
    before, after = reel.ground.friction(0.19), reel.ground.friction(0.21)
    assert before[0] == before[1] == after[1]
    assert after[0] == 0.2
    assert not reel.ground.is_floor


def test_what_was_before_the_robot_stood_up_again_is_over(g1):
    session = Session(Scenario("again", robot="g1", seconds=0.2), robot=g1)
    for tick in range(100):
        if tick == 20:
            session.post(SetFriction(0.2, ""))
            session.post(ApplyPush(Push(force=10.0)))
        if tick == 60:
            session.post(Reset())
        if tick == 90:
            session.post(SetFriction(0.4, ""))
        session.tick()
    run = FinishedRun.of(session)
    reel = Reel.of(run, LoadedRobot(run.robot, (), run.recording.layout))
    assert len(reel.rows) == 1  # 40 ticks
    begun = run.time - 0.010
    assert reel.ground.friction(begun - 0.001)[0] == g1.spec.friction
    assert reel.ground.friction(begun + 0.001)[0] == 0.4
    assert reel.picture(reel.samples[0], 1.0).push is None


def test_the_same_run_gives_the_same_bytes(run, recorded):
    assert viser_file(run) == recorded


def test_a_page_holds_the_same_recording_and_says_what_it_shows(run, recorded):
    fractions: list[float] = []
    page = html_file(run, fractions.append).decode()
    embedded = re.findall(r'__VISER_EMBED_DATA__="([^"]+)"', page)
    assert [base64.b64decode(text) for text in embedded] == [recorded]
    title = "pushed &amp; &lt;seen&gt; · g1 · computed-torque · priority 0"
    assert f"<title>{title}</title>" in page
    assert page.count(title) == 2
    assert fractions[-1] == 1.0
    assert len(fractions) == PICTURES


def test_nothing_in_a_page_is_loaded_from_elsewhere(run):
    page = html_file(run).decode()
    shell = re.sub(r'="[^"]{10000,}"', "", page)
    assert not re.search(r'(src|href)="(?!data:)', shell)


def test_a_run_without_samples_is_refused(run):
    empty = replace(run, recording=Recording(run.recording.layout, 1))
    with pytest.raises(InputError, match=r"^recording: got no samples; allowed: a run of at least one tick"):
        viser_file(empty)


@pytest.fixture(scope="module")
def pair(g1: RobotModel) -> FinishedRun:
    """Two robots that are pushed alike and keep different momenta; the second comes 0.1 s later and stops earlier."""
    push = Push(force=60.0, duration=0.1, start=0.1)
    runs = []
    for priority, ticks in ((0.0, 400), (1.0, 300)):
        session = Session(Scenario("two", robot="g1", priority=priority, pushes=(push,)), g1, 400)
        for _ in range(ticks):
            session.tick()
        runs.append(FinishedRun.of(session))
    late = Recording(runs[1].recording.layout, 200)
    for row in runs[1].recording.rows()[100:]:
        late.next_row()[:] = row
    return replace(runs[0], beside=replace(runs[1], recording=late))


def test_two_robots_stand_side_by_side_each_where_it_was(pair):
    file = decoded(viser_file(pair))
    nodes = scene_at(file, 0.24)
    offset = nodes["/beside"]["position"]
    assert np.linalg.norm(offset) == pytest.approx(1.5 * pair.recording.column("com")[0, 2])
    assert offset[1] == pytest.approx(np.linalg.norm(offset))  # to the left of one that faces forward
    for run, root, row in ((pair, "/robot", 240), (pair.beside, "/beside/robot", 140)):
        model, data = run.robot.model, run.robot.model.createData()
        pin.forwardKinematics(model, data, run.recording.column("q")[row])
        placed = joints_in_world(nodes, root)
        assert sorted(placed) == list(range(1, model.njoints))
        for joint, placement in placed.items():
            assert np.abs(placement.homogeneous - data.oMi[joint].homogeneous).max() < 1e-9
    marks = {name for name in nodes if name.startswith("/beside/marks/")}
    assert {"/beside/marks/com", "/beside/marks/push"} <= marks


def test_the_second_robot_is_there_from_when_it_was_and_both_have_names(pair):
    reel = Reel.of(pair, LoadedRobot(pair.robot, (), pair.recording.layout))
    time = reel.robot.layout.slices["time"]
    assert reel.side.since == 3
    assert reel.side.reel.rows[3:7, time].ravel() == pytest.approx(reel.rows[3:7, time].ravel())
    assert reel.side.reel.rows[8:, time].ravel() == pytest.approx([0.299, 0.299])  # where it stopped
    assert reel.side.names == ("priority 0", "priority 1")
    messages = decoded(viser_file(pair))["messages"]
    shown = [(when, m) for when, m in messages if m.get("name") == "/beside" and "visible" in m]
    assert [(when, m["visible"]) for when, m in shown] == [(0.0, False), (0.12, True)]
    assert (
        "<title>two · g1 · computed-torque · priority 0 beside priority 1</title>" in html_file(pair).decode()
    )
