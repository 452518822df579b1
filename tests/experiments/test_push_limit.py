"""The largest push: bisection on a made-up robot, real ones against each other's physics."""

from __future__ import annotations

from functools import cache
from types import SimpleNamespace

import msgspec
import numpy as np
import pytest

from momentum_lab.errors import InputError
from momentum_lab.experiments import push_limit as module
from momentum_lab.experiments.push_limit import PushLimit, Trial, push_limit
from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario, changed
from tests.runs import play

# Both engines' largest pushes are this close to each other.
AGREEMENT = 0.10
COARSE = 0.05
# Within 3.5 s after the push both robots have come to rest from nearly all they survive.
START, SECONDS = 0.1, 3.6
# Impulse over what the CoP alone survives, found with a search that stops up to 5 % short: above 1.2 but for a push
# from the side, where the lever of the CoP is longest and a leg has little room to let the body turn.
LEAST_RATIO = {0.0: 1.15, 90.0: 0.95, 180.0: 1.15, 225.0: 1.15}


def always(_fraction: float) -> bool:
    return True


def standing(robot, engine: str = "pinocchio") -> Scenario:
    return Scenario("limit", robot=robot.spec.name, engine=engine, seconds=SECONDS)


@cache
def limit_of(robot, direction: float) -> PushLimit:
    """The lab's own largest push in a direction, searched once."""
    push = Push(force=0.0, direction_deg=direction, start=START)
    return push_limit(standing(robot), robot, push, always, COARSE)


def pretend(monkeypatch, survives) -> list[float]:
    """Trials that know at once; the forces that were tried."""
    tried: list[float] = []

    def trial(scenario, robot, push, force, proceed) -> Trial:
        assert proceed(0.0)
        tried.append(force)
        summary = SimpleNamespace(
            settled=survives(force),
            fell=True,
            fall_time=1.0,
            fall_reason="it was pushed",
            impulse=force * push.duration,
            impulse_ratio=0.01 * force,
            scenario=scenario.name,
        )
        return Trial(force, summary, ("a foot",))

    monkeypatch.setattr(module, "trial", trial)
    return tried


@pytest.mark.parametrize("true_limit", [3.0, 137.0, 261.0, 2345.0])
def test_bisection_ends_within_its_precision(true_limit, monkeypatch, g1):
    tried = pretend(monkeypatch, lambda force: force < true_limit)
    told: list[float] = []
    found = push_limit(
        Scenario("made-up", robot="g1"), g1, Push(force=0.0), lambda part: not told.append(part), 0.01
    )
    assert found.force < true_limit <= found.beyond
    assert found.beyond - found.force <= 0.01 * found.beyond
    assert found.impulse == pytest.approx(0.1 * found.force)
    assert found.impulse_ratio == pytest.approx(0.01 * found.force)
    assert found.why == "fell at 1.00 s: it was pushed"
    assert found.signs == ("a foot",)
    assert found.trials == len(tried) == len(told)
    assert told == sorted(told)
    assert max(told) <= 1.0


def test_a_robot_that_nothing_fells_survives_the_largest_push(monkeypatch, g1):
    pretend(monkeypatch, lambda force: True)
    found = push_limit(Scenario("made-up", robot="g1"), g1, Push(force=0.0), always)
    assert (found.force, found.beyond, found.signs) == (5000.0, None, ())


def test_a_robot_that_falls_by_itself_is_refused(monkeypatch, g1):
    tried = pretend(monkeypatch, lambda force: False)
    with pytest.raises(
        InputError, match="scenario: got made-up; allowed: one in which the robot comes to rest"
    ):
        push_limit(Scenario("made-up", robot="g1"), g1, Push(force=0.0), always)
    assert tried == [0.0]


def test_a_push_after_the_end_is_refused(g1):
    with pytest.raises(InputError, match=r"push: got 0\.5 s to 0\.6 s; allowed: a push that ends before"):
        push_limit(Scenario("short", robot="g1", seconds=0.6), g1, Push(force=0.0), always)


@pytest.mark.parametrize("direction", LEAST_RATIO)
def test_both_engines_agree_on_the_largest_push(robot, direction):
    """Rigid and soft contact, two derivations of the dynamics: the limit is the controller's, not the engine's.

    The lab's own is between force and beyond; MuJoCo's is within 10 % of it wherever in there it is.
    """
    push, found = Push(force=0.0, direction_deg=direction, start=START), limit_of(robot, direction)
    assert found.impulse_ratio > LEAST_RATIO[direction]
    lower, upper = (1.0 - AGREEMENT) * found.beyond, (1.0 + AGREEMENT) * found.force
    assert module.trial(standing(robot, "mujoco"), robot, push, lower, always).survived
    assert not module.trial(standing(robot, "mujoco"), robot, push, upper, always).survived


def test_a_limit_tells_a_run_at_rest_from_one_that_is_not(g1):
    """The same runs without the search: one at rest at the end; the other fallen, or faster than 0.02 m/s."""
    push, found = Push(force=0.0, direction_deg=90.0, start=START), limit_of(g1, 90.0)
    stood, failed = (
        play(g1, changed(standing(g1), pushes=(msgspec.structs.replace(push, force=force),)))
        for force in (found.force, found.beyond)
    )
    assert stood.fall is None
    assert np.linalg.norm(stood.recording.latest["com_velocity"]) < 0.02
    moving = np.linalg.norm(failed.recording.latest["com_velocity"]) >= 0.02
    assert failed.fall is not None or moving
    assert found.impulse == pytest.approx(0.1 * found.force)
    assert found.impulse_ratio > 0.9
    assert found.signs
