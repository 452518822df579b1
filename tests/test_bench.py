from __future__ import annotations

import json
import math
import sys

import numpy as np
import pytest

from momentum_lab.bench.measure import ROBOTS, RobotBench, measure
from momentum_lab.bench.peer import PeerLoop, PlacoPeer
from momentum_lab.bench.profile import calls_per_tick, profile, stages_of
from momentum_lab.bench.stages import STAGES, StagedTick
from momentum_lab.cli import main
from momentum_lab.physics.push import Push
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.posture import standing_posture
from momentum_lab.robot.state import State
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session
from tests.conftest import assert_close

TICKS = 60
# Calls of functions in a tick of the standing robot, Python and C; the tick's time grows with them.
MOST_CALLS_PER_TICK = 160
# Whole tick over the tick of PlaCo + MuJoCo, medians of one run: 0.74 (TALOS) and 0.83 (G1) on a quiet machine.
MOST_TICK_TO_PEER = 1.3
PEER_SECONDS = 5.0


@pytest.fixture(scope="module")
def measured() -> RobotBench:
    fractions: list[float] = []
    result = measure("g1", 0.2, fractions.append)
    assert fractions == sorted(fractions)
    assert fractions[-1] >= 1.0
    return result


def test_staged_tick_does_what_a_session_does(talos: RobotModel) -> None:
    """Otherwise the parts would be the parts of something else."""
    push = Push(force=200.0, start=0.02)
    session = Session(Scenario("same", seconds=1e-3 * TICKS, pushes=(push,)), talos)
    staged = StagedTick(talos, Scenario("same"))
    staged.pushes = (push,)
    for _ in range(TICKS):
        session.tick()
        staged.tick()
    assert np.array_equal(staged.state.q, session.state.q)
    assert np.array_equal(staged.state.v, session.state.v)


def test_placo_stands_on_both_feet(robot: RobotModel) -> None:
    """Its contact forces carry the weight, its torques balance gravity: H 0 + tau_g = S tau + J^T f."""
    home = State(standing_posture(robot), np.zeros(robot.nv))
    peer = PlacoPeer(robot, home, 1e-3)
    torque = peer.solve()[6:]
    wrenches = np.array([contact.wrench for contact in peer.contacts])
    assert wrenches[:, 2].sum() == pytest.approx(robot.mass * 9.81, rel=1e-3)
    dynamics = robot.at(home)
    balance = dynamics.nonlinear_effects[6:] - torque
    for sole, jacobian, rotation, wrench in zip(
        robot.soles, dynamics.sole_jacobian, dynamics.sole_rotation, wrenches, strict=True
    ):
        force, middle = wrench[:3], np.append((sole.lower + sole.upper) / 2.0, 0.0)
        moment = wrench[3:] + np.cross(middle, force)
        balance -= jacobian[:, 6:].T @ np.concatenate([rotation @ force, rotation @ moment])
    assert_close(balance, 0.0, 1e-2 * np.abs(torque).max())


def test_placo_follows_a_state(talos: RobotModel) -> None:
    home = State(standing_posture(talos), np.zeros(talos.nv))
    peer = PlacoPeer(talos, home, 1e-3)
    moved = State(home.q + np.eye(talos.nq)[2] * 0.01, home.v + 0.01)
    peer.follow(moved)
    assert_close(peer.body.com_world(), talos.at(moved).com_in_world, 1e-9)


def test_placo_weighs_like_the_robot(robot: RobotModel) -> None:
    """Rotor inertias included: both controllers plan for one and the same robot."""
    home = State(standing_posture(robot), np.zeros(robot.nv))
    peer = PlacoPeer(robot, home, 1e-3)
    assert_close(peer.body.mass_matrix(), robot.at(home).mass_matrix, 1e-9)


def test_peer_stands_and_survives_the_push(robot: RobotModel) -> None:
    """A peer that falls would be no comparison. It brakes while it is pushed, so it never has all of 0.15 m/s."""
    home = State(standing_posture(robot), np.zeros(robot.nv))
    peer = PeerLoop(PlacoPeer(robot, home, 1e-3), home, 1e-3)
    push = Push(velocity_change=0.15).sized_for(robot.mass)
    start, fastest = robot.at(home).com_in_world, 0.0
    for tick in range(int(PEER_SECONDS / 1e-3)):
        if tick in (500, 600):
            peer.push(push.mean_force(0.5, 1e-3) * push.direction * (tick == 500))
        peer.tick()
        if 500 <= tick < 1000:
            fastest = max(fastest, com_speed(robot, peer))
    peer.read_state()
    com = robot.at(State(peer.placo.q.copy(), peer.placo.v.copy())).com_in_world
    assert fastest > 0.05
    assert np.linalg.norm(com - start) < 0.02
    assert com_speed(robot, peer) < 0.01
    assert peer.data.ncon == 8


def com_speed(robot: RobotModel, peer: PeerLoop) -> float:
    peer.read_state()
    dynamics = robot.at(State(peer.placo.q.copy(), peer.placo.v.copy()))
    return float(np.linalg.norm(dynamics.com_velocity))


@pytest.mark.quiet
def test_every_part_is_measured(measured: RobotBench) -> None:
    assert measured.robot == "g1"
    assert measured.ticks >= 50
    for name in (*STAGES, "tick", "placo_solve", "peer_tick", "peer_placo", "peer_mujoco"):
        times = getattr(measured, name)
        assert 1.0 < times.p50 <= times.p99, name


@pytest.mark.quiet
@pytest.mark.parametrize("name", ROBOTS)
def test_tick_keeps_pace_with_the_peer(name: str) -> None:
    measured = measure(name, 1.0, lambda _: None)
    assert measured.tick_to_peer == pytest.approx(measured.tick.p50 / measured.peer_tick.p50)
    assert measured.tick_to_peer < MOST_TICK_TO_PEER


def test_peer_is_missing_without_mujoco(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mujoco", None)
    result = measure("g1", 0.01, lambda _: None)
    assert result.peer_tick is result.tick_to_peer is None
    assert result.missing is not None
    assert "pip install 'momentum-lab[mujoco]'" in result.missing
    assert result.placo_solve.p50 > 1.0


def test_tick_makes_few_calls(robot: RobotModel) -> None:
    counts = [calls_per_tick(Session(Scenario("calls", robot=robot.spec.name), robot)) for _ in range(2)]
    assert counts[0] == counts[1]
    assert counts[0] < MOST_CALLS_PER_TICK


def test_profile_is_a_tree_that_adds_up(g1: RobotModel) -> None:
    """The tick is its root; what a function calls takes no longer than itself."""
    rows = profile(Session(Scenario("profile", robot="g1"), g1))
    assert rows[0].name in ("session.Session.tick", "session.tick")
    assert [row.depth for row in rows].count(0) == 1
    assert rows[0].calls == 1.0
    path = [rows[0]]
    for row in rows[1:]:
        del path[row.depth :]
        assert 1.0 <= row.total <= path[-1].total
        assert row.own <= row.total
        path.append(row)
    own = sum(row.own for row in rows)
    assert 0.8 * rows[0].total < own <= rows[0].total * (1.0 + 1e-9)
    assert any("RobotModel.at" in row.name or row.name == "robot.model.at" for row in rows)
    stages = stages_of(rows)
    assert list(stages) == ["state terms", "controller", "physics", "recording", "session"]
    assert min(stages.values()) > 0.02 * rows[0].total
    assert sum(stages.values()) == pytest.approx(rows[0].total)


def test_command_prints_the_profile(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "--profile", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert list(document["profile"]) == list(ROBOTS)
    assert main(["bench", "--profile"]) == 0
    output = capsys.readouterr().out
    assert "A tick of talos, stage by stage" in output
    assert "A tick of talos, call by call" in output
    assert "robot.model" in output


@pytest.mark.quiet
def test_parts_add_up_to_the_whole(measured: RobotBench) -> None:
    parts = sum(getattr(measured, stage).p50 for stage in STAGES)
    assert 0.5 < parts / measured.tick.p50 < 1.5


@pytest.mark.quiet
def test_real_time_factor_is_simulated_over_wall_time(measured: RobotBench) -> None:
    """The mean tick lies above the median, and one slow tick in a hundred does not make it ten times that."""
    fastest = 1e3 / measured.tick.p50
    assert 0.1 * fastest < measured.real_time_factor < 1.2 * fastest


def test_command_prints_both_robots(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert main(["bench", "--seconds", "1", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert [result["robot"] for result in document["robots"]] == list(ROBOTS) == ["talos", "g1"]
    for result in document["robots"]:
        assert set(result["tick"]) == {"p50", "p99"}
        assert math.isfinite(result["real_time_factor"])
        assert result["placo_solve"]["p50"] > 0.0
    assert document["versions"]["placo"]


def test_table_names_every_part(
    measured: RobotBench, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("momentum_lab.cli.bench.measure", lambda *_: measured)
    assert main(["bench"]) == 0
    output = capsys.readouterr()
    assert output.err == ""
    for label in (
        "state terms",
        "controller",
        "physics",
        "recording",
        "whole tick",
        "real-time",
        "PlaCo solve()",
        "PlaCo + MuJoCo tick",
        "tick / PlaCo + MuJoCo tick",
        "calls per tick",
    ):
        assert label in output.out
