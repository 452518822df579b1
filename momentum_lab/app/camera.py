"""From where a browser tab looks at the robot, and how the view goes along when the robot does."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import viser

FIELD_OF_VIEW = math.radians(32.0)
# Below this width over height the controls cover the lower part of the picture.
_NARROW = 0.62
_COVERED = 0.62
# In a window that is lower than the panels below its picture need, so much of the picture is taken to be free.
_LEAST_FREE = 0.35
# From here two robots that stand side by side are seen beside each other, degrees.
_AZIMUTH_OF_TWO = -42.0
# Views whose name says from where: two robots are seen from there, too, degrees.
_FIXED = (0.0, -90.0, 180.0)
# Beside two robots there is room for one that lies on the ground, in CoM heights.
_ROOM_TO_FALL = 0.7
# A picture whose width over height differs by more than this has another shape.
_OTHER_SHAPE = 0.03
# How far the robot may move before the view goes along, in CoM heights: while it stands, and when it has fallen.
LOOSE, TIGHT = 0.35, 0.05


@dataclass(frozen=True, slots=True)
class View:
    """Where a camera stands, for a robot whose CoM is one metre high and above the origin.

    Attributes:
        azimuth: from where it looks, degrees about the vertical; 0 from the front, 90 from the robot's left.
        elevation: how far from above, degrees.
        low: height of the lowest thing to see, m.
        high: height of the highest thing to see, m.
        width: width of what is to be seen, m.
    """

    azimuth: float
    elevation: float
    low: float
    high: float
    width: float


@dataclass(frozen=True, slots=True)
class Opening:
    """The part of a picture that nothing covers.

    Attributes:
        aspect: width over height of the whole picture.
        free: how much of its height can be seen, from its upper edge, 0 to 1.
    """

    aspect: float
    free: float = 1.0

    @classmethod
    def of(cls, client: viser.ClientHandle, covered: float) -> Opening:
        """Of a browser tab, as it tells itself.

        Args:
            client: the browser tab.
            covered: how much of the picture a bar covers, pixels.
        """
        width, height = client.camera.image_width, client.camera.image_height
        if not (width > 0 and height > 0):
            return USUAL
        aspect = width / height
        return cls(aspect, 1.0 - _COVERED if aspect < _NARROW else max(_LEAST_FREE, 1.0 - covered / height))


USUAL = Opening(1.5)
VIEWS = {
    "Whole robot": View(azimuth=-62.0, elevation=11.0, low=-0.12, high=2.05, width=1.5),
    "Feet": View(azimuth=-62.0, elevation=32.0, low=-0.2, high=0.3, width=0.62),
    "Side": View(azimuth=-90.0, elevation=4.0, low=-0.12, high=2.05, width=1.5),
    "Front": View(azimuth=0.0, elevation=8.0, low=-0.12, high=2.05, width=1.5),
    # Forward is up.
    "Above": View(azimuth=180.0, elevation=78.0, low=0.3, high=1.7, width=1.5),
}
START_VIEW = "Whole robot"


@dataclass(frozen=True, slots=True)
class Seat:
    """From where a person looked, to be taken again.

    Attributes:
        position: of the camera (3,), m.
        look_at: what it looks at (3,), m.
        field_of_view: vertical, rad.
        center: the point on the ground that it goes along with (2,), m.
        looked: how two robots were looked at.
    """

    position: np.ndarray
    look_at: np.ndarray
    field_of_view: float
    center: np.ndarray
    looked: tuple[str, np.ndarray, float] | None


class Camera:
    """The camera of one browser tab; people may turn it at any time.

    Args:
        client: the browser tab.
        size: height of the robot's CoM, m.
        covered: how much of the lower part of the picture a bar covers, pixels.
    """

    def __init__(self, client: viser.ClientHandle, size: float, covered: float = 0.0) -> None:
        self._client, self._size, self._covered = client, size, covered
        self._center = np.zeros(2)
        # How two robots were last looked at: which view, their distance, the shape of the picture.
        self._looked: tuple[str, np.ndarray, float] | None = None

    @property
    def opening(self) -> Opening:
        """What of the picture can be seen now."""
        return Opening.of(self._client, self._covered)

    def look(self, name: str, center: np.ndarray, spread: np.ndarray | None = None) -> None:
        """Take a named view.

        Args:
            name: of the view.
            center: a point on the ground below the robot, or between two (2,), m.
            spread: from one robot to the other, if there are two (2,), m.
        """
        view, opening = VIEWS[name], self.opening
        self._looked = None if spread is None else (name, spread, opening.aspect)
        if spread is not None:
            view = of_two(view, spread / self._size)
        target, position = camera_pose(view, self._size, center, opening)
        self._center = center
        self._client.camera.fov = FIELD_OF_VIEW
        self._client.camera.position = position
        self._client.camera.look_at = target

    def turn(self, degrees: float, spread: np.ndarray | None) -> None:
        """Look from so far round the start view, at the place that is looked at anyway.

        Args:
            degrees: about the vertical.
            spread: from one robot to the other, if there are two (2,), m.
        """
        view, center = VIEWS[START_VIEW], self._center
        if spread is not None:
            view = of_two(view, spread / self._size)
        turned = replace(view, azimuth=view.azimuth + degrees)
        target, position = camera_pose(turned, self._size, center, self.opening)
        self._client.camera.position = position
        self._client.camera.look_at = target

    def seat(self) -> Seat:
        """From where is looked now."""
        camera = self._client.camera
        return Seat(
            np.array(camera.position), np.array(camera.look_at), camera.fov, self._center, self._looked
        )

    def take(self, seat: Seat) -> None:
        """Look from there again."""
        self._center, self._looked = seat.center, seat.looked
        self._client.camera.fov = seat.field_of_view
        self._client.camera.position = seat.position
        self._client.camera.look_at = seat.look_at

    def follow(self, center: np.ndarray, leash: float) -> None:
        """Go along with a robot that gets out of the picture.

        Args:
            center: a point on the ground below the robot (2,), m.
            leash: how far it may go, in CoM heights.
        """
        if self._looked is not None and abs(self._looked[2] - self.opening.aspect) > _OTHER_SHAPE:
            self.look(
                self._looked[0], center, self._looked[1]
            )  # a panel has been docked: both must fit again
        way = center - self._center
        distance = float(np.linalg.norm(way))
        slack = leash * self._size
        position = self._client.camera.position
        if not distance > slack or not np.isfinite(position).all():
            return
        step = way * (1.0 - slack / distance)
        self._center = self._center + step
        self._client.camera.position = position + np.append(step, 0.0)


def of_two(view: View, spread: np.ndarray) -> View:
    """The view for two robots: from where they do not hide each other, and wide enough for both.

    Args:
        view: of one robot.
        spread: from one robot to the other (2,), in CoM heights.
    """
    azimuth = view.azimuth if view.azimuth in _FIXED else _AZIMUTH_OF_TWO
    across = np.array([-math.sin(math.radians(azimuth)), math.cos(math.radians(azimuth))])
    return replace(view, azimuth=azimuth, width=view.width + _ROOM_TO_FALL + abs(float(across @ spread)))


def wide_enough(view: View, way: np.ndarray) -> View:
    """The view for a robot that goes some way.

    Args:
        view: of a robot that stands.
        way: from one end to the other (2,), in CoM heights.
    """
    return replace(view, width=view.width + float(np.linalg.norm(way)))


def camera_pose(
    view: View, size: float, center: np.ndarray, opening: Opening
) -> tuple[np.ndarray, np.ndarray]:
    """Target and position (3,) of a camera that sees everything a view wants to show.

    Args:
        view: from where, and how much.
        size: height of the robot's CoM, m.
        center: a point on the ground below the robot (2,), m.
        opening: what of the picture can be seen.
    """
    free = opening.free
    height = max((view.high - view.low) / free, view.width / opening.aspect) * size
    middle = 0.5 * (view.high + view.low) * size
    target = np.array([center[0], center[1], middle - 0.5 * (1.0 - free) * height])
    azimuth, elevation = math.radians(view.azimuth), math.radians(view.elevation)
    distance = 0.5 * height / math.tan(0.5 * FIELD_OF_VIEW)
    back = np.array(
        [
            math.cos(azimuth) * math.cos(elevation),
            math.sin(azimuth) * math.cos(elevation),
            math.sin(elevation),
        ]
    )
    return target, target + distance * back
