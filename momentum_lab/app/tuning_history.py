"""Steps of tuning, to be taken back and taken again."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

from momentum_lab.app.widgets import HANDS_OFF

Values = dict[str, float]
# One gain that goes on changing at this pace is one step: a slider on its way, s.
_ONE_STEP = 1.0
_MOST_STEPS = 200


class TuningHistory:
    """What all gains of one controller were, step by step.

    Args:
        values: what they are now.
        clock: seconds, for tests.
    """

    def __init__(self, values: Values, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._now = dict(values)
        self._undo: list[Values] = []
        self._redo: list[Values] = []
        self._last: tuple[frozenset[str], float] = (frozenset(), -math.inf)
        self._asked = -math.inf

    @property
    def steps(self) -> tuple[int, int]:
        """How many steps can be taken back, and taken again."""
        return len(self._undo), len(self._redo)

    def note(self, values: Values) -> None:
        """Take note of what is the case; it may be late after a step that has just been asked for."""
        if values == self._now or self._clock() - self._asked < HANDS_OFF:
            return
        changed = frozenset(name for name in values if values[name] != self._now.get(name))
        if changed != self._last[0] or self._clock() - self._last[1] > _ONE_STEP:
            self._undo = [*self._undo, self._now][-_MOST_STEPS:]
        self._redo.clear()
        self._last = (changed, self._clock())
        self._now = dict(values)

    def back(self) -> Values:
        """The gains that the step back changes, as they were; none if there is no step."""
        return self._move(self._undo, self._redo)

    def forth(self) -> Values:
        """The gains that the step forth changes, as they were; none if there is no step."""
        return self._move(self._redo, self._undo)

    def _move(self, source: list[Values], target: list[Values]) -> Values:
        if not source:
            return {}
        before = self._now
        target.append(before)
        self._now = source.pop()
        self._asked = self._clock()
        self._last = (frozenset(), -math.inf)
        return {name: value for name, value in self._now.items() if value != before.get(name)}
