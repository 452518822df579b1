"""Times of a run are sums of time steps: which of them are one and the same."""

from __future__ import annotations

ROUNDING = 1e-6
"""What a sum of time steps may be off by, s; no time step is as short."""


def instant(time: float) -> int:
    """A time of a run, s, as a whole number: two sums that mean the same time have the same one."""
    return round(time / ROUNDING)
