"""Codes: there and back, and what happens to damaged ones."""

from __future__ import annotations

import re

import pytest

from momentum_lab.errors import ScenarioError
from momentum_lab.scenario import changed, load_scenario, scenario_names
from momentum_lab.share_code import from_code, to_code


@pytest.mark.parametrize("name", scenario_names())
def test_there_and_back(name):
    scenario = changed(load_scenario(name), gains={"linear_damping": 7.123456789012345}, priority=1 / 3)
    code = to_code(scenario)
    assert from_code(code) == scenario
    assert re.fullmatch(r"[A-Za-z0-9_-]{1,600}", code)


@pytest.mark.parametrize(
    "spoil", [lambda c: c[:-3], lambda c: "A" + c[1:], lambda c: c + "%", lambda c: "", lambda c: "é"]
)
def test_a_damaged_code_is_refused_in_one_line(spoil):
    with pytest.raises(
        ScenarioError, match=r"^code: got .*; allowed: a code that this lab has made"
    ) as caught:
        from_code(spoil(to_code(load_scenario("stand"))))
    assert "\n" not in str(caught.value)


def test_a_code_with_a_value_out_of_range_is_refused():
    bad = to_code(load_scenario("stand").__class__("x", priority=3.0))
    with pytest.raises(ScenarioError, match="priority"):
        from_code(bad)
