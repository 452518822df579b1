"""The plates under the feet as boxes, where the ground is not the floor."""

from __future__ import annotations

from typing import Any

import numpy as np
import pinocchio as pin
import viser

from momentum_lab.robot.model import RobotModel

_THICKNESS = 0.02
# A plate under one foot is so much longer and wider than its sole; one under all feet has this size, m.
_RIM = 0.05
_PLATFORM = (0.9, 0.9)
_FIRM, _SLIPPERY = (186, 176, 158), (150, 196, 224)
# Ground with less friction than this looks like ice.
_ICE = 0.35


class PlateScene:
    """Boxes with their tops where the plates are; none while the robot stands on the floor.

    Args:
        client: the browser tab.
        robot: whose feet they are under.
    """

    def __init__(self, client: viser.ClientHandle, robot: RobotModel) -> None:
        self._client = client
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
        one = bool(np.array_equal(poses, np.tile(poses[0], (len(poses), 1)))) and len(set(friction)) == 1
        shown = (uneven, one, friction)
        if shown != self._shown:
            self._build(shown)
        if self._boxes and not np.array_equal(poses, self._drawn if self._drawn is not None else ()):
            self._drawn = poses.copy()
            for foot, box in enumerate(self._boxes):
                self._place(box, pin.XYZQUATToSE3(poses[foot]), np.zeros(3) if one else self._middles[foot])

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
                    f"/plates/{i}",
                    color=_SLIPPERY if friction[i] < _ICE else _FIRM,
                    dimensions=(length, width, _THICKNESS),
                    opacity=0.75,
                )
            )

    def _place(self, box: Any, plate: pin.SE3, middle: np.ndarray) -> None:
        """Put the top of a box onto a plate, its middle over a point of it (3,)."""
        x, y, z, w = pin.Quaternion(plate.rotation).coeffs().tolist()
        box.position = plate.act(middle - np.array([0.0, 0.0, _THICKNESS / 2.0]))
        box.wxyz = (w, x, y, z)
