"""A learner in front of the lab: predict, watch, compare, explain; and what is left after a reload."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import pytest
from playwright.sync_api import expect

from momentum_lab.lesson.record import LessonRecord, rehearsed
from tests.browser.conftest import OUTPUT, Opener, Served, serve
from tests.browser.lab_page import PATIENCE, LabPage
from tests.browser.learner import Learner
from tests.test_lesson import written

pytestmark = [
    pytest.mark.browser,
    pytest.mark.timeout(240),
    pytest.mark.filterwarnings("ignore:Queued a:UserWarning"),
]
# The lesson that the lessons' README writes out, with a step of every kind in it and less to watch.
EVERYTHING = (
    ('"seconds": 2.0', '"seconds": 1.4'),
    (
        "STEPS = (",
        'STEPS = (\n    lab.Prose("It stands."),\n    lab.Number("How far does it go?", "way", 0, 100),',
    ),
)
PROSE, NUMBER, CHOICE, PLAY, COMPARE, EXPLAIN = range(6)
# It moves by 6 mm and comes back.
FAR_OFF, RIGHT = "63", 1


@dataclass(frozen=True, slots=True)
class Course:
    """A lab with a few lessons: two that are sound, and one that claims nothing.

    Attributes:
        served: the lab.
        first: what the first lesson shows.
        second: what the second one shows.
    """

    served: Served
    first: LessonRecord
    second: LessonRecord


@pytest.fixture(scope="module")
def course(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Course]:
    folder = tmp_path_factory.mktemp("lessons")
    written(folder, ("Leaning in", "Another one"), *EVERYTHING).rename(folder / "02_another.py")
    written(folder, ("Leaning in", "No claim"), ("CLAIMS = (", "CLAIMED = (")).rename(
        folder / "03_no_claim.py"
    )
    written(folder, *EVERYTHING)
    first, second = (rehearsed(str(path), "talos") for path in sorted(folder.glob("0[12]*.py")))
    for served in serve(tmp_path_factory.mktemp("test"), "coarse", "stand", folder):
        yield Course(served, first, second)


def test_a_whole_lesson_by_keyboard_and_mouse(course: Course, open_page: Opener) -> None:
    learner = Learner(open_page(course.served.url).until_furnished(), course.first)
    open_by_keyboard(learner)
    predict_wrongly_in_haste(learner)
    predict_rightly_once_it_is_due(learner)
    watch_and_try(learner)
    compare(learner)
    look_into_the_equation(learner)
    come_back_after_a_reload(learner)
    finish(learner)


def open_by_keyboard(learner: Learner) -> None:
    learner.open_list()
    learner.entry.focus()
    learner.lab.press("Enter")
    learner.at(PROSE)
    learner.lab.expect_text(r"simulated time\s*0\.00 s")


def predict_wrongly_in_haste(learner: Learner) -> None:
    """A number that is typed is the prediction, whatever is pressed in the same instant."""
    learner.go_on(NUMBER)
    expect(learner.button("Predict first")).to_be_disabled()
    for number, keys in (("41", ("Tab", "Enter")), ("27", ("Enter",))):
        learner.type(number, *keys)
        learner.lab.expect_text(rf"{number} mm\s*← your prediction")
    learner.lab.dismiss_notices()
    learner.lab.save(OUTPUT / "learn_number_test.png")
    learner.type(FAR_OFF, "Enter", "i")
    learner.at(CHOICE)


def predict_rightly_once_it_is_due(learner: Learner) -> None:
    learner.lab.press("i")  # comes too early
    learner.lab.press("p")
    learner.lab.expect_text("this step of the lesson has no push")
    learner.at(CHOICE)
    learner.choose(RIGHT)
    learner.go_on(PLAY)
    learner.lab.expect_text(r"simulated time\s*0\.00 s")  # and nothing has moved


def watch_and_try(learner: Learner) -> None:
    expect(learner.button("Play")).to_have_count(1)  # that of the clock
    learner.play()
    learner.lab.expect_text(r"simulated time\s*1\.40 s")
    learner.lab.press("p")
    learner.lab.expect_text("Last push")
    learner.lab.save(OUTPUT / "learn_play_test.png")


def compare(learner: Learner) -> None:
    learner.go_on(COMPARE)
    for words in (rf"You: {FAR_OFF} mm", "Off by", "As you predicted", "runs that you have just seen"):
        learner.lab.expect_text(words)
    learner.lab.save(OUTPUT / "learn_compare_test.png")


def look_into_the_equation(learner: Learner) -> None:
    lab = learner.lab
    learner.go_on(EXPLAIN)
    lab.expect_text(r"at 0\.35 s: both sides differ by")
    equation = lab.page.locator("math[display=block]")
    before = equation.text_content()
    lab.slide("instant (s)", "Home")
    lab.expect_text(r"at 0\.00 s: both sides differ by")
    assert equation.text_content() != before
    lab.expect_status("standing")
    lab.save(OUTPUT / "learn_explain_test.png")


def come_back_after_a_reload(learner: Learner) -> None:
    learner.reload(f'"step":{EXPLAIN}')
    learner.lab.until_furnished()
    learner.open_list()
    learner.lab.expect_text("0 of 3 done")
    learner.open()
    learner.at(EXPLAIN)
    learner.lab.press("u")
    learner.at(COMPARE)
    learner.lab.expect_text(rf"You: {FAR_OFF} mm")
    learner.lab.expect_text("played out of sight")


def finish(learner: Learner) -> None:
    learner.go_on(EXPLAIN)
    learner.lab.click("Finish (I)")
    learner.lab.expect_text("1 of 3 done")
    learner.lab.save(OUTPUT / "learn_list_test.png")
    learner.lab.expect_text("Push the robot")


def test_leaving_gives_the_own_session_back(course: Course, open_page: Opener) -> None:
    lab = open_page(course.served.url).until_furnished()
    lab.press("p")
    lab.expect_text("Last push")
    lab.press("k")
    lab.expect_text("paused")
    own = lab.time
    learner = Learner(lab, course.second)
    learner.open_list()
    learner.open()
    learner.at(PROSE)
    lab.expect_text(r"simulated time\s*0\.00 s")
    learner.leave()
    lab.expect_text("Last push")
    lab.expect_time(own)
    expect(learner.button("Push (P)")).to_be_visible(timeout=PATIENCE)


def test_two_learners_do_not_disturb_each_other(course: Course, open_page: Opener) -> None:
    one, other = (
        Learner(open_page(course.served.url).until_furnished(), record)
        for record in (course.first, course.second)
    )
    for learner in (one, other):
        learner.open_list()
        learner.open()
    one.at(PROSE)
    other.go_to("play")
    other.play()
    other.lab.expect_text(r"simulated time\s*1\.40 s")
    one.at(PROSE)
    one.lab.expect_text(r"simulated time\s*0\.00 s")
    one.lab.expect_text("Leaning in")


def test_lesson_with_an_error_is_marked_and_told_and_the_lab_goes_on(
    course: Course, open_page: Opener
) -> None:
    lab = open_page(course.served.url).until_furnished()
    Learner(lab, course.first).open_list()
    lab.expect_text("1 cannot be opened")
    lab.click("3. No claim · has an error")
    lab.expect_text("This lesson has an error")
    lab.expect_text(r"03_no_claim\.py:[0-9]+: got no CLAIMS")
    lab.press("p")
    lab.expect_text("Last push")
    lab.save(OUTPUT / "learn_error_test.png")


def test_a_lesson_on_a_phone(course: Course, open_page: Opener) -> None:
    lab = open_page(course.served.url, 390, 844).until_furnished()
    learner = Learner(lab, course.second)
    unfold(lab)
    learner.open()
    for place, step in enumerate(course.second.steps):
        learner.at(place)
        in_sight(learner)
        lab.save(OUTPUT / f"learn_phone_{step.kind}_test.png")
        learner.predict(step)
        if place == CHOICE:
            break
        learner.go_on(place + 1)
    learner.reload(f'"{CHOICE}":{RIGHT}')
    unfold(lab)
    learner.open()
    learner.at(CHOICE)
    expect(learner.button("Next (I)")).to_be_enabled(timeout=PATIENCE)


def unfold(lab: LabPage) -> None:
    """Open the lessons in the phone's sheet."""
    bar = lab.page.get_by_role("button", name="Expand panel Learn")
    expect(bar).to_be_visible(timeout=PATIENCE)
    lab.dismiss_notices()
    bar.evaluate("b => b.click()")


def in_sight(learner: Learner) -> None:
    """The step's text, its options and the way on are on a phone's screen, and nobody has scrolled."""
    for what in (learner.lab.page.locator("form .learn").first, *learner.options, learner.way_on):
        box = what.bounding_box()
        assert box is not None
        assert 0 <= box["x"] < box["x"] + box["width"] <= 390
        assert 844 // 2 < box["y"] < box["y"] + box["height"] <= 844
