"""The pictures of a finished run in a scene, one after the other."""

from __future__ import annotations

import numpy as np

from momentum_lab.app.mark_scene import MarkScene
from momentum_lab.app.marks import FEW_LABELS
from momentum_lab.app.overlays import overlays
from momentum_lab.app.plate_scene import PlateScene
from momentum_lab.app.reel import Reel, Side
from momentum_lab.app.robot_scene import EXACTLY, RobotScene
from momentum_lab.app.side_scene import LABELLED, NamePlate
from momentum_lab.app.view_panel import ViewSettings
from momentum_lab.app.viewer import Viewer


class ReelScene:
    """Robot, marks and plates of a finished run, and the robot beside it.

    Args:
        viewer: where they are drawn.
        reel: the run.
        settings: which marks are drawn, and how.
        root: name of the node that everything hangs below; empty: the world.
    """

    def __init__(self, viewer: Viewer, reel: Reel, settings: ViewSettings, root: str = "") -> None:
        few = settings.labelled if reel.side is None else settings.labelled & FEW_LABELS
        self._first = _OneScene(viewer, reel, settings, few, root)
        self._side = None if reel.side is None else _SideScene(viewer, reel, reel.side, settings, root)

    def draw(self, picture: int) -> None:
        """Show one of the reel's pictures."""
        self._first.draw(picture)
        if self._side is not None:
            self._side.draw(picture)


class _OneScene:
    """One robot with its marks and plates."""

    def __init__(
        self, viewer: Viewer, reel: Reel, settings: ViewSettings, labelled: frozenset[str], root: str
    ) -> None:
        self._reel, self._settings, self._labelled = reel, settings, labelled
        self.samples = reel.samples
        first = self.samples[0]
        self._body = RobotScene(viewer, reel.robot, first["q"], f"{root}/robot", least=EXACTLY)
        self._body.see_through(settings.see_through)
        self._marks = MarkScene(viewer, float(first["com"][2]), root)
        self._plates = PlateScene(viewer, reel.robot.model, root)

    def draw(self, picture: int) -> None:
        sample = self.samples[picture]
        friction = tuple(self._reel.ground.friction(sample.number("time")).tolist())
        self._plates.draw(sample["ground_pose"], friction, not self._reel.ground.is_floor)
        self._body.draw(sample["q"])
        marks = overlays(sample, self._reel.picture(sample, self._settings.arrow_scale))
        self._marks.draw(marks, self._settings.shown, self._labelled)


class _SideScene:
    """The robot beside the first, from when it was there, and the names of both."""

    def __init__(self, viewer: Viewer, first: Reel, side: Side, settings: ViewSettings, root: str) -> None:
        self._side, self._firsts = side, first.samples
        size = float(self._firsts[0]["com"][2])
        root_of_side = f"{root}/beside"
        self._node = viewer.scene.add_frame(
            root_of_side, position=np.append(side.offset, 0.0), show_axes=False, visible=False
        )
        few = settings.labelled & LABELLED
        self._scene = _OneScene(viewer, side.reel, settings, few, root_of_side)
        self._names = [NamePlate(viewer, f"{name}/name", size) for name in (root, root_of_side)]

    def draw(self, picture: int) -> None:
        if picture < self._side.since:
            return
        if picture == self._side.since:
            self._node.visible = True
        self._scene.draw(picture)
        samples = (self._firsts[picture], self._scene.samples[picture])
        for plate, name, sample in zip(self._names, self._side.names, samples, strict=True):
            plate.draw(name, sample["com"])
