from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.experiments import fig1
from momentum_lab.experiments.claims import Runs
from momentum_lab.experiments.measured import ground_force, momentum_slope
from momentum_lab.experiments.play import play
from momentum_lab.scenario import changed
from tests.experiments.played import always, any_starts, claims, failing, played


@pytest.mark.parametrize("name", ["talos", "g1"])
def test_claims_hold(name: str) -> None:
    assert failing(claims("fig1", name)) == []


def runs() -> Runs:
    return play(fig1.scenarios("talos"), always).runs


@pytest.mark.parametrize(
    ("column", "part", "start"),
    [
        ("momentum", 0, "f gives the rate of linear momentum"),
        ("momentum", 4, "f, p and tau_n give the rate of angular momentum"),
        ("cop_measured", 1, "both rates give p back"),
    ],
)
def test_a_world_that_breaks_the_equations_is_noticed(column: str, part: int, start: str) -> None:
    """A momentum that grows, or a CoP that lies elsewhere, without any force to account for it."""
    tampered = runs()
    recording = tampered["push"].recording
    recording.column(column)[:, part] += 0.1 * recording.column("time") * tampered["push"].robot.mass
    assert any_starts(failing(fig1.claims(tampered)), start)


def test_both_ways_are_inverse_to_each_other() -> None:
    """The forces that the rates give are those that give the rates, tick by tick."""
    session = played("fig1", "talos").runs["push"]
    linear, _ = fig1.from_ground(session)
    slope = momentum_slope(session)
    force, cop, torque = fig1.from_motion(session)
    assert abs((force - ground_force(session)[:-1]) - (slope[:, :3] - linear[:-1])).max() < 1e-9
    arm = np.column_stack([cop, 0.0 * torque]) - session.recording.column("com")[:-1]
    moment = np.cross(arm, force)
    moment[:, 2] += torque
    column = session.recording.column
    push, com = column("push_wrench")[:-1], column("com")[:-1]
    moment += push[:, 3:] - np.cross(com, push[:, :3])
    assert abs(moment - slope[:, 3:]).max() < 1e-9


@pytest.mark.parametrize("name", ["talos", "g1"])
def test_what_is_left_between_both_ways_halves_with_the_tick(name: str) -> None:
    """So it is the difference quotient's, and not a force that was forgotten."""
    push = fig1.scenarios(name)["push"]
    finer = fig1.claims(play({"push": changed(push, timestep=0.5 * push.timestep)}, always).runs)
    for coarse, fine in list(zip(claims("fig1", name), finer, strict=True))[1:6]:
        assert fine.measured == pytest.approx(0.5 * coarse.measured, rel=0.1)
