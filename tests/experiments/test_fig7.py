from __future__ import annotations

import pytest

from momentum_lab.experiments import fig7
from tests.experiments.played import any_starts, claims, failing, failing_with


@pytest.mark.parametrize("name", ["talos", "g1"])
def test_claims_hold(name: str) -> None:
    assert failing(claims("fig7", name)) == []


def test_two_robots_with_the_same_priority_do_not_differ() -> None:
    linear = fig7.scenarios("talos")[fig7.LINEAR]
    failed = failing_with(fig7.FIGURE, {fig7.LINEAR: linear, fig7.ANGULAR: linear})
    assert any_starts(failed, "priority 1: rate of angular momentum kept")
    assert any_starts(failed, "priority 1: rate of linear momentum gives way")
    assert any_starts(failed, "priority 1 falls")
    assert not any_starts(failed, "priority 0")
