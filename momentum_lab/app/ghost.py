"""A run that has been kept: its robot goes along as a ghost, in step with the run of now."""

from __future__ import annotations

from dataclasses import dataclass

import viser

from momentum_lab.app.robot_scene import RobotScene
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.story import Story
from momentum_lab.app.wire import Truth
from momentum_lab.palette import SKY

_OPACITY = 0.4


@dataclass(frozen=True, slots=True)
class KeptRun:
    """A run that others are compared with.

    Attributes:
        truth: what was the case at its end.
        loaded: its robot.
        story: its samples; none are added any more.
    """

    truth: Truth
    loaded: LoadedRobot
    story: Story

    def time(self, truth: Truth, simulated: float) -> float:
        """The time of this run that belongs to a time of another: their first pushes begin together.

        Args:
            truth: what is the case in the other run.
            simulated: its time, s.
        """
        return simulated + self.ahead(truth, simulated)

    def ahead(self, truth: Truth, simulated: float) -> float:
        """By how much the time of this run is ahead of that of another, s; until its push, this one waits."""
        if self.truth.first_push is None:
            return 0.0
        if truth.first_push is None:
            return min(0.0, self.truth.first_push.start - simulated)
        return self.truth.first_push.start - truth.first_push.start


class Ghost:
    """The robot of a kept run in one browser tab.

    Args:
        client: the browser tab.
        kept: the run.
    """

    def __init__(self, client: viser.ClientHandle, kept: KeptRun) -> None:
        self._kept = kept
        self._turn = 0
        self._body = RobotScene(client, kept.loaded, kept.story.posture(0.0), "/ghost", SKY)
        self._body.fade(_OPACITY)

    def draw(self, truth: Truth, simulated: float) -> None:
        """Be where the robot of the kept run was; every second time only, which nobody sees."""
        self._turn += 1
        if self._turn % 2 == 0 or not truth.playing:
            self._body.draw(self._kept.story.posture(self._kept.time(truth, simulated)))

    def show(self, visible: bool) -> None:
        """Appear or disappear."""
        self._body.show(visible)

    def remove(self) -> None:
        """Leave the scene."""
        self._body.remove()
