"""Ground, light and the view a browser tab starts with."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import viser

from momentum_lab.app.profile import RenderProfile

_FIELD_OF_VIEW = math.radians(32.0)
# Below this width over height the controls cover the lower part of the picture.
_NARROW = 0.62
_COVERED = 0.62


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


VIEWS = {
    "Whole robot": View(azimuth=-62.0, elevation=11.0, low=-0.12, high=2.05, width=1.5),
    "Feet": View(azimuth=-62.0, elevation=32.0, low=-0.2, high=0.3, width=0.62),
    "Side": View(azimuth=-90.0, elevation=4.0, low=-0.12, high=2.05, width=1.5),
    "Front": View(azimuth=0.0, elevation=8.0, low=-0.12, high=2.05, width=1.5),
}
START_VIEW = "Whole robot"


def add_world(client: viser.ClientHandle, profile: RenderProfile) -> None:
    """Put ground and light into a browser tab's scene."""
    client.scene.configure_default_lights(enabled=True, cast_shadow=profile.shadows)
    if not profile.environment:
        client.scene.configure_environment_map(None)
    client.scene.add_grid(
        "/ground",
        infinite_grid=True,
        fade_distance=14.0,
        fade_strength=1.5,
        cell_size=0.1,
        cell_color=(222, 222, 222),
        cell_thickness=0.6,
        section_size=1.0,
        section_color=(176, 176, 176),
        section_thickness=1.0,
        plane_color=(246, 246, 244),
        plane_opacity=1.0,
        shadow_opacity=0.22,
    )


def look(client: viser.ClientHandle, view: View, size: float, center: np.ndarray) -> None:
    """Turn a browser tab's camera to the robot.

    Args:
        client: the browser tab.
        view: from where.
        size: height of the robot's CoM, m.
        center: a point on the ground below the robot (2,), m.
    """
    target, position = camera_pose(view, size, center, client.camera.aspect)
    client.camera.fov = _FIELD_OF_VIEW
    client.camera.position = position
    client.camera.look_at = target


def camera_pose(view: View, size: float, center: np.ndarray, aspect: float) -> tuple[np.ndarray, np.ndarray]:
    """Target and position (3,) of a camera that sees everything a view wants to show.

    Args:
        view: from where, and how much.
        size: height of the robot's CoM, m.
        center: a point on the ground below the robot (2,), m.
        aspect: width over height of the picture.
    """
    free = 1.0 - _COVERED if aspect < _NARROW else 1.0
    height = max((view.high - view.low) / free, view.width / aspect) * size
    middle = 0.5 * (view.high + view.low) * size
    target = np.array([center[0], center[1], middle - 0.5 * (1.0 - free) * height])
    azimuth, elevation = math.radians(view.azimuth), math.radians(view.elevation)
    distance = 0.5 * height / math.tan(0.5 * _FIELD_OF_VIEW)
    back = np.array(
        [
            math.cos(azimuth) * math.cos(elevation),
            math.sin(azimuth) * math.cos(elevation),
            math.sin(elevation),
        ]
    )
    return target, target + distance * back
