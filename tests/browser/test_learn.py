"""A learner in front of the lab: predict, watch, compare, explain; and what is left after a reload."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import expect

from momentum_lab.lesson.loader import find_lesson
from tests.browser.conftest import OUTPUT, Opener, Served, serve
from tests.browser.lab_page import PATIENCE, LabPage
from tests.test_lesson import written

pytestmark = [
    pytest.mark.browser,
    pytest.mark.timeout(240),
    pytest.mark.filterwarnings("ignore:Queued a:UserWarning"),
]
FIRST = "1. What the ground can do"


@pytest.fixture
def served_with_errors(tmp_path: Path) -> Iterator[Served]:
    """A lesson with an error in it, opened from the command line."""
    yield from serve(tmp_path, "test", "stand", written(tmp_path, ("STEPS = (", "STEPS = = (")))


@pytest.fixture
def served_lesson(tmp_path: Path) -> Iterator[Served]:
    """A lesson, opened from the command line."""
    yield from serve(tmp_path, "test", "stand", find_lesson("7"))


def test_a_whole_lesson_by_keyboard_and_mouse_and_after_a_reload(served: Served, open_page: Opener) -> None:
    lab = open_page(served.url).until_furnished()
    open_list(lab)
    expect(button(lab, FIRST)).to_be_visible(timeout=PATIENCE)
    button(lab, FIRST).focus()
    lab.press("Enter")
    at_step(lab, 1)
    lab.expect_text(r"simulated time\s*0\.00 s")

    lab.press("i")
    at_step(lab, 2)
    expect(button(lab, "Predict first")).to_be_disabled()
    lab.press("p")
    lab.expect_text("this step of the lesson has no push")
    lab.press("i")
    lab.page.wait_for_timeout(500)
    at_step(lab, 2)  # nothing comes before the prediction
    lab.click("A  Straight up, as before")
    expect(button(lab, "Next (I)")).to_be_enabled(timeout=PATIENCE)
    lab.press("i")
    at_step(lab, 3)
    lab.slide("I predict (N)", "ArrowLeft")
    lab.press(*["ArrowLeft"] * 34)  # from the middle of -200 to 200 N
    lab.page.wait_for_timeout(1000)  # a slider reports where it has come to, not every step on the way
    lab.click("That is my prediction")
    lab.expect_text("your prediction")
    lab.dismiss_notices()
    lab.save(OUTPUT / "learn_number_test.png")
    lab.press("i")
    at_step(lab, 4)
    lab.expect_text(r"simulated time\s*0\.00 s")  # and nothing has moved

    lab.click("Play")
    expect(button(lab, "Next (I)")).to_be_visible(timeout=PATIENCE)
    lab.expect_text(r"simulated time\s*2\.00 s")
    lab.press("p")
    lab.expect_text("Last push")
    lab.save(OUTPUT / "learn_play_test.png")
    lab.press("i")
    at_step(lab, 5)
    lab.expect_text("Otherwise")
    lab.expect_text("Close")
    lab.expect_text("runs that you have just seen")
    lab.save(OUTPUT / "learn_compare_test.png")

    lab.press("i")
    at_step(lab, 6)
    lab.expect_text(r"at 0\.35 s: both sides differ by")
    before = equation(lab)
    lab.slide("instant (s)", "Home")
    lab.expect_text(r"at 0\.00 s: both sides differ by")
    assert equation(lab) != before
    lab.expect_status("standing")
    lab.save(OUTPUT / "learn_explain_test.png")

    lab.page.reload()
    lab.until_furnished()
    open_list(lab)
    lab.expect_text("0 of [0-9]+ done")
    expect(button(lab, FIRST)).to_be_visible(timeout=PATIENCE)
    lab.click(FIRST)
    at_step(lab, 6)
    lab.press("u")
    at_step(lab, 5)
    lab.expect_text("You: A Straight up")
    lab.expect_text("played out of sight")
    for step in (6, 7, 8):
        lab.press("i")
        at_step(lab, step)
    lab.click("Finish (I)")
    lab.expect_text("1 of [0-9]+ done")
    lab.save(OUTPUT / "learn_list_test.png")
    lab.expect_text("Push the robot")


def test_leaving_gives_the_own_session_back(served: Served, open_page: Opener) -> None:
    lab = open_page(served.url).until_furnished()
    lab.press("p")
    lab.expect_text("Last push")
    lab.press("k")
    lab.expect_text("paused")
    own = lab.settled_text("simulated time")
    open_list(lab)
    lab.click("7. A larger push")
    at_step(lab, 1)
    lab.expect_text(r"simulated time\s*0\.00 s")
    lab.click("Leave the lesson")
    lab.expect_text("Last push")
    assert lab.settled_text("simulated time") == own
    expect(button(lab, "Push (P)")).to_be_visible(timeout=PATIENCE)


def test_two_learners_do_not_disturb_each_other(served: Served, open_page: Opener) -> None:
    one, other = open_page(served.url).until_furnished(), open_page(served.url).until_furnished()
    open_list(one)
    one.click(FIRST)
    at_step(one, 1)
    open_list(other)
    other.click("7. A larger push")
    at_step(other, 1)
    other.press("i")
    at_step(other, 2)
    other.click("C  The one that stays upright: it brakes less")
    expect(button(other, "Next (I)")).to_be_enabled(timeout=PATIENCE)
    other.press("i")
    at_step(other, 3)
    other.click("Play")
    other.expect_text(r"simulated time\s*1\.80 s")
    at_step(one, 1)
    one.expect_text(r"simulated time\s*0\.00 s")
    one.expect_text("What the ground can do")


def test_lesson_with_an_error_is_told_and_the_lab_goes_on(
    served_with_errors: Served, open_page: Opener
) -> None:
    lab = open_page(served_with_errors.url).until_furnished()
    lab.expect_text("This lesson has an error")
    lab.expect_text(r"01_leaning_in\.py:[0-9]+: got STEPS = = \(; allowed: Python")
    lab.press("p")
    lab.expect_text("Last push")
    lab.save(OUTPUT / "learn_error_test.png")


def test_a_lesson_on_a_phone(served_lesson: Served, open_page: Opener) -> None:
    lab = open_page(served_lesson.url, 390, 844)
    lab.expect_text("A larger push")
    at_step(lab, 1)
    lab.dismiss_notices()
    lab.save(OUTPUT / "learn_phone_test.png")
    lab.press("i")
    at_step(lab, 2)
    box = button(lab, "B  The one that bends: it gives up its posture").bounding_box()
    assert box is not None
    assert box["x"] >= 0
    assert box["x"] + box["width"] <= 390
    lab.save(OUTPUT / "learn_phone_choice_test.png")

    lab.click("B  The one that bends: it gives up its posture")
    expect(button(lab, "Next (I)")).to_be_enabled(timeout=PATIENCE)
    lab.page.wait_for_timeout(1000)  # the browser keeps it
    lab.page.reload()
    at_step(lab, 2)
    expect(button(lab, "Next (I)")).to_be_enabled(timeout=PATIENCE)


def open_list(lab: LabPage) -> None:
    """The tab of lessons, by keyboard."""
    lab.page.locator("[role=tab][title=Learn]").focus()
    lab.press("Enter")


def button(lab: LabPage, name: str):
    return lab.page.get_by_role("button", name=name, exact=True)


def at_step(lab: LabPage, step: int) -> None:
    lab.expect_text(rf"Lesson [0-9]+ · step {step} of [0-9]+")


def equation(lab: LabPage) -> str | None:
    return lab.page.locator("math[display=block]").text_content()
