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


@dataclass(frozen=True, slots=True)
class Eye:
    """From where a browser tab looks.

    Attributes:
        position: in the world (3,), m.
        rotation: its axes in the world (3, 3): x to the right of the picture, y down, z into it.
    """

    position: np.ndarray
    rotation: np.ndarray

    @classmethod
    def of(cls, position: object, wxyz: object) -> Eye:
        """One at a position (3,), m, turned by a quaternion (4,).

        Raises:
            InputError: a browser says what is no position or no rotation.
        """
        w, x, y, z = finite(wxyz, 4, "camera")
        if math.hypot(w, x, y, z) < 1e-6:
            raise InputError("camera", (w, x, y, z), "a quaternion")
        turned = pin.Quaternion(w, x, y, z).normalized().toRotationMatrix()
        return cls(finite(position, 3, "camera"), turned)


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


def pulled(eye: Eye, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """How far a hand has pulled a point over the horizontal plane through it (2,), m.

    The pointer's ray meets that plane at start + a (1 + F/D cos p) r + F f with F = b / (sin p - b/D cos p), where
    a and b are how far the pointer has moved to the right and up in the plane across the view through the point,
    D is how deep that plane lies, p how far the view points down, r the picture's right and f its forward. For a
    flat view F is limited.

    Args:
        eye: from where the hand's owner looks.
        start: the grabbed point (3,), m.
        end: the pointer in the plane across the view through that point (3,), m.
    """
    right, up, into = eye.rotation[:, 0], -eye.rotation[:, 1], eye.rotation[:, 2]
    forward = into[:2] + up[:2]
    forward = forward / max(float(np.linalg.norm(forward)), 1e-9)
    depth = max(float((start - eye.position) @ into), 1e-3)
    down, level = -float(into[2]), float(np.linalg.norm(into[:2]))
    a, b = float((end - start) @ right), float((end - start) @ up)
    away = b / max(down - b / depth * level, _STEEP)
    aside = a * max(0.0, 1.0 + away / depth * level)
    distance: np.ndarray = aside * right[:2] + away * forward
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
