"""Three lessons as the README shows them: a step of a kind, whatever the lesson's words are."""

from __future__ import annotations

from collections.abc import Callable

from playwright.sync_api import expect

from momentum_lab.lesson.loader import find_lesson
from tests.browser.lab_page import PATIENCE
from tests.browser.learner import Learner
from tests.browser.scenes import Scene


def compared(number: str) -> Callable[[Scene], None]:
    """A lesson that was predicted rightly, played, and compared."""

    def reach(scene: Scene) -> None:
        learner = begun(scene, number)
        place = learner.go_to("play")
        learner.play()
        learner.go_on(place + 1)
        end = learner.record.runs[learner.record.steps[place].run].seconds
        scene.until(lambda: scene.ticks >= round(1000.0 * end) - 1)  # the last row is that of the last tick

    return reach


def explained(number: str) -> Callable[[Scene], None]:
    """A lesson's equation with the numbers of its instant."""

    def reach(scene: Scene) -> None:
        learner = begun(scene, number)
        step = learner.record.steps[learner.go_to("explain")]
        scene.until(lambda: scene.ticks == round(1000.0 * step.time))

    return reach


def begun(scene: Scene, number: str) -> Learner:
    """Somebody who has opened a lesson, and has left the one before."""
    learner = Learner(scene.lab, scene.library.rehearse(find_lesson(number), "talos"))
    leave = learner.button("Leave the lesson")
    if leave.count():
        leave.evaluate("b => b.click()")
        expect(leave).to_have_count(0, timeout=PATIENCE)
    learner.open_list()
    learner.open()
    return learner
