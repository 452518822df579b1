"""The lab as the README shows it: how a page comes to each picture, and which part of the page it is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from momentum_lab.events import LoadScenario, StepOnce
from tests.browser import readme_lessons
from tests.browser.scenes import Scene

# When the robot that stays upright has clearly gone over, and the other has bent and holds, ms.
PARTED = 1300


@dataclass(frozen=True, slots=True)
class Shot:
    """A picture of the README.

    Attributes:
        name: its file, without the ending.
        reach: brings the page there.
        panels: which panels are in it beside the canvas: the left one, the right one.
        colours: how many it is kept with; 0: all.
    """

    name: str
    reach: Callable[[Scene], None]
    panels: tuple[str, ...] = ("left", "right")
    colours: int = 256


def push(scene: Scene) -> None:
    """A moment after a push."""
    scene.push()
    scene.view("Whole robot")
    scene.lab.open_tab("1", "Push")


def feet(scene: Scene) -> None:
    """The same instant from near by."""
    scene.view("Feet")


def pair(scene: Scene) -> None:
    """The two robots of Fig. 7, once they have parted."""
    scene.act(LoadScenario("fig7"), *[StepOnce(PARTED // 2)] * 2)
    scene.until(lambda: scene.frame.truth.scenario == "fig7" and scene.ticks >= PARTED)
    scene.view("Whole robot")
    scene.lab.open_tab("4", "Runs")


SHOTS = (
    Shot("push", push),
    Shot("feet", feet, (), 0),
    Shot("pair", pair, ("right",)),
    Shot("lesson4", readme_lessons.explained("4"), ("left",)),
    Shot("lesson7", readme_lessons.compared("7"), ("left",)),
    Shot("lesson9", readme_lessons.explained("9"), ("left",)),
)
