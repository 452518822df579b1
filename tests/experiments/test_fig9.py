from __future__ import annotations

import pytest

from momentum_lab.control.slack_qp import SlackQP
from momentum_lab.experiments import fig9
from momentum_lab.robot.state import State
from tests.control.situations import LEVEL
from tests.experiments.played import any_starts, claims, failing, failing_with, played


@pytest.mark.parametrize("name", ["talos", "g1"])
def test_claims_hold(name: str) -> None:
    assert failing(claims("fig9", name)) == []


def test_the_reversed_priority_does_not_do_it() -> None:
    scenarios = fig9.scenarios("talos")
    swapped = {fig9.FORWARD: scenarios[fig9.REVERSED], fig9.REVERSED: scenarios[fig9.FORWARD]}
    failed = failing_with(fig9.FIGURE, swapped)
    assert any_starts(failed, "the robot does not fall")
    assert any_starts(failed, "the CoM is back at the end")
    assert any_starts(failed, "with the priority reversed the robot falls")


@pytest.mark.parametrize(("name", "outside"), [("talos", 0.020), ("g1", 0.010)])
def test_the_robots_start_as_far_outside_as_was_asked(name: str, outside: float) -> None:
    assert fig9.scenarios(name)[fig9.FORWARD].com_outside == outside


def test_slack_is_the_controllers_own() -> None:
    """Eq. 61 from the recording against what the controller says of itself on the same state."""
    session = played("fig9", "g1").runs[fig9.FORWARD]
    controller, column = SlackQP(session.robot, 1e-3), session.recording.column
    slack = fig9.com_slack(session)
    for tick in (50, 400, 1200):
        dynamics = session.robot.at(State(column("q")[tick], column("v")[tick]))
        answer = controller.compute(
            dynamics, session.steering._goal.reference(dynamics, LEVEL), session.choices.gains, 0.0, None
        )
        assert slack[tick] == pytest.approx(answer.slack["com y"], abs=1e-6)
