"""Robots that are loaded once for all browser tabs: the model and its meshes."""

from __future__ import annotations

import threading
from dataclasses import dataclass

from momentum_lab.app.coarse import coarse
from momentum_lab.recording import Layout
from momentum_lab.robot.geometry import LinkMesh, visual_meshes
from momentum_lab.robot.model import RobotModel


@dataclass(frozen=True, slots=True)
class LoadedRobot:
    """A robot as the drawing needs it; whoever moves it uses Pinocchio data of their own.

    Attributes:
        model: the robot.
        meshes: what it looks like.
        layout: how its samples are laid out.
    """

    model: RobotModel
    meshes: tuple[LinkMesh, ...]
    layout: Layout

    @classmethod
    def of(cls, model: RobotModel, cell: float = 0.0) -> LoadedRobot:
        """A robot with its meshes.

        Args:
            model: the robot.
            cell: details smaller than this are drawn together, m; 0: none are.

        Raises:
            RobotError: a mesh is missing.
        """
        return cls(model, coarse(visual_meshes(model), cell), Layout.of(model))


class RobotShelf:
    """Loads each robot when it is asked for the first time.

    Args:
        cell: details of their meshes smaller than this are drawn together, m; 0: none are.
    """

    def __init__(self, cell: float = 0.0) -> None:
        self._cell = cell
        self._lock = threading.Lock()
        self._robots: dict[str, LoadedRobot] = {}

    def get(self, name: str) -> LoadedRobot:
        """The robot of that name, or of the file at that path.

        Raises:
            RobotError: there is none, or a mesh is missing.
        """
        with self._lock:
            if name not in self._robots:
                self._robots[name] = LoadedRobot.of(RobotModel.named(name), self._cell)
            return self._robots[name]
