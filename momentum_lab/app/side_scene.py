"""The robot beside the first in the scene, and the names that tell the two apart."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import viser

from momentum_lab.app.mark_scene import MarkScene
from momentum_lab.app.overlays import Picture, overlays
from momentum_lab.app.plate_scene import PlateScene
from momentum_lab.app.robot_scene import RobotScene
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.view_panel import ViewSettings
from momentum_lab.app.viewer import Viewer
from momentum_lab.app.wire import Truth
from momentum_lab.recording import Sample

_ROOT = "/beside"
# How far to the left of the first robot the second one is drawn, and how far above its CoM its name, in CoM heights.
_APART, _ABOVE = 1.5, 1.08
# And how far at least when it has fallen, in heights of the CoM of a standing robot.
_LOWEST = 0.35
# Names follow a body that moves further than this, m.
_SAME_PLACE = 5e-3
LABELLED = frozenset({"gap"})
"""The second robot has the labels of what differs; the others would be read twice."""


class SideScene:
    """A second robot in one browser tab.

    Args:
        client: the browser tab.
        robot: the robot.
        sample: where it stands, in the world of the first robot.
    """

    def __init__(self, client: viser.ClientHandle, robot: LoadedRobot, sample: Sample) -> None:
        size = float(sample["com"][2])
        self._loaded, self._com = robot, sample["com"].copy()
        self.offset = to_the_left(size, sample["q"])
        self._node = client.scene.add_frame(_ROOT, position=np.append(self.offset, 0.0), show_axes=False)
        self.body = RobotScene(client, robot, sample["q"], f"{_ROOT}/robot")
        self._marks = MarkScene(client, size, _ROOT)
        self._plates = PlateScene(client, robot.model, _ROOT)
        self._names = [NamePlate(client, "/name", size), NamePlate(client, f"{_ROOT}/name", size)]

    @property
    def place_on_ground(self) -> np.ndarray:
        """Where the second robot is drawn, seen from above (2,), m."""
        return self._com[:2] + self.offset

    def draw(self, sample: Sample, truth: Truth, settings: ViewSettings) -> None:
        """Move to a sample.

        Args:
            sample: the second robot's.
            truth: what is the case with it.
            settings: what a person has chosen to see.
        """
        border = truth.gains.get("safe_border", 0.0)
        picture = Picture(self._loaded.model, truth.push, border, settings.arrow_scale)
        self._plates.draw(sample["ground_pose"], truth.friction, truth.uneven)
        self._com = sample["com"].copy()
        self.body.draw(sample["q"])
        self._marks.paint(settings.theme)
        self._marks.draw(overlays(sample, picture), settings.shown, settings.labelled & LABELLED)

    def name(self, words: tuple[str, str], places: tuple[np.ndarray, np.ndarray]) -> None:
        """Write over both robots what each one is.

        Args:
            words: what to call the first and the second.
            places: their CoMs (3,), each in its own world, m.
        """
        for plate, text, com in zip(self._names, words, places, strict=True):
            plate.draw(text, com)

    def see_through(self, settings: ViewSettings) -> None:
        """Whether the marks inside the body show, as a person has chosen."""
        self.body.see_through(settings.see_through, settings.theme)

    def remove(self) -> None:
        """Leave the scene, with both names."""
        self.body.remove()
        self._marks.remove()
        self._plates.remove()
        for plate in self._names:
            plate.remove()
        self._node.remove()


class NamePlate:
    """Some words above a robot.

    Args:
        client: where they are drawn.
        name: of the node.
        size: height of the robot's CoM, m.
    """

    def __init__(self, client: Viewer, name: str, size: float) -> None:
        self._size = size
        self._at = np.zeros(3)
        self._handle = client.scene.add_label(
            name, "", position=self._at, anchor="bottom-center", font_screen_scale=1.3
        )

    def draw(self, words: str, com: np.ndarray) -> None:
        """Show words above a CoM (3,), m."""
        self._handle.text = words
        above = max(_LOWEST * self._size, _ABOVE * float(com[2]))
        at = com + np.array([0.0, 0.0, above])
        if np.isfinite(at).all() and np.abs(at - self._at).max() > _SAME_PLACE:
            self._at = at
            self._handle.position = tuple(at.tolist())

    def remove(self) -> None:
        """Take the words away."""
        self._handle.remove()


def to_the_left(size: float, q: np.ndarray) -> np.ndarray:
    """From a robot to where the one beside it is drawn, on the ground (2,), m.

    Args:
        size: height of its CoM, m.
        q: its configuration (nq,).
    """
    forward = pin.Quaternion(*q[[6, 3, 4, 5]].tolist()).toRotationMatrix()[:2, 0]
    x, y = forward / np.linalg.norm(forward)
    return _APART * size * np.array([-y, x])
