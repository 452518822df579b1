"""How many ticks are due: simulated time keeps just ahead of the clock, and never catches up in a burst."""

from __future__ import annotations

from collections import deque

LATE = 5e-3
"""A tick that begins later than this after it was due is a late one, s."""

# Simulated time runs ahead of the clock by this, s, as sound is buffered: a pause of the system this short is not
# felt, and a push that arrives meanwhile is no later for it. Shorter than one drawing.
LEAD = 16e-3
# What may be caught up after a short stall, s of simulated time; what is later than this never happens.
_BACKLOG = 0.08
# Over how long the real-time factor is measured, s.
_WINDOW = 1.0


class Pacer:
    """The clock of one playback: tick k belongs to k time steps after the start, and may begin `LEAD` before.

    Args:
        timestep: length of a tick, s.

    Attributes:
        late_ticks: how many ticks have begun late; those that were given up count too.
    """

    def __init__(self, timestep: float) -> None:
        self._timestep = timestep
        self._speed = 1.0
        self._start = 0.0
        self._ticks = 0
        self._marks: deque[tuple[float, int]] = deque()
        self._factor = 0.0
        self.late_ticks = 0

    def start(self, now: float, speed: float) -> None:
        """Let simulated time run from now on, at a fraction of real time."""
        self._speed, self._start, self._ticks = speed, now, 0
        self._marks.clear()

    def due(self, now: float) -> int:
        """Ticks that may begin by now and have not."""
        due = self._owed(now)
        late = due - max(1, round(_BACKLOG / self._timestep))
        if late > 0:
            self._start += late * self._timestep / self._speed
            self.late_ticks += late
            due -= late
        return due

    def begin(self, now: float) -> None:
        """A tick begins; late is judged by the moment it belongs to, not by that of its lead."""
        self._ticks += 1
        self.late_ticks += now - self._start - self._ticks * self._timestep / self._speed > LATE

    def wait(self, now: float) -> float:
        """How long until the next tick may begin, s."""
        next_tick = self._start + (self._ticks + 1) * self._timestep / self._speed - LEAD
        return max(0.0, next_tick - now)

    def real_time_factor(self, now: float) -> float:
        """Simulated seconds per second over the last second or so."""
        self._marks.append((now, self._ticks))
        while len(self._marks) > 2 and now - self._marks[1][0] >= _WINDOW:
            self._marks.popleft()
        then, ticks = self._marks[0]
        if now - then >= 0.2 * _WINDOW:
            self._factor = (self._ticks - ticks) * self._timestep / (now - then)
        return self._factor

    def _owed(self, now: float) -> int:
        # A tick that is due this very moment must not be missed by a rounding error.
        return int((now + LEAD - self._start) * self._speed / self._timestep + 1e-6) - self._ticks
