"""From a hand's drag in the picture to a push: pure geometry, no viewer."""

from __future__ import annotations

import math
from dataclasses import dataclass

import msgspec
import numpy as np
import pinocchio as pin

from momentum_lab.app.overlays import PUSH_LENGTH
from momentum_lab.errors import InputError
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.physics.push import MAX_DURATION, Push
from momentum_lab.robot.model import RobotModel

# A view from the side shows nothing of what goes away from it: steeper than this a drag is exact, sine of an angle.
_STEEP = math.sin(math.radians(20.0))
# Weaker pulls than this part of the strongest one are none.
_NOTHING = 0.02
# A held force comes in so many steps up to the strongest, and turns by so many degrees at a time: each is an event.
_STEPS, _TURN = 100, 5.0
# Digits of a grabbed point, m.
_DIGITS = 3


def finite(value: object, count: int, name: str) -> np.ndarray:
    """A browser's numbers (count,).

    Raises:
        InputError: they are no numbers, not finite, or not so many.
    """
    try:
        numbers = np.array(value, dtype=float)
    except (TypeError, ValueError) as error:
        raise InputError(name, value, f"{count} numbers") from error
    if numbers.shape != (count,) or not np.isfinite(numbers).all():
        raise InputError(name, value, f"{count} finite numbers")
    return numbers


def pulled(eye: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """How far a hand has pulled a point over the horizontal plane through it (2,), m.

    With g from the eye to the point and d from the point to the pointer, the pointer's ray meets the plane at
    start + d + s (g + d), s = d_z / (-g_z - d_z). A ray that is nearly level meets it far away or never: the
    denominator stays above that of a view from 20 degrees above.

    Args:
        eye: from where the hand's owner looks (3,), m.
        start: the grabbed point (3,), m.
        end: a point of the pointer's ray (3,), m; viser's is in the plane across the view through the point.
    """
    sight, moved = start - eye, end - start
    least = max(_STEEP * float(np.linalg.norm(sight)), 1e-3)
    further = float(moved[2]) / max(-float(sight[2] + moved[2]), least)
    distance: np.ndarray = (moved + further * (sight + moved))[:2]
    return distance


@dataclass(frozen=True, slots=True)
class Scale:
    """How strong a pull of some length is.

    Attributes:
        newtons_per_metre: that of the arrow with which a push of that force is drawn.
        strongest: longer pulls are not stronger, N.
    """

    newtons_per_metre: float
    strongest: float

    @classmethod
    def of(cls, robot: RobotModel, size: float, arrow_scale: float, strongest: float) -> Scale:
        """That of a robot whose CoM is at a height (m), in a picture with arrows of some length."""
        return cls(robot.mass * GRAVITY / (PUSH_LENGTH * size * arrow_scale), strongest)

    def force(self, distance: np.ndarray) -> np.ndarray:
        """Force of a pull over a distance (2,), both along it, N and m; zero for what is hardly a pull."""
        force = self.newtons_per_metre * distance
        strength = float(np.linalg.norm(force))
        if strength < _NOTHING * self.strongest:
            return np.zeros(2)
        cut: np.ndarray = force * min(1.0, self.strongest / strength)
        return cut

    def length(self, force: np.ndarray) -> np.ndarray:
        """How long the arrow of a force (2,) is, along it, m."""
        return force / self.newtons_per_metre


@dataclass(frozen=True, slots=True)
class Grip:
    """What a hand has taken hold of.

    Attributes:
        body: the push's name for it.
        point: where, in its frame, m.
    """

    body: str
    point: tuple[float, float, float]

    def pulse(self, force: np.ndarray, duration: float) -> Push:
        """A push with a force (2,), N, for a duration, s; whole newtons and degrees, as its sliders have them."""
        return self._push(float(round(float(np.linalg.norm(force)))), _degrees(force, 1.0), duration)

    def piece(self, force: np.ndarray, strongest: float) -> Push:
        """A push to be held, in steps that are small against the strongest one, N: each change is an event."""
        step = strongest / _STEPS
        strength = round(float(np.linalg.norm(force)) / step) * step
        return self._push(min(round(strength, 3), strongest), _degrees(force, _TURN), 1.0)

    def _push(self, force: float, direction_deg: float, duration: float) -> Push:
        return Push(
            force=force, duration=duration, direction_deg=direction_deg, body=self.body, point=self.point
        )


def grip(robot: RobotModel, q: np.ndarray, joint: int, point: np.ndarray) -> Grip:
    """Take hold of what moves with a joint.

    Args:
        robot: the robot.
        q: its configuration (nq,).
        joint: index of the joint; 1 is the free-flyer.
        point: where (3,), in the world, m.
    """
    body, frame = body_of(robot, joint)
    data = robot.model.createData()
    pin.forwardKinematics(robot.model, data, q)
    x, y, z = pin.updateFramePlacement(robot.model, data, frame).actInv(point).round(_DIGITS).tolist()
    return Grip(body, (x, y, z))


def body_of(robot: RobotModel, joint: int) -> tuple[str, int]:
    """A push's name for what moves with a joint, and its frame: a named body where there is one, else the link."""
    for name, link in robot.spec.push_bodies.items():
        if robot.model.frames[robot.frame(link)].parentJoint == joint:
            return name, robot.frame(link)
    frames = enumerate(robot.model.frames)
    return next(
        (frame.name, i)
        for i, frame in frames
        if frame.parentJoint == joint and frame.type == pin.FrameType.BODY
    )


def mean_of(pieces: tuple[Push, ...]) -> Push:
    """One constant push as long as a chain of pieces, with the same impulse."""
    seconds = math.fsum(piece.duration for piece in pieces)
    force = np.sum([piece.impulse * piece.direction[:2] for piece in pieces], axis=0) / seconds
    last = pieces[-1]
    assert last.body is not None
    assert last.point is not None
    return Grip(last.body, last.point).pulse(force, min(round(seconds, 3), MAX_DURATION))


def chain_of(pushes: tuple[Push, ...], step: float = 1e-6) -> tuple[Push, ...]:
    """The last pushes of a run that follow each other at once at the same point: what was held last."""
    chain = list(pushes[-1:])
    for push in pushes[-2::-1]:
        joined = abs(push.start + push.duration - chain[0].start) < step
        if not joined or (push.body, push.point) != (chain[0].body, chain[0].point):
            break
        chain.insert(0, push)
    return tuple(chain)


def from_now(pieces: tuple[Push, ...]) -> tuple[Push, ...]:
    """The same pushes, the first of them at zero."""
    first = pieces[0].start
    return tuple(msgspec.structs.replace(piece, start=piece.start - first) for piece in pieces)


def _degrees(force: np.ndarray, step: float) -> float:
    """Direction of a force (2,) to so many degrees; 0 forward, 90 to the left."""
    degrees = math.degrees(math.atan2(float(force[1]), float(force[0])))
    return round(degrees / step) * step
