"""What the Push tab says after a drag: the widgets have taken over what a hand has done, and P gives it again."""

from __future__ import annotations

from dataclasses import dataclass

from momentum_lab.physics.push import Push

PULSE = "P repeats what your hand did"
HOLD = "P gives the mean of what your hand held"


@dataclass(frozen=True, slots=True)
class HandsPush:
    """What a hand has done, as the widgets describe it.

    Attributes:
        push: the push that the widgets describe since.
        lead: how it is said.
    """

    push: Push
    lead: str

    def words(self, push: Push) -> str:
        """The sentence, for as long as the widgets describe the same push; else nothing."""
        if push != self.push:
            return ""
        body = (push.body or "trunk").replace("_", " ")
        size = f"{push.force or 0.0:.0f} N for {1e3 * push.duration:.0f} ms"
        return f"{self.lead}: {size} on the {body}, direction {push.towards}."
