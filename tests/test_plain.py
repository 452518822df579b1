"""Numbers for people: rounded as Python does, but for the minus of a zero."""

from __future__ import annotations

import pytest

from momentum_lab.plain import plain


@pytest.mark.parametrize(
    ("value", "spec", "expected"),
    [
        (-0.04, ".1f", "0.0"),
        (-0.06, ".1f", "-0.1"),
        (-0.0, "g", "0"),
        (-0.0, ".4g", "0"),
        (-0.0, ".2e", "0.00e+00"),
        (-1e-9, ".2e", "-1.00e-09"),
        (-10.0, ".0f", "-10"),
        (0.0, ".3f", "0.000"),
        (float("-inf"), ".1f", "-inf"),
        (float("nan"), ".1f", "nan"),
    ],
)
def test_only_a_zero_loses_its_minus(value, spec, expected):
    assert plain(value, spec) == expected
