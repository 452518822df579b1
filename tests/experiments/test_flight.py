from __future__ import annotations

import pytest

from momentum_lab.experiments import flight
from momentum_lab.scenario import changed
from momentum_lab.session import Session
from tests.experiments.played import any_starts, claims, failing, failing_with


@pytest.mark.parametrize("name", ["talos", "g1"])
def test_claims_hold(name: str) -> None:
    assert failing(claims("flight", name)) == []


def test_a_robot_that_lands_does_not_keep_it() -> None:
    """From 5 cm the soles touch after 0.1 s."""
    low = {label: changed(run, drop_height=0.05) for label, run in flight.scenarios("talos").items()}
    failed = failing_with(flight.FIGURE, low)
    assert any_starts(failed, "nothing touches the ground")
    assert any_starts(failed, "after it the angular momentum is kept")
    assert any_starts(failed, "the linear momentum falls with the weight")


def test_a_push_that_is_half_accounted_for_is_noticed() -> None:
    runs = {label: Session(run) for label, run in flight.scenarios("talos").items()}
    for session in runs.values():
        for _ in range(150):
            session.tick()
        session.recording.column("push_wrench")[:] *= 0.5
    assert any_starts(failing(flight.claims(runs)), "the push gives what its moment says")


def test_the_drop_lifts_the_whole_robot_and_nothing_else() -> None:
    scenario = flight.scenarios("talos")[flight.DROP]
    high, low = (Session(changed(scenario, drop_height=height)).state.q for height in (1.2, 0.0))
    assert high[2] - low[2] == pytest.approx(1.2, abs=1e-12)
    assert (high[[0, 1, *range(3, len(high))]] == low[[0, 1, *range(3, len(low))]]).all()
