"""What a hand has held last, out of the pushes of a run: its pieces, and one push that is as much."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

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
        impulse, seconds = _given(self.pieces)
        return self.grip.pulse(impulse / seconds, seconds)

    def from_now(self, most: int) -> tuple[Push, ...]:
        """The same pieces, the first of them at zero; of more than so many, neighbours are put together."""
        groups = [self.pieces[i:j] for i, j in pairwise(_cuts(len(self.pieces), most))]
        return tuple(self._together(group) for group in groups)

    def _together(self, group: tuple[Push, ...]) -> Push:
        """What some pieces have given as one, counted from the first piece of all."""
        start = group[0].start - self.first.start
        if len(group) == 1:
            return msgspec.structs.replace(group[0], start=start)
        return msgspec.structs.replace(self.grip.push(*_given(group)), start=start)


def _given(pieces: tuple[Push, ...]) -> tuple[np.ndarray, float]:
    """Impulse of some pieces (3,), N s, and for how long one push can give it, s."""
    seconds = round(math.fsum(piece.duration for piece in pieces), 6)
    impulse = np.sum([piece.impulse * piece.direction for piece in pieces], axis=0)
    return impulse, min(seconds, MAX_DURATION)


def _cuts(count: int, most: int) -> list[int]:
    """Where to cut so many pieces into at most so many groups of nearly the same number."""
    groups = min(count, most)
    return [count * i // groups for i in range(groups + 1)]


def _joined(piece: Push, after: Push) -> bool:
    """Whether one push begins where another ends."""
    return instant(piece.start + piece.duration) == instant(after.start)
