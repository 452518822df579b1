"""The pictures of a finished run in a scene, one after the other."""

from __future__ import annotations

from momentum_lab.app.mark_scene import MarkScene
from momentum_lab.app.overlays import overlays
from momentum_lab.app.plate_scene import PlateScene
from momentum_lab.app.reel import Reel
from momentum_lab.app.robot_scene import EXACTLY, RobotScene
from momentum_lab.app.view_panel import ViewSettings
from momentum_lab.app.viewer import Viewer
from momentum_lab.recording import Sample


class ReelScene:
    """Robot, marks and plates of a finished run.

    Args:
        viewer: where they are drawn.
        reel: the run.
        settings: which marks are drawn, and how.
        root: name of the node that everything hangs below; empty: the world.
    """

    def __init__(self, viewer: Viewer, reel: Reel, settings: ViewSettings, root: str = "") -> None:
        self._reel, self._settings = reel, settings
        first = reel.samples[0]
        self._body = RobotScene(viewer, reel.robot, first["q"], f"{root}/robot", least=EXACTLY)
        self._body.see_through(settings.see_through)
        self._marks = MarkScene(viewer, float(first["com"][2]), root)
        self._plates = PlateScene(viewer, reel.robot.model, root)

    def draw(self, sample: Sample) -> None:
        """Show one of the reel's samples."""
        friction = tuple(self._reel.ground.friction(sample.number("time")).tolist())
        self._plates.draw(sample["ground_pose"], friction, not self._reel.ground.is_floor)
        self._body.draw(sample["q"])
        marks = overlays(sample, self._reel.picture(sample, self._settings.arrow_scale))
        self._marks.draw(marks, self._settings.shown, self._settings.labelled)
