from __future__ import annotations

import math

import numpy as np
import pytest

from momentum_lab.experiments.claims import at_least, at_most, largest


@pytest.mark.parametrize(
    ("measured", "low", "high"), [(1.9, False, True), (2.0, True, True), (2.1, True, False)]
)
def test_bounds_belong_to_what_they_allow(measured: float, low: bool, high: bool) -> None:
    assert at_least("x", measured, 2.0, "m").holds is low
    assert at_most("x", measured, 2.0, "m").holds is high


def test_a_claim_about_nothing_fails() -> None:
    nothing = largest(np.array([]))
    assert math.isnan(nothing)
    assert not at_most("x", nothing, 1.0, "m").holds
    assert not at_least("x", nothing, 1.0, "m").holds


def test_a_claim_says_what_is_allowed() -> None:
    assert at_most("x", 1.0, 2.0, "mm").allowed == "at most 2 mm"
    assert at_least("x", 1.0, 2.0, "mm").allowed == "at least 2 mm"
