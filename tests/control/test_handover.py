"""What a takeover adds, and how it fades."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.control.handover import Handover
from tests.conftest import assert_close


def test_the_first_torque_is_the_previous_one(rng):
    previous, torque = rng.normal(size=7), rng.normal(size=7)
    assert_close(Handover.between(previous, torque).applied(torque), previous, 1e-15)


@pytest.mark.parametrize("timestep", [1e-3, 5e-4])
def test_it_fades_with_time_and_not_with_ticks(rng, timestep):
    """After 50 ms a 1/e of it is left, whatever the length of a tick."""
    handover = Handover.between(rng.normal(size=7), rng.normal(size=7))
    faded = handover
    for _ in range(round(0.05 / timestep)):
        faded = faded.later(timestep)
    assert_close(faded.missing, handover.missing / np.e, 1e-12)
