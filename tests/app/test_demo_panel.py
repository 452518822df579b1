"""The switch of the demonstration: what a browser sends is made a wait that can be asked for."""

from __future__ import annotations

import math

import pytest

from momentum_lab.app.demo import Demo
from momentum_lab.app.demo_panel import DemoPanel
from momentum_lab.patience import LEAST_PATIENCE, MOST_PATIENCE, PATIENCE
from tests.app.fakes import FakeClient


@pytest.mark.parametrize(
    ("value", "patience"),
    [
        (30.0, 30.0),
        (1e9, MOST_PATIENCE),
        (-1.0, LEAST_PATIENCE),
        (math.nan, PATIENCE),
        ("soon", PATIENCE),
        (None, PATIENCE),
    ],
)
def test_the_wait_is_one_that_can_be_asked_for(value, patience):
    client, demo = FakeClient(), Demo(lambda _scene: None, lambda: None, lambda: "g1")
    DemoPanel(client.gui, demo)
    client.gui.widgets["demonstration"].set_by_person(True)
    client.gui.widgets["after rest of (s)"].set_by_person(value)
    assert demo.patience == patience
