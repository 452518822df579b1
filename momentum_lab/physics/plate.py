"""Plates of ground as plain data: where they are, how they are tilted, how they move, how slippery they are."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec

MAX_TILT = 15.0
MAX_HEIGHT = 0.2
MAX_SWING = 0.3
MAX_TURN = 15.0
MAX_FRICTION = 2.0
MAX_START = 3600.0
MIN_PERIOD, MAX_PERIOD = 0.2, 60.0

Axis = Literal["x", "y", "z", "roll", "pitch"]
Course = Literal["sine", "step"]
AXES: tuple[Axis, ...] = ("x", "y", "z", "roll", "pitch")
Friction = Annotated[float, msgspec.Meta(gt=0.0, le=MAX_FRICTION)]
Start = Annotated[float, msgspec.Meta(ge=0.0, le=MAX_START)]
Tilt = Annotated[float, msgspec.Meta(ge=-MAX_TILT, le=MAX_TILT)]


class PlateMotion(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A motion of a plate along or about one of its axes; several of them add up.

    A sine grows to its full amplitude within its first period, a step takes its period: neither ever jerks the
    plate. x is where the robot faces at its start, y its left; a positive roll lifts the left side, a positive
    pitch lowers the front.

    Attributes:
        axis: along x, y or z, or the angle of roll or pitch.
        amplitude: how far, m; for roll and pitch degrees.
        course: a sine that goes on, or one step.
        period: of the sine, s; how long the step takes, s.
        start: when it begins, s of simulated time.
        stop: when a sine has come to rest, s; it fades within its last period; None: never.
    """

    axis: Axis
    amplitude: float
    course: Course = "sine"
    period: Annotated[float, msgspec.Meta(ge=MIN_PERIOD, le=MAX_PERIOD)] = 2.0
    start: Start = 0.5
    stop: Start | None = None


class FrictionChange(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Ice, or sand: another friction from an instant on.

    Attributes:
        friction: Coulomb coefficient.
        start: when it begins, s of simulated time.
    """

    friction: Friction
    start: Start = 0.0


class Plate(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The ground under some of the feet.

    It turns about the middle of the places of its feet, where they are on level ground.

    Attributes:
        feet: which feet; empty: all of them on one plate.
        roll_deg: tilt about the axis where the robot faces; positive lifts the left side, degrees.
        pitch_deg: tilt about the axis to its left; positive lowers the front, degrees.
        height: of its middle above the floor, m.
        friction: Coulomb coefficient; None: the scenario's.
        motions: how it moves.
        changes: when it becomes more or less slippery.
    """

    feet: tuple[str, ...] = ()
    roll_deg: Tilt = 0.0
    pitch_deg: Tilt = 0.0
    height: Annotated[float, msgspec.Meta(ge=-MAX_HEIGHT, le=MAX_HEIGHT)] = 0.0
    friction: Friction | None = None
    motions: tuple[PlateMotion, ...] = ()
    changes: tuple[FrictionChange, ...] = ()
