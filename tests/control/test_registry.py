"""Controllers by name."""

from __future__ import annotations

import pytest

from momentum_lab.control.registry import CONTROLLERS, controller_entry
from momentum_lab.errors import InputError
from tests.control.situations import goal, home


def test_the_name_of_nothing_is_refused_with_all_names():
    with pytest.raises(InputError, match=r"controller: got lqr; allowed: one of .*computed-torque"):
        controller_entry("lqr")


@pytest.mark.parametrize("name", CONTROLLERS)
def test_every_controller_holds_a_standing_robot(name, talos):
    """Built from its entry it answers with torques that keep the robot still, and without a failure."""
    entry = controller_entry(name)
    assert entry.title
    assert entry.summary.endswith(".")
    controller, dynamics = entry.make(talos, 1e-3), home(talos)
    output = controller.compute(
        dynamics, goal(talos, dynamics), entry.gains, 0.0, controller.initial_memory(dynamics)
    )
    assert output.failure is None
    assert output.torque.shape == (talos.na,)
    assert abs(output.acceleration).max() < 0.1
