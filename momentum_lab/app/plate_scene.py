"""The plates under the feet as boxes, where the ground is not the floor."""

from __future__ import annotations

from typing import Any

import numpy as np
import pinocchio as pin

from momentum_lab.app.viewer import Viewer
from momentum_lab.robot.model import RobotModel

_THICKNESS = 0.02
# A plate under one foot is so much longer and wider than its sole; one under all feet has this size, m.
_RIM = 0.05
_PLATFORM = (0.9, 0.9)
_FIRM, _SLIPPERY = (186, 176, 158), (150, 196, 224)
# Ground with less friction than this looks like ice.
_ICE = 0.35
# A plate level with the floor lies so far above it, m: more than a browser's depth can confuse, less than any mark.
_ABOVE = 0.001
# Planes that differ by less than this are one, m and rad.
_SAME = 1e-6


class PlateScene:
    """Boxes with their tops where the plates are; none while the robot stands on the floor.

    Args:
        client: the browser tab.
        robot: whose feet they are under.
        root: name of the node that everything hangs below; empty: the world.
    """

    def __init__(self, client: Viewer, robot: RobotModel, root: str = "") -> None:
        self._client, self._root = client, root
        self._sizes = [(sole.upper - sole.lower + 2.0 * _RIM).tolist() for sole in robot.soles]
        self._middles = [np.append((sole.lower + sole.upper) / 2.0, 0.0) for sole in robot.soles]
        self._boxes: list[Any] = []
        self._shown: object = None
        self._drawn: np.ndarray | None = None

    def draw(self, poses: np.ndarray, friction: tuple[float, ...], uneven: bool) -> None:
        """Put the boxes where the plates are.

        Args:
            poses: of the plates (F, 7), m and quaternions xyzw.
            friction: Coulomb coefficient of each.
            uneven: whether the ground is anything but the floor.
        """
        one = len(set(friction)) == 1 and on_one_plane(poses)
        shown = (uneven, one, friction)
        if shown != self._shown:
            self._build(shown)
        if self._boxes and not np.array_equal(poses, self._drawn if self._drawn is not None else ()):
            self._drawn = poses.copy()
            for foot, box in enumerate(self._boxes):
                plate, middle = pin.XYZQUATToSE3(poses[foot]), self._middles[foot]
                if one:
                    middle = plate.actInv(poses[:, :3].mean(axis=0))
                self._place(box, plate, middle)

    def remove(self) -> None:
        """Take all boxes away."""
        for box in self._boxes:
            box.remove()
        self._boxes, self._drawn, self._shown = [], None, None

    def _build(self, shown: tuple[bool, bool, tuple[float, ...]]) -> None:
        self.remove()
        self._shown = shown
        uneven, one, friction = shown
        if not uneven:
            return
        sizes = [_PLATFORM] if one else self._sizes
        for i, (length, width) in enumerate(sizes):
            self._boxes.append(
                self._client.scene.add_box(
                    f"{self._root}/plates/{i}",
                    color=_SLIPPERY if friction[i] < _ICE else _FIRM,
                    dimensions=(length, width, _THICKNESS),
                    opacity=0.75,
                )
            )

    def _place(self, box: Any, plate: pin.SE3, middle: np.ndarray) -> None:
        """Put the top of a box onto a plate, its middle over a point of it (3,)."""
        x, y, z, w = pin.Quaternion(plate.rotation).coeffs().tolist()
        box.position = plate.act(middle + np.array([0.0, 0.0, _ABOVE - _THICKNESS / 2.0]))
        box.wxyz = (w, x, y, z)


def on_one_plane(poses: np.ndarray) -> bool:
    """Whether plates with poses (F, 7) could be one."""
    first = pin.XYZQUATToSE3(poses[0])
    others = [first.actInv(pin.XYZQUATToSE3(pose)) for pose in poses[1:]]
    return all(
        abs(other.translation[2]) < _SAME and np.abs(other.rotation - np.eye(3)).max() < _SAME
        for other in others
    )
