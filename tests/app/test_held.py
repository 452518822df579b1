"""What a hand has held last: its pieces among all pushes of a run, and their mean."""

from __future__ import annotations

import math
from itertools import pairwise

import msgspec
import numpy as np
import pytest

from momentum_lab.app.held import Held
from momentum_lab.app.inbox import MOST_PUSHES, checked_event
from momentum_lab.app.pull import Grip
from momentum_lab.events import ApplyPushes
from momentum_lab.physics.push import MAX_DURATION, Push
from tests.conftest import assert_close

GRIP = Grip("trunk", (0.1, 0.0, 0.2))


def pieces_of(pushes: tuple[Push, ...]) -> tuple[Push, ...]:
    held = Held.last_of(pushes, GRIP)
    assert held is not None
    return held.pieces


def held_for(*seconds: float) -> tuple[Push, ...]:
    """A hand that pulls forward with 100 N, in pieces that last so long."""
    piece = GRIP.piece(np.array([100.0, 0.0, 0.0]), 1000.0)
    return tuple(
        msgspec.structs.replace(piece, start=2.0 + math.fsum(seconds[:i]), duration=duration)
        for i, duration in enumerate(seconds)
    )


def test_the_mean_of_a_hold_has_its_impulse_and_its_length():
    pieces = (
        msgspec.structs.replace(GRIP.piece(np.array([100.0, 0.0, 0.0]), 1000.0), start=2.0, duration=0.3),
        msgspec.structs.replace(GRIP.piece(np.array([0.0, 100.0, 0.0]), 1000.0), start=2.3, duration=0.4),
    )
    held = Held(GRIP, pieces[0], pieces[1:])
    mean = held.mean
    assert mean.duration == pytest.approx(0.7)
    assert mean.force == pytest.approx(math.hypot(30.0, 40.0) / 0.7, abs=0.5)
    assert mean.direction_deg == pytest.approx(math.degrees(math.atan2(40.0, 30.0)), abs=0.5)
    assert [round(piece.start, 9) for piece in held.from_now(50)] == [0.0, 0.3]


def test_a_hold_is_told_from_what_came_before_it():
    before = Push(force=10.0, start=1.0, duration=1.0)
    pieces = tuple(
        msgspec.structs.replace(GRIP.piece(np.array([force, 0.0, 0.0]), 650.0), start=start, duration=0.5)
        for force, start in ((65.0, 2.0), (130.0, 2.5))
    )
    assert pieces_of((before, *pieces)) == pieces
    gap = msgspec.structs.replace(pieces[0], start=1.4)
    assert pieces_of((gap, *pieces)) == pieces
    assert Held.last_of((), GRIP) is None
    assert Held.last_of((before,), GRIP) is None


def impulse_of(pushes: tuple[Push, ...]) -> np.ndarray:
    return np.sum([push.impulse * push.direction for push in pushes], axis=0)


@pytest.mark.parametrize("count", [1, 50, 51, 137, 500])
def test_a_hold_of_many_pieces_is_repeated_in_as_many_as_the_inbox_takes(count):
    """A hand that turns by 5 degrees and pulls harder with each piece."""
    angles = np.radians(5.0) * np.arange(count)
    forces = (50.0 + np.arange(count)) * np.array([np.cos(angles), np.sin(angles), 0.3 + 0.0 * angles])
    pieces = tuple(
        msgspec.structs.replace(GRIP.piece(force, 1000.0), start=2.0 + 0.02 * i, duration=0.02)
        for i, force in enumerate(forces.T)
    )
    repeated = Held(GRIP, pieces[0], pieces[1:]).from_now(MOST_PUSHES)
    assert checked_event(ApplyPushes(repeated), (), ()) == ApplyPushes(repeated)
    assert len(repeated) == min(count, MOST_PUSHES)
    assert repeated[0].start == 0.0
    for one, after in pairwise(repeated):
        assert one.start + one.duration == pytest.approx(after.start)
    assert repeated[-1].start + repeated[-1].duration == pytest.approx(0.02 * count)
    assert_close(impulse_of(repeated), impulse_of(pieces), 1e-4 * sum(piece.impulse for piece in pieces))


def test_a_push_of_another_kind_during_a_hold_does_not_cut_it():
    """Whoever holds the robot with one hand can press P with the other."""
    pieces = held_for(0.5, 0.5)
    pressed = Push(force=10.0, start=2.2, duration=0.1)
    assert pieces_of((pieces[0], pressed, pieces[1])) == pieces
    assert pieces_of((*pieces, pressed)) == pieces


@pytest.mark.parametrize("seconds", [(9.0, 9.0), (9.0, 9.0, 9.0), (0.0123, 0.0004)])
def test_the_mean_keeps_the_impulse_however_long_it_was_held(seconds):
    """100 N for 18 s are 180 N for the ten seconds that a push may last."""
    pieces = held_for(*seconds)
    mean = Held(GRIP, pieces[0], pieces[1:]).mean
    assert mean.duration <= MAX_DURATION
    assert mean.impulse == pytest.approx(100.0 * math.fsum(seconds), rel=0.005)
