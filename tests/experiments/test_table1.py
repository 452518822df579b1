from __future__ import annotations

import pytest

from momentum_lab.control.registry import CONTROLLERS
from momentum_lab.experiments import table1
from momentum_lab.physics.push import Push
from momentum_lab.scenario import changed
from tests.experiments.played import any_starts, claims, failing, failing_with, played

PLANNED = ["CoP to CoM, planned", "CoP and force, planned"]


@pytest.mark.parametrize("name", ["talos", "g1"])
def test_claims_hold(name: str) -> None:
    assert failing(claims("table1", name)) == []


def test_every_method_has_its_row() -> None:
    rows = table1.table(played("table1", "talos").runs)
    assert rows["method"] == [*(entry.title for entry in CONTROLLERS.values()), *PLANNED]
    assert {len(values) for values in rows.values()} == {len(CONTROLLERS) + len(PLANNED)}


def test_a_push_that_fells_every_method_fails() -> None:
    push = Push(velocity_change=1.2, start=0.05)
    hard = {
        name: changed(scenario, pushes=(push,), seconds=1.2)
        for name, scenario in table1.scenarios("talos").items()
    }
    failed = failing_with(table1.FIGURE, hard)
    for name in CONTROLLERS:
        assert any_starts(failed, f"{name} does not fall")
