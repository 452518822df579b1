"""How the robot that is simulated differs from the one its controller believes in, as plain data."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Annotated, Any, get_type_hints

import msgspec

from momentum_lab.errors import InputError
from momentum_lab.robot.model import RobotModel


def _error(unit: str, low: float, high: float, step: float, help: str) -> msgspec.Meta:
    """The declaration of one error: unit ("1" for a ratio), range, a slider's step, what it is in one sentence."""
    return msgspec.Meta(ge=low, le=high, description=help, extra={"unit": unit, "step": step})


class Mismatch(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What the controller is not told; the defaults are a robot that is what it believes to be.

    Attributes:
        mass_error: e; masses and inertias of all real links are 1 + e times the model's.
        joint_friction: Coulomb friction of each joint, as a part of its motor's torque limit.
        torque_delay_ms: how late the motors give what is asked of them, ms, rounded to whole ticks.
        encoder_noise: standard deviation of the measured joint angles, rad.
        imu_noise: standard deviation of the measured orientation of the base, rad.
        torque_scale: the part of their torque limits that the real motors can give.
    """

    mass_error: Annotated[
        float,
        _error("1", -0.3, 0.3, 0.01, "How much heavier every link really is than the controller believes."),
    ] = 0.0
    joint_friction: Annotated[
        float,
        _error(
            "1", 0.0, 0.1, 0.001, "Coulomb friction of each joint, as a part of its motor's torque limit."
        ),
    ] = 0.0
    torque_delay_ms: Annotated[
        float, _error("ms", 0.0, 5.0, 1.0, "How late the motors give the torque that is asked of them.")
    ] = 0.0
    encoder_noise: Annotated[
        float,
        _error(
            "rad", 0.0, 2e-3, 1e-5, "Noise of the measured joint angles; their speeds get a matching one."
        ),
    ] = 0.0
    imu_noise: Annotated[
        float,
        _error("rad", 0.0, 1e-2, 1e-4, "Noise of the measured orientation; its rate gets a matching one."),
    ] = 0.0
    torque_scale: Annotated[
        float, _error("1", 0.3, 1.0, 0.01, "The part of their torque limits that the real motors can give.")
    ] = 1.0


EXACT = Mismatch()
"""A robot that is what its controller believes."""


@dataclass(frozen=True, slots=True)
class ModelError:
    """What a person needs to know about one entry of a `Mismatch`.

    Attributes:
        name: its name there and on the command line.
        default: its value where nothing is wrong.
        unit: its unit, "1" for a ratio.
        low: smallest allowed value.
        high: largest allowed value.
        step: of a slider.
        help: what it is, in one sentence.
    """

    name: str
    default: float
    unit: str
    low: float
    high: float
    step: float
    help: str


def model_errors() -> dict[str, ModelError]:
    """All entries of a `Mismatch` by name, in the order of their declaration."""
    hints = get_type_hints(Mismatch, include_extras=True)
    return {name: _declared(name, hints[name].__metadata__[0]) for name in Mismatch.__struct_fields__}


def with_error(mismatch: Mismatch, name: str, value: float | str) -> Mismatch:
    """The same mismatch with one entry changed.

    Raises:
        InputError: there is no such entry, or the value is out of its range.
    """
    known = model_errors()
    if name not in known:
        raise InputError("mismatch", name, f"one of {', '.join(known)}")
    error = known[name]
    if not isinstance(value, int | float) or not error.low <= value <= error.high:
        unit = "" if error.unit == "1" else f" {error.unit}"
        raise InputError(f"mismatch {name}", value, f"a number from {error.low:g} to {error.high:g}{unit}")
    return msgspec.structs.replace(mismatch, **{name: float(value)})


def changes(before: Mismatch, after: Mismatch) -> list[tuple[str, float]]:
    """Names and new values of the entries in which one mismatch differs from another."""
    values = [(name, getattr(after, name)) for name in Mismatch.__struct_fields__]
    return [(name, value) for name, value in values if value != getattr(before, name)]


def real_robot(believed: RobotModel, mismatch: Mismatch) -> RobotModel:
    """The robot that is simulated where the controller believes in another; that one itself if they are alike."""
    differences = 1.0 + mismatch.mass_error, mismatch.torque_scale, mismatch.joint_friction
    return believed if differences == (1.0, 1.0, 0.0) else _altered(believed, *differences)


@lru_cache(maxsize=4)
def _altered(believed: RobotModel, inertia: float, effort: float, friction: float) -> RobotModel:
    """Worlds are built anew often, and always for the same few robots."""
    return believed.altered(inertia, effort, friction)


def _declared(name: str, meta: Any) -> ModelError:
    unit, step = meta.extra["unit"], meta.extra["step"]
    return ModelError(name, getattr(EXACT, name), unit, meta.ge, meta.le, step, meta.description)
