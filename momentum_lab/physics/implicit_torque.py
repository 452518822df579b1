"""Stiff torques in single joints that are implicit in a step, so that they are stable at its length."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True)
class ImplicitTorque:
    """Springs, dampers or friction of some joints (K) during one step.

    Attributes:
        rows: the joints' rows among all velocities (K,).
        torque: theirs if the joints kept their speed (K,), N m.
        added_inertia: what makes them implicit in the step (K,), kg m^2.
    """

    rows: np.ndarray
    torque: np.ndarray
    added_inertia: np.ndarray

    def felt_torque(self, acceleration: np.ndarray) -> np.ndarray:
        """Torques on all joints (na,), N m, for the acceleration (nv,) that the step has brought about."""
        felt = np.zeros(acceleration.size)
        felt[self.rows] = self.torque - self.added_inertia * acceleration[self.rows]
        return felt[6:]
