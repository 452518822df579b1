from __future__ import annotations

import pytest

from momentum_lab.experiments import kick
from momentum_lab.scenario import changed
from tests.experiments.played import any_starts, claims, failing, failing_with


@pytest.mark.parametrize("name", ["talos", "g1"])
def test_claims_hold(name: str) -> None:
    assert failing(claims("kick", name)) == []


def test_without_a_difference_in_what_is_held_nothing_bends_more() -> None:
    same = {label: changed(run, controlled="all", seconds=1.4) for label, run in kick.scenarios("g1").items()}
    failed = failing_with(kick.FIGURE, same)
    for controller in kick.CONTROLLERS:
        assert any_starts(failed, f"{controller}: held, the body bends more")
        assert any_starts(failed, f"{controller}: k_y held")


def test_a_leg_that_does_not_kick_is_noticed() -> None:
    short = {label: changed(run, seconds=0.6) for label, run in kick.scenarios("g1").items()}
    assert any_starts(failing_with(kick.FIGURE, short), "computed-torque, all six: the leg kicks")
