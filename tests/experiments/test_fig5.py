from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.experiments import fig5
from momentum_lab.physics.push import Push
from momentum_lab.robot.state import State
from momentum_lab.scenario import changed
from momentum_lab.session import Session
from tests.experiments.played import any_starts, claims, failing, failing_with, played


@pytest.mark.parametrize("name", ["talos", "g1"])
def test_claims_hold(name: str) -> None:
    assert failing(claims("fig5", name)) == []


def test_a_small_push_needs_no_rotation() -> None:
    push = Push(velocity_change=0.02, direction_deg=90.0, start=0.1)
    small = {"push": changed(fig5.scenarios("talos")["push"], pushes=(push,), seconds=0.6)}
    failed = failing_with(fig5.FIGURE, small)
    assert any_starts(failed, "the CMP leaves the foot")
    assert any_starts(failed, "the body rotates with it")


def test_the_robot_leans_towards_where_it_is_pushed() -> None:
    """The head is left of where it was: seen without any angle."""
    session = played("fig5", "g1").runs["push"]
    turned = int(abs(session.recording.column("momentum")[:, 3].cumsum()).argmax())
    before, after = (session.robot.at(State(*_state(session, tick))) for tick in (0, turned))
    lean_before, lean_after = (d.pelvis_rotation[1, 2] for d in (before, after))
    assert lean_after - lean_before > 0.02


def _state(session: Session, tick: int) -> tuple[np.ndarray, np.ndarray]:
    return session.recording.column("q")[tick], session.recording.column("v")[tick]
