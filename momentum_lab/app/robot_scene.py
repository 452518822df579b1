"""The robot in the scene: a tree of joint frames that carries its meshes. Only joints that have moved are sent."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pinocchio as pin

from momentum_lab.app.body_look import opacity_in, tinted
from momentum_lab.app.marks import Theme
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.viewer import Viewer
from momentum_lab.palette import Color

_FREE_FLYER = 1


@dataclass(frozen=True, slots=True)
class Least:
    """The smallest motion that is sent.

    Attributes:
        angle: of a joint, rad.
        place: of the base, m.
    """

    angle: float
    place: float


ON_SCREEN = Least(angle=6e-4, place=2e-4)
"""Less than this does not show."""
EXACTLY = Least(angle=0.0, place=0.0)
"""What is kept may be measured later."""


class RobotScene:
    """One robot in one browser tab.

    Args:
        client: the browser tab.
        robot: the robot.
        q: its configuration (nq,).
        root: name of the node that everything hangs below.
        color: of all its meshes, red, green, blue, 0 to 255; None: their own.
        least: the smallest motion that is sent.

    Attributes:
        there: whether it is still in the scene.
    """

    def __init__(
        self,
        client: Viewer,
        robot: LoadedRobot,
        q: np.ndarray,
        root: str = "/robot",
        color: Color | None = None,
        least: Least = ON_SCREEN,
    ) -> None:
        self._root, self._least = root, least
        self._color = color
        self._theme: Theme = "light"
        self._model = robot.model.model
        self._data = self._model.createData()
        pin.forwardKinematics(self._model, self._data, q)
        self._drawn = q.copy()
        self._positions: dict[int, tuple[float, ...]] = {}
        self._frames = self._add_frames(client)
        self._parts = robot.meshes
        self.there = True
        self._meshes = [
            client.scene.add_mesh_simple(
                f"{self._frames[mesh.joint].name}/mesh_{i}",
                mesh.vertices,
                mesh.faces,
                color=mesh.color if color is None else color,
            )
            for i, mesh in enumerate(robot.meshes)
        ]

    @property
    def place_on_ground(self) -> np.ndarray:
        """Where the robot is, seen from above (2,), m."""
        return self._drawn[:2].copy()

    @property
    def drawn(self) -> np.ndarray:
        """The configuration that is drawn (nq,)."""
        return self._drawn.copy()

    def on_drag(self, note: Callable[[int, Any], Awaitable[None]], modifier: str | None) -> None:
        """Let a hand drag any part of the robot, and no longer as it could before.

        Args:
            note: is told which joint the part moves with, and viser's event.
            modifier: the key that it holds down; without it a drag turns the picture. None: no key.
        """
        for mesh, handle in zip(self._parts, self._meshes, strict=True):
            handle.remove_drag_callback("all")
            _listen(handle, mesh.joint, note, modifier)

    def draw(self, q: np.ndarray) -> None:
        """Move to a configuration (nq,)."""
        if not np.isfinite(q).all():
            return
        angles = np.flatnonzero(np.abs(q[7:] - self._drawn[7:]) > self._least.angle)
        base = np.abs(q[:7] - self._drawn[:7])
        moved = [self._joint_of(i) for i in angles]
        if base[:3].max() > self._least.place or base[3:].max() > 0.5 * self._least.angle:
            moved.append(_FREE_FLYER)
            self._drawn[:7] = q[:7]
        if not moved:
            return
        self._drawn[7 + angles] = q[7 + angles]
        pin.forwardKinematics(self._model, self._data, self._drawn)
        for joint in moved:
            self._place(joint, self._frames[joint])

    def see_through(self, on: bool, theme: Theme = "light") -> None:
        """Whether the marks inside the body show, on a light or a dark page."""
        for mesh in self._meshes:
            mesh.opacity = opacity_in(theme) if on else None
        self._paint(theme)

    def _paint(self, theme: Theme) -> None:
        """Have the colours of a light or a dark page; a body of one colour keeps it."""
        if theme != self._theme and self._color is None:
            self._theme = theme
            for part, mesh in zip(self._parts, self._meshes, strict=True):
                mesh.color = tinted(part.color, theme)

    def fade(self, opacity: float) -> None:
        """Let the body be a part of what it was, from 0 to 1."""
        for mesh in self._meshes:
            mesh.opacity = opacity

    def show(self, visible: bool) -> None:
        """Appear or disappear."""
        self._frames[_FREE_FLYER].visible = visible

    def remove(self) -> None:
        """Take the robot out of the scene."""
        self.there = False
        self._frames[_FREE_FLYER].remove()

    def _joint_of(self, angle: int) -> int:
        """Index of the joint that an actuated angle belongs to: one each, after the universe and the base."""
        return int(angle) + 2

    def _add_frames(self, client: Viewer) -> dict[int, Any]:
        """One frame per joint, below that of its parent."""
        frames: dict[int, Any] = {}
        for joint in range(_FREE_FLYER, self._model.njoints):
            parent = frames.get(int(self._model.parents[joint]))
            name = f"{self._root if parent is None else parent.name}/{joint}"
            frames[joint] = client.scene.add_frame(name, show_axes=False)
            self._place(joint, frames[joint])
        return frames

    def _place(self, joint: int, frame: Any) -> None:
        """Put a joint's frame where it is in that of its parent."""
        placement = self._data.liMi[joint]
        x, y, z, w = pin.Quaternion(placement.rotation).coeffs().tolist()
        frame.wxyz = (w, x, y, z)
        position = tuple(placement.translation.tolist())
        if self._positions.get(joint) != position:  # most joints only turn, and viser is slow to notice that
            self._positions[joint] = frame.position = position


def _listen(
    handle: Any, joint: int, note: Callable[[int, Any], Awaitable[None]], modifier: str | None
) -> None:
    async def dragged(event: Any) -> None:
        await note(joint, event)

    handle.on_drag("left", modifier=modifier)(dragged)
