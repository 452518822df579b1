"""Motors that are late: what is asked of them waits in a line until they give it."""

from __future__ import annotations

import numpy as np

Line = tuple[np.ndarray, ...]
"""Torques that have been asked for and not been given yet, the oldest first; never changed in place."""


def ticks_late(delay_ms: float, timestep: float) -> int:
    """A delay in whole ticks of a length, s."""
    return round(1e-3 * delay_ms / timestep)


def delayed(line: Line, torque: np.ndarray, late: int) -> tuple[np.ndarray, Line]:
    """The torque that the motors give now (na,), N m, and what waits after it.

    Where nothing has been asked for so long ago, the motors give the oldest that there is.

    Args:
        line: what waits.
        torque: what is asked for now (na,), N m.
        late: how many ticks later it is given.
    """
    asked = (*line, torque)[-1 - late :]
    return asked[0], asked[1:] if len(asked) > late else asked
