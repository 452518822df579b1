"""Robots that are loaded once for all browser tabs: the model and its meshes."""

from __future__ import annotations

import threading
from dataclasses import dataclass

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
    def of(cls, model: RobotModel) -> LoadedRobot:
        """A robot with its meshes.

        Raises:
            RobotError: a mesh is missing.
        """
        return cls(model, visual_meshes(model), Layout.of(model))


class RobotShelf:
    """Loads each robot when it is asked for the first time."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._robots: dict[str, LoadedRobot] = {}

    def get(self, name: str) -> LoadedRobot:
        """The robot of that name, or of the file at that path.

        Raises:
            RobotError: there is none, or a mesh is missing.
        """
        with self._lock:
            if name not in self._robots:
                self._robots[name] = LoadedRobot.of(RobotModel.named(name))
            return self._robots[name]
