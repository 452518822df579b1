"""Gains of the momentum-based computed torque controller, with what each of them does."""

from __future__ import annotations

from dataclasses import dataclass

from momentum_lab.control import common_gains
from momentum_lab.control.gains import gain


@dataclass(frozen=True, slots=True)
class ComputedTorqueGains:
    """Gains of the momentum-based computed torque controller."""

    linear_damping: float = common_gains.linear_damping()
    linear_stiffness: float = common_gains.linear_stiffness()
    angular_damping: float = common_gains.angular_damping()
    pelvis_stiffness: float = common_gains.pelvis_stiffness()
    momentum_weight: float = gain(
        0.9999, "1", 0.5, 0.99999, "w_b: momentum against posture where both cannot be met (Eq. 34)."
    )
    posture_stiffness: float = gain(
        100.0, "1/s^2", 0.0, 400.0, "How strongly the upper body is pulled to its posture (Eq. 34)."
    )
    posture_damping: float = gain(
        20.0, "1/s", 0.0, 60.0, "How strongly the motion of the upper body is braked (Eq. 34)."
    )
    pelvis_weight: float = gain(
        1.0,
        "1",
        0.0,
        100.0,
        "Weight of an upright pelvis against the posture of the upper body; an extension.",
    )
    contact_damping: float = common_gains.contact_damping()
    safe_border: float = common_gains.safe_border()
    friction: float = common_gains.friction()
    least_foot_force: float = common_gains.least_foot_force()
    joint_limit_rate: float = common_gains.joint_limit_rate()
    feedback_stiffness: float = gain(
        0.0,
        "N m/rad",
        0.0,
        2000.0,
        "Gamma_p: joint position feedback on top of the computed torque (Eq. 36).",
    )
    feedback_damping: float = gain(
        0.0,
        "N m s/rad",
        0.0,
        50.0,
        "Gamma_d: joint velocity feedback on top of the computed torque (Eq. 36).",
    )
