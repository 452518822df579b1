from __future__ import annotations

import json
import math

import numpy as np
import pytest

from momentum_lab.bench.measure import ROBOTS, RobotBench, measure
from momentum_lab.bench.placo_peer import PlacoPeer
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
    torque = peer.solve()
    wrenches = np.array([contact.wrench for contact in peer.contacts])
    assert wrenches[:, 2].sum() == pytest.approx(robot.mass * 9.81, rel=1e-3)
    dynamics = robot.at(home)
    balance = dynamics.nonlinear_effects[6:] - torque
    for jacobian, rotation, wrench in zip(
        dynamics.sole_jacobian, dynamics.sole_rotation, wrenches, strict=True
    ):
        balance -= jacobian[:, 6:].T @ np.concatenate([rotation @ wrench[:3], rotation @ wrench[3:]])
    assert_close(balance, 0.0, 1e-2 * np.abs(torque).max())


def test_placo_follows_a_state(talos: RobotModel) -> None:
    home = State(standing_posture(talos), np.zeros(talos.nv))
    peer = PlacoPeer(talos, home, 1e-3)
    moved = State(home.q + np.eye(talos.nq)[2] * 0.01, home.v + 0.01)
    peer.follow(moved)
    assert_close(peer.body.com_world(), talos.at(moved).com_in_world, 1e-9)


def test_every_part_is_measured(measured: RobotBench) -> None:
    assert measured.robot == "g1"
    assert measured.ticks >= 50
    for name in (*STAGES, "tick", "placo_solve"):
        times = getattr(measured, name)
        assert 1.0 < times.p50 <= times.p99, name


def test_parts_add_up_to_the_whole(measured: RobotBench) -> None:
    parts = sum(getattr(measured, stage).p50 for stage in STAGES)
    assert 0.5 < parts / measured.tick.p50 < 1.5


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
    ):
        assert label in output.out
