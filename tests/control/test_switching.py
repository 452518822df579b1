"""Another controller in mid-run: no joint feels more than a tenth of its torque at once."""

from __future__ import annotations

import itertools
from functools import lru_cache

import numpy as np
import pytest

from momentum_lab.control.handover import Handover
from momentum_lab.control.registry import CONTROLLERS
from momentum_lab.events import SelectController, SetDirections
from momentum_lab.momentum.directions import ALL
from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session, Snapshot
from tests.runs import CHAPTER_PUSH

PAIRS = list(itertools.permutations(CONTROLLERS, 2))
LARGEST_JUMP = 0.1
# The push is over, the robot on its way back: torques are far from those of rest.
SWITCH = 450
ENOUGH = 1200


@lru_cache(maxsize=len(CONTROLLERS))
def recovering(robot, controller: str) -> tuple[Session, Snapshot]:
    """Half the chapter's push to the left and behind, and where the robot is while it recovers; played once."""
    push = Push(force=0.5 * CHAPTER_PUSH[robot.spec.name], direction_deg=40.0, start=0.1)
    scenario = Scenario("switch", robot=robot.spec.name, controller=controller, seconds=1.4, pushes=(push,))
    session = Session(scenario, robot=robot)
    for _ in range(SWITCH):
        session.tick()
    return session, session.snapshot()


def switched(robot, first: str, second: str) -> Session:
    """Another controller while the robot recovers."""
    session, snapshot = recovering(robot, first)
    session.resume(snapshot)
    session.post(SelectController(second))
    for _ in range(ENOUGH - SWITCH):
        session.tick()
    assert len(session.recording) == ENOUGH
    return session


def jumps(session: Session) -> np.ndarray:
    """Change of every joint's torque from tick to tick, against its limit (N - 1, na)."""
    return np.abs(np.diff(session.recording.column("torque"), axis=0)) / session.robot.effort_limit


@pytest.mark.parametrize(("first", "second"), PAIRS)
def test_torques_do_not_jump_and_the_robot_stands(robot, first, second):
    session = switched(robot, first, second)
    assert session.choices.controller == second
    assert jumps(session)[SWITCH - 5 :].max() < LARGEST_JUMP
    assert session.fall is None
    assert np.linalg.norm(session.recording.latest["com_velocity"]) < 0.05


def test_without_a_handover_there_would_be_a_jump(robot, monkeypatch):
    """The test above can fail: at that moment the controllers want torques that are far apart."""
    monkeypatch.setattr(Handover, "applied", lambda _self, torque: torque)
    session = switched(robot, "computed-torque", "resolved-momentum")
    assert jumps(session)[SWITCH - 5 : SWITCH + 5].max() > 3.0 * LARGEST_JUMP


def test_a_fresh_start_has_nothing_to_hand_over(robot):
    """A controller chosen before the first tick answers alone, as one chosen by the scenario."""
    scenario = Scenario("fresh", robot=robot.spec.name, seconds=0.02)
    session = Session(scenario, robot=robot)
    session.post(SelectController("placo-wbc"))
    alone = Session(
        Scenario("fresh", robot=robot.spec.name, seconds=0.02, controller="placo-wbc"), robot=robot
    )
    for _ in range(20):
        assert session.tick()["torque"].tobytes() == alone.tick()["torque"].tobytes()


@pytest.mark.parametrize("controller", CONTROLLERS)
@pytest.mark.parametrize("text", ["linear+kz", "linear"])
def test_directions_of_momentum_change_without_a_jump(robot, controller, text):
    """Section 5.3.1 in mid-run: asking for fewer directions, and for all again."""
    session, snapshot = recovering(robot, controller)
    session.resume(snapshot)
    for tick in range(SWITCH, 1400):
        if tick in (SWITCH, SWITCH + 400):
            session.post(SetDirections(text if tick == SWITCH else "all"))
        session.tick()
    assert session.choices.controlled == ALL
    assert jumps(session)[SWITCH - 5 :].max() < LARGEST_JUMP
    assert session.fall is None
    assert np.linalg.norm(session.recording.latest["com_velocity"]) < 0.05
