"""What a hand has held last, out of the pushes of a run: its pieces, and one push that is as much."""

from __future__ import annotations

import math
from dataclasses import dataclass

import msgspec
import numpy as np

from momentum_lab.app.pull import Grip
from momentum_lab.physics.push import MAX_DURATION, Push

# Pieces of one hold follow each other at once, s.
_AT_ONCE = 1e-6


@dataclass(frozen=True, slots=True)
class Held:
    """A hold: pushes at one point, each of which begins where the one before it ends.

    Attributes:
        grip: what was held.
        first: the first piece.
        others: the other pieces, in time.
    """

    grip: Grip
    first: Push
    others: tuple[Push, ...] = ()

    @classmethod
    def last_of(cls, pushes: tuple[Push, ...], grip: Grip) -> Held | None:
        """The last pushes of a run if they have this grip; None if the last one has not."""
        chain: list[Push] = []
        for push in pushes[::-1]:
            joined = not chain or abs(push.start + push.duration - chain[0].start) < _AT_ONCE
            if not joined or (push.body, push.point) != (grip.body, grip.point):
                break
            chain.insert(0, push)
        return cls(grip, chain[0], tuple(chain[1:])) if chain else None

    @property
    def pieces(self) -> tuple[Push, ...]:
        """All pieces, in time."""
        return (self.first, *self.others)

    @property
    def mean(self) -> Push:
        """One constant push that lasts as long, with the same impulse."""
        seconds = math.fsum(piece.duration for piece in self.pieces)
        force = np.sum([piece.impulse * piece.direction for piece in self.pieces], axis=0) / seconds
        return self.grip.pulse(force, min(round(seconds, 3), MAX_DURATION))

    @property
    def from_now(self) -> tuple[Push, ...]:
        """The same pieces, the first of them at zero."""
        start = self.first.start
        return tuple(msgspec.structs.replace(piece, start=piece.start - start) for piece in self.pieces)
