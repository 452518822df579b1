"""Gains declare default, unit, range and help, and refuse everything else in words."""

from __future__ import annotations

import dataclasses
import math

import pytest

from momentum_lab.control.gains import GainInfo, declared_gains, gain, with_gains
from momentum_lab.control.registry import CONTROLLERS
from momentum_lab.errors import GainError

EVERY_GAIN = [
    pytest.param(entry.gains, info, id=f"{name}-{info.name}")
    for name, entry in CONTROLLERS.items()
    for info in declared_gains(entry.gains).values()
]


@dataclasses.dataclass(frozen=True, slots=True)
class Pair:
    stiffness: float = gain(3.0, "1/s^2", 1.0, 5.0, "How stiff.")
    damping: float = gain(0.5, "1/s", 0.0, 1.0, "How damped.")


def test_declarations_are_read_back_by_name_and_in_order():
    gains = declared_gains(Pair)
    assert list(gains) == ["stiffness", "damping"]
    assert gains["stiffness"] == GainInfo("stiffness", 3.0, "1/s^2", 1.0, 5.0, "How stiff.")
    assert declared_gains(Pair(stiffness=4.0)) == gains


def test_some_gains_are_changed_and_the_rest_stay():
    before = Pair()
    after = with_gains(before, {"stiffness": 4})
    assert (after.stiffness, after.damping, before.stiffness) == (4.0, 0.5, 3.0)
    assert isinstance(after.stiffness, float)
    assert with_gains(after, {}) == after


def test_an_unknown_gain_is_refused_with_the_known_ones():
    with pytest.raises(GainError, match="gain: got stiffnes; allowed: one of stiffness, damping"):
        with_gains(Pair(), {"stiffnes": 2.0})


@pytest.mark.parametrize("value", [0.999, 5.001, math.nan, math.inf, -math.inf, "3", None])
def test_a_value_out_of_range_is_refused_with_the_range(value):
    with pytest.raises(GainError, match=r"stiffness: got .*; allowed: a number from 1 to 5 1/s\^2"):
        with_gains(Pair(), {"stiffness": value})


@pytest.mark.parametrize("value", [1.0, 5.0])
def test_the_ends_of_the_range_are_allowed(value):
    assert with_gains(Pair(), {"stiffness": value}).stiffness == value


@pytest.mark.parametrize(("gains", "info"), EVERY_GAIN)
def test_every_gain_of_every_controller_explains_itself(gains, info):
    assert info.low < info.high
    assert info.check(info.default) == info.default == getattr(gains, info.name)
    assert info.unit
    assert info.help.endswith(".")
    assert len(info.help.split()) > 3


@pytest.mark.parametrize("name", CONTROLLERS)
def test_every_field_of_a_controllers_gains_is_declared(name):
    gains = CONTROLLERS[name].gains
    assert list(declared_gains(gains)) == [field.name for field in dataclasses.fields(gains)]
