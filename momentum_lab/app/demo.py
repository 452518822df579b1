"""The lab plays by itself while nobody touches it: scene after scene, each with a sentence, until somebody does."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass

from momentum_lab.control.motion import motions_of
from momentum_lab.physics.push import Push
from momentum_lab.robot.catalog import load_spec
from momentum_lab.scenario import Scenario, changed, load_scenario

TURN = 3.0
"""How fast the camera goes round the robot meanwhile, degrees per second."""
AHEAD = 12.0
"""How far before the usual view it begins, degrees."""


@dataclass(frozen=True, slots=True)
class Scene:
    """A part of what is played.

    Attributes:
        scenario: what is played.
        caption: what there is to see, in a sentence.
        seconds: how long it is shown, s.
    """

    scenario: Scenario
    caption: str
    seconds: float


_SMALL_PUSH = Scenario("stand", pushes=(Push(velocity_change=0.1, duration=0.1, start=1.0),))


def programme(robot: str) -> tuple[Scene, ...]:
    """What a robot plays, in this order, again and again.

    Args:
        robot: name of the robot, or the path of its file.
    """
    scenes = (
        Scene(
            _SMALL_PUSH,
            "A small push from behind: the CoP moves towards the toes and brings the CoM back.",
            7.0,
        ),
        Scene(
            load_scenario("fig7"),
            "Two robots, the same push. One lets its body turn to hold its CoM, the other holds its posture.",
            9.0,
        ),
        Scene(
            load_scenario("one-leg"),
            "On one leg there is one foot for the CoP to move in: this push is ten times smaller.",
            8.0,
        ),
        Scene(
            load_scenario("bus"),
            "A ride on a bus: the floor sways 5 cm forward and back, and the CoP works against it.",
            10.0,
        ),
        Scene(
            load_scenario("kick"),
            "A kick on one leg: the rest of the body moves against it, so that no momentum is left over.",
            6.0,
        ),
    )
    motions = motions_of(load_spec(robot))
    return tuple(
        Scene(changed(scene.scenario, robot=robot), scene.caption, scene.seconds)
        for scene in scenes
        if not scene.scenario.motion or scene.scenario.motion in motions
    )


class Demo:
    """Whether the lab plays by itself in one browser tab, and which scene; the only place that knows.

    Args:
        play: lets a scene begin.
        leave: gives the person's own state back.
        robot: says which robot plays.
        patience: how long nobody has to touch the lab, s; None: it never plays by itself.
        clock: seconds, for tests.

    Attributes:
        patience: as above.
    """

    def __init__(
        self,
        play: Callable[[Scene], None],
        leave: Callable[[], None],
        robot: Callable[[], str],
        patience: float | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._play, self._leave, self._robot, self._clock = play, leave, robot, clock
        self._lock = threading.RLock()
        self._touched = clock()
        self._scenes: tuple[Scene, ...] = ()
        self._place, self._until = 0, math.inf
        self.patience = patience

    @property
    def scene(self) -> Scene | None:
        """The scene that is played now."""
        with self._lock:
            return self._scenes[self._place] if self._scenes else None

    def touch(self) -> None:
        """Somebody is there: what was before is back at once."""
        with self._lock:
            self._touched = self._clock()
            if self._scenes:
                self._scenes = ()
                self._leave()

    def tick(self) -> None:
        """Begin, or go on to the next scene, when it is time."""
        with self._lock:
            now = self._clock()
            if self._scenes:
                if now >= self._until:
                    self._show((self._place + 1) % len(self._scenes), now)
            elif self.patience is not None and now - self._touched >= self.patience:
                self._scenes = programme(self._robot())
                self._show(0, now)

    def _show(self, place: int, now: float) -> None:
        self._place = place
        self._until = now + self._scenes[place].seconds
        self._play(self._scenes[place])
