"""How far beyond what the CoP alone can catch: both robots in eight directions."""

from __future__ import annotations

import pytest

from momentum_lab.control import turning_back
from momentum_lab.experiments.push_limit import Trial, trial
from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario, changed

# Above 1 is what turning the body adds. From the side it is least: hips and ankles roll by 0.3 to 0.5 rad only.
REACHED = {0: 1.20, 45: 1.15, 90: 1.09, 135: 1.15, 180: 1.20, 225: 1.15, 270: 1.09, 315: 1.15}


def always(_fraction: float) -> bool:
    return True


def pushed(robot, direction: float, ratio: float) -> Trial:
    """A push of 0.1 s whose impulse is so many times what a pendulum survives with its CoP alone."""
    push = Push(force=0.0, direction_deg=direction, start=0.1, duration=0.1)
    standing = Scenario("reach", robot=robot.spec.name, seconds=3.6)
    small = trial(changed(standing, seconds=0.25), robot, push, 1.0, always)
    return trial(standing, robot, push, ratio / small.summary.impulse_ratio, always)


@pytest.mark.parametrize("direction", REACHED)
def test_a_push_beyond_the_reach_of_the_cop_is_survived(robot, direction):
    found = pushed(robot, direction, REACHED[direction])
    assert found.summary.impulse_ratio == pytest.approx(REACHED[direction], abs=1e-6)
    assert found.survived, found.why


def test_a_body_that_does_not_turn_back_in_time_falls(g1, monkeypatch):
    """The same push from the side with the priority alone: the joints end first."""
    monkeypatch.setattr(turning_back, "urgency_to_turn_back", lambda *_arguments: 0.0)
    assert not pushed(g1, 90.0, REACHED[90]).survived
