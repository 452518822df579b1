"""A person pushes the robot by hand or with a finger: grab it in the picture, pull, let go; and it is repeated."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Locator, expect

from momentum_lab.events import ApplyPush, HoldPush, LetGo
from momentum_lab.replay import replayed, trace_agreement
from momentum_lab.share_code import from_code
from momentum_lab.trace import load_trace
from tests.browser.conftest import OUTPUT, Opener, Served
from tests.browser.lab_page import CANVAS, PATIENCE, TALL, LabPage
from tests.browser.test_share import code_of, downloaded

pytestmark = [pytest.mark.browser, pytest.mark.timeout(240)]

# On the trunk in the first view; to the right of it, a pull that the robot survives; and there, what one sees of it.
TRUNK, PULLED, HELD = (640, 230), (730, 230), (690, 230)
ARROW = {"x": 650, "y": 220, "width": 60, "height": 20}
FORCE = {"x": 735, "y": 215, "width": 90, "height": 20}
# Whether the mouse is over what can be dragged.
GRABBABLE = "[...document.querySelectorAll('canvas')].some(canvas => canvas.style.cursor === 'pointer')"
# A hand that has held for so long has held, s.
LONG = 0.5


def pull(lab: LabPage, end: tuple[int, int]) -> None:
    """Press the mouse on the trunk and take it to another place in steps; it stays down."""
    lab.page.mouse.move(*TRUNK)
    lab.until(lambda: lab.page.evaluate(GRABBABLE), "the trunk is nothing that can be grabbed")
    lab.page.mouse.down()
    for part in np.linspace(0.2, 1.0, 5):
        x, y = np.array(TRUNK) + part * (np.array(end) - TRUNK)
        lab.page.mouse.move(float(x), float(y))
        lab.page.wait_for_timeout(100)


class Finger:
    """A finger on the trunk."""

    def __init__(self, lab: LabPage) -> None:
        self._page, self._at = lab.page, TRUNK
        self._wire = lab.page.context.new_cdp_session(lab.page)

    def pull(self, end: tuple[int, int]) -> None:
        """Go somewhere in steps and stay there; the first time from the trunk."""
        start = np.array(self._at)
        if self._at == TRUNK:
            self._send("touchStart", TRUNK)
        for part in np.linspace(0.2, 1.0, 5):
            self._send("touchMove", tuple((start + part * (np.array(end) - start)).tolist()))
        self._at = end

    def lift(self) -> None:
        self._send("touchEnd")
        self._at = TRUNK

    def _send(self, kind: str, *places: tuple[float, float]) -> None:
        points = [{"x": x, "y": y} for x, y in places]
        self._wire.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
        self._page.wait_for_timeout(200)


def slider(lab: LabPage, label: str) -> Locator:
    uuid = lab.page.locator(f"label:text-is('{label}')").first.get_attribute("for", timeout=PATIENCE)
    return lab.page.locator(f"[id='{uuid}'] [role=slider]").first


def changed(before: np.ndarray, after: np.ndarray, clip: dict[str, int]) -> float:
    """The part of a piece of the page that looks different, both pictures of the canvas."""
    rows = slice(clip["y"] - CANVAS["y"], clip["y"] - CANVAS["y"] + clip["height"])
    columns = slice(clip["x"] - CANVAS["x"], clip["x"] - CANVAS["x"] + clip["width"])
    return float((np.abs(after - before)[rows, columns].max(axis=2) > 40).mean())


def last_push(lab: LabPage) -> tuple[float, float]:
    """Force and duration of the push that is told, N and s."""
    words = lab.page.get_by_text("Last push: ").inner_text()
    force, milliseconds = re.findall(r"([0-9]+) N for ([0-9]+) ms", words)[0]
    return float(force), 1e-3 * float(milliseconds)


def choose_by_hand(lab: LabPage, way: str) -> None:
    lab.page.get_by_role("combobox", name="by hand").evaluate("b => b.click()")
    lab.page.get_by_role("option", name=way).evaluate("o => o.click()")


def switch_shift(lab: LabPage) -> Locator:
    """Press the key that lets a drag push without Shift, or no longer; the switch that shows it."""
    lab.press("t")
    return lab.page.get_by_role("checkbox", name="drag pushes the robot")


def until_bound(lab: LabPage) -> None:
    """Wait until the meshes have heard of the switch: they do with each frame, before its time is told.

    The frame after the switch may have been half done before it.
    """
    for _ in range(2):
        before = lab.time
        lab.until(lambda before=before: lab.time != before, "the time that is told stands still")


def pulse(lab: LabPage) -> float:
    """Pull with Shift and let go: the arrow is drawn before, the push is given and told after; its force, N."""
    still = lab.picture(CANVAS)
    lab.page.keyboard.down("Shift")
    pull(lab, PULLED)
    lab.picture_with(lambda pulling: changed(still, pulling, ARROW) > 0.3, "no arrow where it is pulled")
    lab.picture_with(lambda pulling: changed(still, pulling, FORCE) > 0.1, "no force beside the arrow")
    lab.save(OUTPUT / "drag_pulse.png")
    assert lab.com_travel() < 0.3
    lab.page.mouse.up()
    lab.page.keyboard.up("Shift")
    lab.expect_text("Last push: [0-9]+ N for 100 ms .* on the trunk")
    lab.expect_com_travel(0.5)
    force, _ = last_push(lab)
    expect(slider(lab, "force (N)")).to_have_attribute("aria-valuenow", f"{force:.0f}", timeout=PATIENCE)
    lab.expect_status("standing")
    return force


def hold(lab: LabPage, finger: Finger) -> None:
    """Pull with a finger for a while: the push lasts as long and is shown after, and time stands then."""
    choose_by_hand(lab, "hold")
    expect(switch_shift(lab)).to_be_checked(timeout=PATIENCE)
    until_bound(lab)
    finger.pull(HELD)
    lab.until(lambda: last_push(lab)[1] > LONG, "nothing is held")
    lab.page.screenshot(path=OUTPUT / "drag_hold.png", timeout=PATIENCE)
    finger.lift()
    expect(slider(lab, "duration (ms)")).not_to_have_attribute("aria-valuenow", "100", timeout=PATIENCE)
    lab.pause()


def give_up(lab: LabPage, finger: Finger) -> None:
    """Pull with a finger and take it back where it began."""
    choose_by_hand(lab, "pulse")
    still = lab.picture(CANVAS)
    finger.pull(PULLED)
    lab.picture_with(lambda pulling: changed(still, pulling, ARROW) > 0.3, "the finger pulls nothing")
    finger.pull((TRUNK[0] + 3, TRUNK[1]))
    finger.lift()


def drag_without_shift(lab: LabPage) -> None:
    """Drag as somebody does who wants to turn the picture."""
    expect(switch_shift(lab)).not_to_be_checked(timeout=PATIENCE)
    pull(lab, PULLED)
    lab.page.mouse.up()


def test_a_hand_in_the_picture(served: Served, open_page: Opener, tmp_path: Path) -> None:
    """A pulse and a hold push; a pull that is given up and a drag without Shift do not; the run is repeated."""
    lab = open_page(served.url, height=TALL, fingers=True).until_furnished()
    lab.expect_status("standing")
    lab.expect_ticks(plot=0)
    force = pulse(lab)
    finger = Finger(lab)
    hold(lab, finger)
    give_up(lab, finger)
    drag_without_shift(lab)
    lab.open_tab("5", "Share")
    run = from_code(code_of(lab))
    session, _ = replayed(run)
    first, *pieces, last = [entry.event for entry in run.events]
    assert isinstance(first, ApplyPush)
    assert (first.push.force, first.push.body) == (force, "trunk")
    assert isinstance(last, LetGo)
    assert pieces
    assert all(isinstance(piece, HoldPush) for piece in pieces)
    assert all(np.isclose(push.duration, 0.1) or push.point for push in session.pushes)
    trace = load_trace(downloaded(lab, "trace, every tick (.npz)", tmp_path))
    assert trace_agreement(trace, session).agrees
