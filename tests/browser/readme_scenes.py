"""The lab as the README shows it: how a page comes to each picture, and which part of the page it is."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

from playwright.sync_api import expect

from momentum_lab.events import LoadScenario, StepOnce
from tests.browser.lab_page import PATIENCE
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


def lesson_7(scene: Scene) -> None:
    """Foretold rightly, played, and compared."""
    begin(scene, "7. A larger push")
    answer(scene, "C  Only the one that bends")
    scene.lab.click("Play")
    scene.lab.expect_text(r"simulated time 1\.80 s")
    follow(scene, 4)


def lesson_9(scene: Scene) -> None:
    """The capture point's equation with the numbers of an instant."""
    begin(scene, "9. How far can it go?")
    scene.lab.click("That is my prediction")
    follow(scene, 3)
    answer(scene, "B  Only if its body may turn")
    for step in (5, 6):
        follow(scene, step)
    scene.lab.expect_text(r"at 0\.35 s: both sides differ by")


def lesson_11(scene: Scene) -> None:
    """Body and leg roll with the push, and the equation that says why."""
    leave(scene)
    scene.view("Front")
    begin(scene, "11. Lateral push and the tightrope")
    answer(scene, "C  To the left, with the push")
    scene.lab.click("That is my prediction")
    for step in (4, 5, 6):
        follow(scene, step)
    scene.lab.expect_text(r"at 0\.35 s: both sides differ by")


SHOTS = (
    Shot("push", push),
    Shot("feet", feet, (), 0),
    Shot("pair", pair, ("right",)),
    Shot("lesson7", lesson_7, ("left",)),
    Shot("lesson9", lesson_9, ("left",)),
    Shot("lesson11", lesson_11, ("left",)),
)


def begin(scene: Scene, title: str) -> None:
    """Open a lesson from the list, and go to its second step."""
    lab = scene.lab
    leave(scene)
    lab.page.locator("[role=tab][title=Learn]").evaluate("tab => tab.click()")
    expect(lab.page.get_by_role("button", name=title, exact=True)).to_be_visible(timeout=PATIENCE)
    lab.click(title)
    at_step(scene, 1)
    follow(scene, 2)


def leave(scene: Scene) -> None:
    """Leave the lesson, if one is open."""
    leaving = scene.lab.page.get_by_role("button", name="Leave the lesson", exact=True)
    if leaving.count():
        leaving.evaluate("b => b.click()")
    expect(leaving).to_have_count(0, timeout=PATIENCE)


def answer(scene: Scene, option: str) -> None:
    """Predict by choosing, and go on."""
    step = int(re.findall(r"step ([0-9]+) of", scene.lab.page.inner_text("body"))[0])
    scene.lab.click(option)
    follow(scene, step + 1)


def follow(scene: Scene, step: int) -> None:
    """Go on to a step, once the one before allows it."""
    on = scene.lab.page.get_by_role("button", name=re.compile(r"^(Next|Skip)"))
    expect(on).to_be_enabled(timeout=PATIENCE)
    on.evaluate("b => b.click()")
    at_step(scene, step)


def at_step(scene: Scene, step: int) -> None:
    scene.lab.expect_text(rf"Lesson [0-9]+ · step {step} of [0-9]+")
