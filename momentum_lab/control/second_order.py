"""A feedback law read as a spring and damper: r'' + d r' + k r = 0 as damping ratio and natural frequency."""

from __future__ import annotations

import math

PAIRS = (("linear_damping", "linear_stiffness"), ("com_damping", "com_stiffness"))
"""Gains d (1/s) and k (1/s^2) of laws that pull the CoM back (Eq. 38, and Eq. 42 for the CoM)."""


def damping_ratio(damping: float, stiffness: float) -> float:
    """Zeta = d / (2 sqrt(k)): below 1 the CoM overshoots, above 1 it creeps back; infinite without stiffness."""
    return damping / (2.0 * math.sqrt(stiffness)) if stiffness > 0.0 else math.inf


def natural_frequency(stiffness: float) -> float:
    """Omega = sqrt(k), rad/s."""
    return math.sqrt(stiffness)


def gains_for(ratio: float, frequency: float) -> tuple[float, float]:
    """D = 2 zeta omega (1/s) and k = omega^2 (1/s^2)."""
    return 2.0 * ratio * frequency, frequency * frequency
