"""Runs that have been looked at and accepted; a change of their numbers has to be accepted again."""

from __future__ import annotations

import numpy as np
import pytest

from tests.golden.cases import CASES, QUANTITIES, golden_path, measured, remembered

UPDATE = "python -m tests.golden.update"


@pytest.mark.parametrize(("scenario", "name"), CASES)
def test_a_run_is_as_it_was(scenario, name, request):
    assert golden_path(scenario, name).is_file(), f"nothing to compare with; look at the run, then {UPDATE}"
    then, now = remembered(scenario, name), measured(scenario, request.getfixturevalue(name))
    assert now["time"] == then["time"]
    for key, quantity in QUANTITIES.items():
        difference = np.abs(np.subtract(now[key], then[key])).max(axis=1)
        worst = int(difference.argmax())
        assert difference[worst] <= quantity.tolerance, (
            f"{key} differs by {difference[worst]:.2g} at {now['time'][worst]:g} s "
            f"(then {then[key][worst]}, now {now[key][worst]}); if this is meant: {UPDATE}"
        )


def test_every_remembered_run_is_one_that_is_compared():
    files = {path.name for path in golden_path("", "").parent.glob("*.json")}
    assert files == {golden_path(*case).name for case in CASES}
