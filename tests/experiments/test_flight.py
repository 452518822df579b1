from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.experiments import flight, flight_push
from momentum_lab.scenario import changed
from momentum_lab.session import Session
from tests.experiments.played import any_starts, claims, failing, failing_with, played


@pytest.mark.parametrize("name", ["talos", "g1"])
def test_claims_hold(name: str) -> None:
    assert failing(claims("flight", name)) == []


def test_what_is_foretold_knows_nothing_of_the_run() -> None:
    """Whatever the joints did after the start, the loop that was asked gives the same turn."""
    session = played("flight", "talos").runs[flight.LEFT]
    before = flight.foretold(session)
    other = Session(session.scenario, session.robot)
    for _ in range(other.scenario_ticks):
        other.tick()
    other.recording.column("q")[1:] = other.recording.column("q")[0]
    assert (flight.foretold(other) == before).all()


def test_a_loop_without_an_inside_turns_nothing() -> None:
    """Legs that scissor and never spread go out and back on one line."""
    runs = dict(played("flight", "g1").runs)
    robot = runs[flight.LEFT].robot
    flat = runs[flight.LEFT].recording.column("q")[:, 7:].copy()
    for name in robot.spec.motions["spread"]:
        flat[:, robot.joint_names.index(name)] = flat[0, robot.joint_names.index(name)]
    start = runs[flight.LEFT].recording.column("q")[0]
    path = flight.floating_path(robot, start, flat)
    assert np.abs(flight.turn_between(start, path[-1])).max() < 5e-3


def test_two_loops_the_same_way_are_noticed() -> None:
    runs = dict(played("flight", "g1").runs)
    runs[flight.RIGHT] = runs[flight.LEFT]
    assert any_starts(failing(flight.claims(runs)), "the loop the other way turns it back")


def test_a_robot_that_lands_does_not_keep_it() -> None:
    """From 5 cm the soles touch after 0.1 s."""
    low = {label: changed(run, drop_height=0.05) for label, run in flight.scenarios("talos").items()}
    failed = failing_with(flight.FIGURE, low)
    assert any_starts(failed, "nothing touches the ground")
    assert any_starts(failed, "the whole robot has none")
    assert any_starts(failed, "as kinematics alone foretells")
    assert any_starts(failed, "pushed: after it the angular momentum is kept")
    assert any_starts(failed, "pushed: the linear momentum falls with the weight")


def test_a_push_that_is_half_accounted_for_is_noticed() -> None:
    pushed, finer = (Session(run) for run in flight_push.scenarios("talos").values())
    for session in (pushed, finer):
        for _ in range(150):
            session.tick()
        session.recording.column("push_wrench")[:] *= 0.5
    assert any_starts(
        failing(flight_push.claims(pushed, finer)), "pushed: the push gives what its moment says"
    )


def test_the_drop_lifts_the_whole_robot_and_nothing_else() -> None:
    scenario = flight.scenarios("talos")[flight.LEFT]
    high, low = (Session(changed(scenario, drop_height=height)).state.q for height in (1.2, 0.0))
    assert high[2] - low[2] == pytest.approx(1.2, abs=1e-12)
    assert (high[[0, 1, *range(3, len(high))]] == low[[0, 1, *range(3, len(low))]]).all()
