"""Gains that mean the same in several controllers, declared once; each call is a new field of a dataclass."""

from __future__ import annotations

from typing import Any

from momentum_lab.control.gains import gain


def linear_damping() -> Any:
    """Gamma_21 of Eq. 38."""
    return gain(8.0, "1/s", 0.0, 60.0, "Gamma_21: how strongly the velocity of the CoM is braked (Eq. 38).")


def linear_stiffness() -> Any:
    """Gamma_22 of Eq. 38."""
    return gain(
        16.0, "1/s^2", 0.0, 200.0, "Gamma_22: how strongly the CoM is pulled back over the feet (Eq. 38)."
    )


def angular_damping() -> Any:
    """Gamma_11 of Eq. 37."""
    return gain(5.0, "1/s", 0.0, 40.0, "Gamma_11: how strongly angular momentum is braked (Eq. 37).")


def pelvis_stiffness() -> Any:
    """K_theta, our extension of Eq. 37."""
    return gain(
        4.0, "1/s^2", 0.0, 60.0, "K_theta: how strongly the pelvis is turned upright; an extension of Eq. 37."
    )


def contact_damping() -> Any:
    """Kappa of the stance constraint, Eq. 31."""
    return gain(
        50.0, "1/s", 0.0, 200.0, "kappa: how fast a stance foot is brought to rest and flat (Eq. 31)."
    )


def safe_border() -> Any:
    """How much of each sole is not used."""
    return gain(0.005, "m", 0.0, 0.02, "How far inside the edge of each sole its CoP is kept (Eq. 52).")


def friction() -> Any:
    """The friction a controller trusts in; the ground's own is a setting of the scenario."""
    return gain(0.6, "1", 0.05, 1.5, "Friction coefficient the controller counts on.")


def least_foot_force() -> Any:
    """What keeps a stance foot from being unloaded."""
    return gain(0.02, "1", 0.005, 0.2, "Part of the weight that every stance foot keeps carrying.")


def joint_limit_rate() -> Any:
    """How accelerations are bounded near a joint's limit."""
    return gain(25.0, "1/s", 5.0, 100.0, "How late a joint may brake before its limit: larger is later.")
