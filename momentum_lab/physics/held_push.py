"""The pushes of a run, and the one among them that a hand is still holding: its end is not known yet."""

from __future__ import annotations

from dataclasses import dataclass

import msgspec

from momentum_lab.physics.push import MAX_DURATION, Push


@dataclass(frozen=True, slots=True)
class Pushed:
    """All pushes of a run, sized.

    Attributes:
        all: in the order in which they were asked for; one that is held lasts as long as a push can.
        held: the one of them that is held now; None: none is.
    """

    all: tuple[Push, ...] = ()
    held: Push | None = None

    def with_push(self, push: Push) -> Pushed:
        """One more push."""
        return Pushed((*self.all, push), self.held)

    def held_from(self, time: float, push: Push) -> Pushed:
        """Hold a push from a time on, s; the one that was held before ends there."""
        held = msgspec.structs.replace(push, start=time, duration=MAX_DURATION, shape="rectangle")
        return Pushed((*self.let_go(time).all, held), held)

    def let_go(self, time: float) -> Pushed:
        """Let the held push end at a time, s; one that has not lasted at all has never been."""
        if self.held is None:
            return self
        lasted = min(time - self.held.start, MAX_DURATION)
        return Pushed(self._with_held(lasted) if lasted > 0.0 else self._without_held())

    def until(self, time: float, timestep: float) -> tuple[Push, ...]:
        """All pushes with the held one as long as it has lasted at a time, s, a time step at least."""
        if self.held is None:
            return self.all
        return self._with_held(min(max(time - self.held.start, timestep), MAX_DURATION))

    def _with_held(self, duration: float) -> tuple[Push, ...]:
        return tuple(
            msgspec.structs.replace(push, duration=duration) if push is self.held else push
            for push in self.all
        )

    def _without_held(self) -> tuple[Push, ...]:
        return tuple(push for push in self.all if push is not self.held)
