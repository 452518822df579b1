"""What a hand has held last, out of the pushes of a run: its pieces, and one push that is as much."""

from __future__ import annotations

import math
from dataclasses import dataclass

import msgspec
import numpy as np

from momentum_lab.app.instants import instant
from momentum_lab.app.pull import Grip
from momentum_lab.physics.push import MAX_DURATION, Push


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
        """The last hold of a run with this grip, whatever else has pushed meanwhile; None if there is none."""
        gripped = [push for push in pushes if (push.body, push.point) == (grip.body, grip.point)]
        first = len(gripped) - 1
        while first > 0 and _joined(gripped[first - 1], gripped[first]):
            first -= 1
        return cls(grip, gripped[first], tuple(gripped[first + 1 :])) if gripped else None

    @property
    def pieces(self) -> tuple[Push, ...]:
        """All pieces, in time."""
        return (self.first, *self.others)

    @property
    def mean(self) -> Push:
        """One constant push with the same impulse, as far as whole newtons go; it lasts as long if a push can."""
        seconds = min(round(math.fsum(piece.duration for piece in self.pieces), 6), MAX_DURATION)
        impulse = np.sum([piece.impulse * piece.direction for piece in self.pieces], axis=0)
        return self.grip.pulse(impulse / seconds, seconds)

    @property
    def from_now(self) -> tuple[Push, ...]:
        """The same pieces, the first of them at zero."""
        start = self.first.start
        return tuple(msgspec.structs.replace(piece, start=piece.start - start) for piece in self.pieces)


def _joined(piece: Push, after: Push) -> bool:
    """Whether one push begins where another ends."""
    return instant(piece.start + piece.duration) == instant(after.start)
