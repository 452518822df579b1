"""What one robot of a browser tab is drawn with: its meshes, its marks, the plates under its feet, and the camera."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import viser

from momentum_lab.app.camera import Camera
from momentum_lab.app.mark_scene import MarkScene
from momentum_lab.app.overlays import Picture, overlays
from momentum_lab.app.plate_scene import PlateScene
from momentum_lab.app.robot_scene import RobotScene
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.view_panel import ViewSettings
from momentum_lab.app.wire import Truth
from momentum_lab.recording import Sample


@dataclass(frozen=True, slots=True)
class Stage:
    """What one robot of one browser tab is drawn with.

    Attributes:
        name: which robot.
        loaded: the robot.
        body: its meshes in the scene.
        marks: its marks in the scene.
        plates: the plates under its feet.
        camera: what looks at it.
        size: height of its CoM as it began, m.
    """

    name: str
    loaded: LoadedRobot
    body: RobotScene
    marks: MarkScene
    plates: PlateScene
    camera: Camera
    size: float

    @classmethod
    def of(
        cls,
        client: viser.ClientHandle,
        name: str,
        loaded: LoadedRobot,
        q: np.ndarray,
        size: float,
        covered: float,
    ) -> Stage:
        """A robot as it comes into the scene.

        Args:
            client: the browser tab.
            name: which robot.
            loaded: the robot.
            q: its configuration (nq,).
            size: height of its CoM, m.
            covered: how much of the lower part of the picture a bar covers, pixels.
        """
        return cls(
            name,
            loaded,
            RobotScene(client, loaded, q),
            MarkScene(client, size),
            PlateScene(client, loaded.model),
            Camera(client, size, covered),
            size,
        )

    def draw(self, truth: Truth, sample: Sample, settings: ViewSettings, labelled: frozenset[str]) -> None:
        """Draw the robot, what is under its feet, and its marks.

        Args:
            truth: what is the case.
            sample: of the robot.
            settings: what a person has chosen to see.
            labelled: keys of the marks that have a label.
        """
        border = truth.gains.get("safe_border", 0.0)
        picture = Picture(self.loaded.model, truth.push, border, settings.arrow_scale)
        self.marks.paint(settings.theme)
        self.plates.draw(sample["ground_pose"], truth.friction, truth.uneven)
        self.body.draw(sample["q"])
        self.marks.draw(overlays(sample, picture), settings.shown, labelled)

    def remove(self) -> None:
        """Leave the scene."""
        self.body.remove()
        self.marks.remove()
        self.plates.remove()
