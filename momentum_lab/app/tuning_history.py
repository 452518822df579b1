"""Steps of tuning, to be taken back and taken again."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

from momentum_lab.app.widgets import HANDS_OFF
from momentum_lab.choices import Choices
from momentum_lab.events import SessionEvent

# One choice that goes on changing at this pace is one step: a slider on its way, s.
_ONE_STEP = 1.0
_MOST_STEPS = 200


class TuningHistory:
    """What was chosen for a session, step by step: gains, presets, priority, controller, goals, model errors.

    Args:
        chosen: what is chosen now.
        clock: seconds, for tests.
    """

    def __init__(self, chosen: Choices, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._now = chosen
        self._undo: list[Choices] = []
        self._redo: list[Choices] = []
        self._last: tuple[frozenset[str], float] = (frozenset(), -math.inf)
        self._asked = -math.inf

    @property
    def steps(self) -> tuple[int, int]:
        """How many steps can be taken back, and taken again."""
        return len(self._undo), len(self._redo)

    def note(self, chosen: Choices) -> None:
        """Take note of what is the case; it may be late after a step that has just been asked for."""
        if chosen == self._now or self._clock() - self._asked < HANDS_OFF:
            return
        changed = chosen.differing(self._now)
        if changed != self._last[0] or self._clock() - self._last[1] > _ONE_STEP:
            self._undo = [*self._undo, self._now][-_MOST_STEPS:]
        self._redo.clear()
        self._last = (changed, self._clock())
        self._now = chosen

    def back(self) -> list[SessionEvent]:
        """What undoes the last step; nothing if there is none."""
        return self._move(self._undo, self._redo)

    def forth(self) -> list[SessionEvent]:
        """What does it again; nothing if there is none."""
        return self._move(self._redo, self._undo)

    def _move(self, source: list[Choices], target: list[Choices]) -> list[SessionEvent]:
        if not source:
            return []
        before = self._now
        target.append(before)
        self._now = source.pop()
        self._asked = self._clock()
        self._last = (frozenset(), -math.inf)
        return before.until(self._now)
