from __future__ import annotations

import pytest

from momentum_lab.experiments import fig4
from momentum_lab.scenario import changed
from tests.experiments.played import any_starts, claims, failing, failing_with


@pytest.mark.parametrize("name", ["talos", "g1"])
def test_claims_hold(name: str) -> None:
    assert failing(claims("fig4", name)) == []


def test_without_a_push_the_points_never_part() -> None:
    quiet = {"push": changed(fig4.scenarios("talos")["push"], pushes=(), seconds=0.3)}
    failed = failing_with(fig4.FIGURE, quiet)
    assert any_starts(failed, "with it they are apart")
    assert any_starts(failed, "the CMP goes beyond it")
