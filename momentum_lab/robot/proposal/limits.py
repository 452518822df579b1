"""Limits that a URDF lacks, guessed so that the robot can be tried."""

from __future__ import annotations

import math

import pinocchio as pin

from momentum_lab.robot.catalog import LimitSpec
from momentum_lab.robot.proposal.body import Body

_GRAVITY = 9.81
# A leg's motors hold this part of the robot's weight at the length of a leg, other motors a tenth of that.
_LEG, _OTHER = 0.3, 0.03
# A joint without a range may turn this far either way, rad.
_RANGE = 2.0


def missing_limits(body: Body) -> dict[str, LimitSpec]:
    """Joint -> a guess of the limits that it has none of.

    An effort is guessed as 0.3 m g l in a leg of length l and as a tenth of it elsewhere: at hips and knees TALOS has
    0.2 to 0.4, the G1 0.4 to 0.7 and Romeo 0.2.
    """
    weight = _GRAVITY * float(pin.computeTotalMass(body.model)) * body.leg_length
    found = {}
    for joint in range(2, body.model.njoints):
        part = _OTHER if joint in body.upper else _LEG
        limit = _missing(body.model, joint, float(f"{part * weight:.1g}"))
        if limit != LimitSpec():
            found[str(body.model.names[joint])] = limit
    return found


def _missing(model: pin.Model, joint: int, effort: float) -> LimitSpec:
    q, v = model.joints[joint].idx_q, model.joints[joint].idx_v
    low, high = float(model.lowerPositionLimit[q]), float(model.upperPositionLimit[q])
    own = float(model.effortLimit[v])
    ranged = math.isfinite(low) and math.isfinite(high) and low < high
    return LimitSpec(
        lower=None if ranged else -_RANGE,
        upper=None if ranged else _RANGE,
        effort=None if math.isfinite(own) and own > 0.0 else effort,
    )
