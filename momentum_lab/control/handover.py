"""Torques without a jump when a controller takes over from another: what is missing at first fades out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

# Time constant of the fading, s: quick against the fall of a humanoid, slow against a tick.
_FADING_TIME = 0.05


@dataclass(frozen=True, slots=True)
class Handover:
    """What is still added to the torques of the new controller.

    Attributes:
        missing: previous torque minus new torque at the takeover, faded since (na,), N m.
    """

    missing: np.ndarray

    @classmethod
    def between(cls, previous: np.ndarray, torque: np.ndarray) -> Handover:
        """The takeover by a controller that answers `torque` where `previous` was applied (na,), N m."""
        return cls(previous - torque)

    def applied(self, torque: np.ndarray) -> np.ndarray:
        """The torques to apply for those of the new controller (na,), N m."""
        return torque + self.missing

    def later(self, timestep: float) -> Handover:
        """One tick (s) on: exp(-t / 0.05 s) of the difference is left after t."""
        return Handover(self.missing * float(np.exp(-timestep / _FADING_TIME)))
