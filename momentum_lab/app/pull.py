"""From a hand's drag in the picture to a push: pure geometry, no viewer."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from momentum_lab.app.overlays import PUSH_LENGTH
from momentum_lab.errors import InputError
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.physics.push import MAX_FORCE, Push
from momentum_lab.robot.model import RobotModel

# A view from the side shows nothing of what goes away from it: steeper than this a drag is exact, sine of an angle.
_STEEP = math.sin(math.radians(20.0))
# Weaker pulls than this part of the strongest one are none.
_NOTHING = 0.02
# Further than this from where it began a hand has been away, nearer than that it is back, in heights of the picture.
_AWAY, _BACK = 0.05, 0.025
# A held force comes in so many steps up to the strongest, and turns by so many degrees at a time: each is an event.
_STEPS, _TURN = 100, 5.0
# A push that stands for several points where they do to so many degrees.
_EXACT = 1e-3
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
    """How far a hand has pulled a point over the horizontal plane through it (3,), m; z is 0.

    With g from the eye to the point and d from the point to the pointer, the pointer's ray meets the plane at
    start + d + s (g + d), s = d_z / (-g_z - d_z). A ray that is nearly level meets it far away or never: the
    denominator stays above that of a view from 20 degrees above.

    Args:
        eye: from where the hand's owner looks (3,), m.
        start: the grabbed point (3,), m.
        end: a point of the pointer's ray (3,), m; viser's is in the plane across the view through the point.
    """
    down = np.array([0.0, 0.0, -1.0])
    return _over_plane(start - eye, end - start, down)


def lifted(eye: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """How far a hand has pulled a point up, down or sideways (3,), m: over the upright plane that faces the eye.

    As `pulled`, with the unit vector over the ground away from the eye in place of the vertical.

    Args:
        eye: from where the hand's owner looks (3,), m.
        start: the grabbed point (3,), m.
        end: a point of the pointer's ray (3,), m.
    """
    sight = start - eye
    level = float(np.hypot(sight[0], sight[1]))
    away = np.array([sight[0], sight[1], 0.0]) / level if level > 0.0 else np.array([1.0, 0.0, 0.0])
    return _over_plane(sight, end - start, away)


def _over_plane(sight: np.ndarray, moved: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """From a point to where the pointer's ray meets a plane through it (3,), m, and nothing across the plane.

    Args:
        sight: from the eye to the point (3,), m.
        moved: from the point to some point of the ray (3,), m.
        normal: of the plane, a unit vector away from the eye (3,).
    """
    least = max(_STEEP * float(np.linalg.norm(sight)), 1e-3)
    further = -float(moved @ normal) / max(float((sight + moved) @ normal), least)
    distance: np.ndarray = moved + further * (sight + moved)
    return distance - float(distance @ normal) * normal


@dataclass(frozen=True, slots=True)
class Drag:
    """How far a drag has come.

    Attributes:
        start: the grabbed point (3,), m.
        end: a point of the pointer's ray (3,), m.
        eye: from where the hand's owner looks (3,), m.
        off: from where the pointer began to where it is, in heights of the picture.
    """

    start: np.ndarray
    end: np.ndarray
    eye: np.ndarray
    off: float

    @classmethod
    def checked(cls, places: tuple[object, object, object], on_screen: tuple[object, object, object]) -> Drag:
        """One that a browser has told.

        Args:
            places: start, end and eye, in the world.
            on_screen: start and end in parts of the picture's width and height, and its size.

        Raises:
            InputError: something in it is no finite number, or the picture has no size.
        """
        start, end = (finite(place, 3, "drag") for place in places[:2])
        began, now = (finite(place, 2, "drag") for place in on_screen[:2])
        size = finite(on_screen[2], 2, "picture")
        if size.min() <= 0.0:
            raise InputError("picture", on_screen[2], "a width and a height above 0")
        off = float(np.linalg.norm((now - began) * size / size[1]))
        return cls(start, end, finite(places[2], 3, "camera"), off)


@dataclass(slots=True)
class WayBack:
    """Whether a hand that has left the place where it began is back there: so a pull is given up.

    A hand that has not left it yet may pull as gently as it likes.

    Attributes:
        left: whether it has been away.
    """

    left: bool = False

    def go(self, off: float) -> None:
        """Take note that the hand has been so far from there, in heights of the picture."""
        self.left = self.left or off > _AWAY

    def is_back(self, off: float) -> bool:
        """Whether a hand so far from there, in heights of the picture, has been away and is back."""
        self.go(off)
        return self.left and off < _BACK


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
        """Force of a pull over a distance (3,), both along it, N and m; zero for what is hardly a pull."""
        force = self.newtons_per_metre * distance
        strength = float(np.linalg.norm(force))
        if strength < _NOTHING * self.strongest:
            return np.zeros(3)
        cut: np.ndarray = force * min(1.0, self.strongest / strength)
        return cut

    def length(self, force: np.ndarray) -> np.ndarray:
        """How long the arrow of a force (3,) is, along it, m."""
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
        """A push with a force (3,), N, for a duration, s; whole newtons and degrees, as its sliders have them."""
        return self._push(float(round(float(np.linalg.norm(force)))), force, 1.0, duration)

    def push(self, impulse: np.ndarray, duration: float) -> Push:
        """A constant push that gives an impulse (3,), N s, in a duration, s, as exactly as a push can be."""
        strength = min(float(np.linalg.norm(impulse)) / duration, MAX_FORCE)
        return self._push(strength, impulse, _EXACT, duration)

    def piece(self, force: np.ndarray, strongest: float) -> Push:
        """A push to be held, in steps that are small against the strongest one, N: each change is an event."""
        step = strongest / _STEPS
        strength = round(float(np.linalg.norm(force)) / step) * step
        return self._push(min(round(strength, 3), strongest), force, _TURN, 1.0)

    def _push(self, strength: float, along: np.ndarray, step: float, duration: float) -> Push:
        x, y, z = along.tolist()
        return Push(
            force=strength,
            duration=duration,
            direction_deg=_degrees(y, x, step),
            elevation_deg=_degrees(z, math.hypot(x, y), step),
            body=self.body,
            point=self.point,
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


def _degrees(y: float, x: float, step: float) -> float:
    """Direction of (x, y) to so many degrees, from x towards y."""
    return round(math.degrees(math.atan2(y, x)) / step) * step
