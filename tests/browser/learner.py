"""A learner in front of the lab: what a hand does in a lesson, whatever the lesson says."""

from __future__ import annotations

import re
from dataclasses import dataclass

from playwright.sync_api import Locator, expect

from momentum_lab.lesson.record import LessonRecord, StepRecord
from tests.browser.lab_page import PATIENCE, LabPage

LETTERS = "ABCDEFGH"


@dataclass(frozen=True, slots=True)
class Learner:
    """Somebody with a lesson.

    Attributes:
        lab: the page.
        record: what the lesson shows when nobody looks.
    """

    lab: LabPage
    record: LessonRecord

    def open_list(self) -> None:
        """The tab of lessons, by keyboard."""
        self.lab.page.locator("[role=tab][title=Learn]").focus()
        self.lab.press("Enter")
        expect(self.entry).to_be_visible(timeout=PATIENCE)

    @property
    def entry(self) -> Locator:
        """The lesson in the list."""
        return self.button(f"{self.record.number}. {self.record.title}")

    def open(self) -> None:
        """The lesson's first step, or the one at which it was left."""
        self.entry.evaluate("b => b.click()")
        self.lab.expect_text(rf"Lesson {self.record.number} · step")

    def at(self, place: int) -> None:
        """Wait until a step is open, counted from 0."""
        count = len(self.record.steps)
        self.lab.expect_text(rf"Lesson {self.record.number} · step {place + 1} of {count}")

    def step(self, kind: str) -> int:
        """The first step of a kind."""
        return next(place for place, step in enumerate(self.record.steps) if step.kind == kind)

    def go_on(self, place: int) -> None:
        """Open the next step by its key, once it may come."""
        expect(self.way_on).to_be_enabled(timeout=PATIENCE)
        self.lab.press("i")
        self.at(place)

    def go_to(self, kind: str) -> int:
        """From the first step to the first of a kind, with predictions that come true; nothing is played."""
        place = self.step(kind)
        for before in range(place):
            self.at(before)
            self.predict(self.record.steps[before])
            self.go_on(before + 1)
        return place

    def predict(self, step: StepRecord) -> None:
        """Predict what will be measured, where a step asks for it."""
        if step.kind == "choice":
            self.choose(step.right[0])
        elif step.kind == "number":
            self.type(f"{step.measured:.3g}", "Enter")

    def choose(self, place: int) -> None:
        """Choose an option, counted from 0."""
        option = self.lab.page.get_by_role("button", name=re.compile(rf"^{LETTERS[place]} "))
        expect(option).to_be_enabled(timeout=PATIENCE)
        option.evaluate("b => b.click()")

    def type(self, number: str, *then: str) -> None:
        """Type a number over the one that is there, key by key, and press what follows at once."""
        box = self.lab.page.get_by_label(re.compile(r"^I predict.*, typed$"))
        expect(box).to_be_visible(timeout=PATIENCE)
        box.focus()
        self.lab.press("Control+a", *number, *then)

    def play(self) -> None:
        """Watch the run to its end."""
        self.lab.page.get_by_role("button", name=re.compile("^Play the run")).evaluate("b => b.click()")
        expect(self.lab.page.get_by_role("button", name=re.compile("^(Next|Finish)"))).to_be_visible(
            timeout=PATIENCE
        )

    def reload(self, words: str) -> None:
        """Load the page again as soon as the browser has kept something."""
        kept = "words => Object.values(localStorage).some(text => text.includes(words))"
        self.lab.page.wait_for_function(kept, arg=words, timeout=PATIENCE)
        self.lab.page.reload()

    def leave(self) -> None:
        """Leave the lesson."""
        self.button("Leave the lesson").evaluate("b => b.click()")
        expect(self.entry).to_be_visible(timeout=PATIENCE)

    @property
    def options(self) -> list[Locator]:
        """What can be chosen."""
        return self.lab.page.get_by_role("button", name=re.compile(rf"^[{LETTERS}] ")).all()

    @property
    def way_on(self) -> Locator:
        """What leads to the next step."""
        return self.lab.page.get_by_role("button", name=re.compile("^(Next|Skip|Finish|Predict first)"))

    def button(self, name: str) -> Locator:
        return self.lab.page.get_by_role("button", name=name, exact=True)
