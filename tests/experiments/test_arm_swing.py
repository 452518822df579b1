from __future__ import annotations

import pytest

from momentum_lab.experiments import arm_swing
from momentum_lab.scenario import changed
from tests.experiments.played import any_starts, claims, failing, failing_with


@pytest.mark.parametrize("name", ["talos", "g1"])
def test_claims_hold(name: str) -> None:
    assert failing(claims("arm-swing", name)) == []


def test_the_same_goal_twice_shows_no_difference() -> None:
    same = {
        label: changed(run, angular_goal="zero", seconds=2.0)
        for label, run in arm_swing.scenarios("g1").items()
    }
    failed = failing_with(arm_swing.FIGURE, same)
    assert any_starts(failed, "zero: angular momentum")
    assert any_starts(failed, "reference: the pelvis turns")
