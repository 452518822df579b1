"""A page of the lab beside the session that it shows: the same instant every time, and where its marks are."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from playwright.sync_api import Browser

from momentum_lab.app.library import Library
from momentum_lab.app.overlays import Mark, Picture, overlays
from momentum_lab.app.profile import TEST, RenderProfile
from momentum_lab.app.server import LabServer
from momentum_lab.app.visitor import Visitor
from momentum_lab.app.wire import Frame, rows_of
from momentum_lab.events import ApplyPush, Event, Pause, Reset, StepOnce
from momentum_lab.physics.push import Push
from momentum_lab.recording import Layout, Sample
from momentum_lab.robot.model import RobotModel
from momentum_lab.scenario import load_scenario
from tests.browser.conftest import CROSSED
from tests.browser.lab_page import PATIENCE, LabPage
from tests.browser.pictures import Place

# The chapter's push from behind; after 120 ms the CoP is on the border, and the CMP ahead of it.
PUSH = Push(velocity_change=0.24)
STANDING, PUSHED = 500, 120


@dataclass(frozen=True, slots=True)
class Scene:
    """A page, the visitor who looks at it, and the lessons."""

    lab: LabPage
    visitor: Visitor
    library: Library

    def act(self, *events: Event) -> None:
        """Let some events happen while time stands still."""
        for event in (Pause(), *events):
            self.visitor.post(event)

    def push(self) -> None:
        """A robot that has stood for half a second, a moment after a push: the same tick every time."""
        run = self.frame.truth.run
        self.act(Reset(), StepOnce(STANDING), ApplyPush(PUSH), StepOnce(PUSHED))
        self.until(lambda: self.frame.truth.run > run and self.ticks == STANDING + PUSHED)

    def until(self, true: Callable[[], bool]) -> None:
        """Wait until something is the case with the session."""
        end = time.monotonic() + PATIENCE / 1000.0
        while not true():
            assert time.monotonic() < end, (
                f"not true in time; {self.frame.truth if self.visitor.latest else None}"
            )
            time.sleep(0.05)

    @property
    def ticks(self) -> int:
        """How many ticks after it stood up the robot is shown."""
        return round(1000.0 * self.sample.number("time"))

    def view(self, name: str) -> None:
        """Take a named camera view."""
        self.lab.open_tab("3", "View")
        self.lab.click(name)

    def switch(self, name: str) -> None:
        """Switch something on or off in the open tab; the page tells a change only so often."""
        self.lab.page.get_by_role("checkbox", name=name, exact=True).evaluate("box => box.click()")
        self.lab.page.wait_for_timeout(300)

    def picture(self) -> np.ndarray:
        """What is drawn of the scene, once it has come to rest (h, w, 3)."""
        self.lab.page.wait_for_timeout(1000)
        return self.lab.picture(self.box)

    @property
    def box(self) -> dict[str, int]:
        """Where on the page the scene is drawn, px."""
        box = self.lab.page.locator("canvas").first.bounding_box()
        assert box is not None
        return {key: round(value) for key, value in box.items()}

    @property
    def frame(self) -> Frame:
        assert self.visitor.latest is not None
        return self.visitor.latest

    @property
    def robot(self) -> RobotModel:
        return RobotModel.named(self.frame.truth.robot)

    @property
    def sample(self) -> Sample:
        layout = Layout.of(self.robot)
        return Sample.of(layout, rows_of(self.frame.row, layout.width)[0])

    @property
    def marks(self) -> dict[str, Mark]:
        """The marks of the instant that is shown, whether they are switched on or not."""
        truth = self.frame.truth
        picture = Picture(self.robot, truth.push, truth.gains["safe_border"])
        return {mark.key: mark for mark in overlays(self.sample, picture)}

    def place(self, point: tuple[float, float, float]) -> Place:
        """Where a point (3,), m, is in the picture: a pinhole camera whose image plane is one length unit away."""
        camera, box = self.visitor.client.camera, self.box
        forward = _unit(camera.look_at - camera.position)
        right = _unit(np.cross(forward, (0.0, 0.0, 1.0)))
        down = np.cross(forward, right)
        x, y, z = (float((np.array(point) - camera.position) @ axis) for axis in (right, down, forward))
        scale = 0.5 * box["height"] / np.tan(0.5 * camera.fov)
        return Place(round(0.5 * box["width"] + scale * x / z), round(0.5 * box["height"] + scale * y / z))


def _unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector)


@contextlib.contextmanager
def opened(
    browser: Browser,
    scenario: str = "stand",
    profile: RenderProfile = TEST,
    lesson: Path | None = None,
) -> Iterator[Scene]:
    """The lab on a page of its own; at the end its console may have shown no error."""
    errors: list[str] = []
    library = Library()
    with LabServer(load_scenario(scenario), profile=profile, library=library, lesson=lesson) as server:
        page = browser.new_page(viewport={"width": 1280, "height": 800})
        page.on("console", lambda message: errors.append(message.text) if message.type == "error" else None)
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.goto(server.url)
        lab = LabPage(page)
        lab.page.locator("[data-status]").wait_for(timeout=PATIENCE)
        lab.dismiss_notices()
        scene = Scene(lab, server.visitors[0], library)
        # Panels come before the first frame has been drawn.
        scene.until(lambda: scene.visitor.latest is not None)
        try:
            yield scene
        finally:
            page.close()
    assert [error for error in errors if not error.startswith(CROSSED)] == []
