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


def pull(lab: LabPage, end: tuple[int, int]) -> None:
    """Press the mouse on the trunk and take it to another place in steps; it stays down."""
    lab.page.mouse.move(*TRUNK)
    lab.page.wait_for_timeout(500)
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


def test_a_hand_in_the_picture(served: Served, open_page: Opener, tmp_path: Path) -> None:
    lab = open_page(served.url, height=TALL, fingers=True).until_furnished()
    lab.expect_status("standing")
    lab.expect_ticks(plot=0)
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
    told = lab.page.get_by_text("Last push: ").inner_text()
    force = float(re.findall(r"([0-9]+) N", told)[0])
    expect(slider(lab, "force (N)")).to_have_attribute("aria-valuenow", f"{force:.0f}", timeout=PATIENCE)
    lab.expect_status("standing")

    lab.page.get_by_role("combobox", name="by hand").evaluate("b => b.click()")
    lab.page.get_by_role("option", name="hold").evaluate("o => o.click()")
    switch = lab.page.get_by_role("checkbox", name="drag pushes the robot")
    lab.press("t")
    expect(switch).to_be_checked(timeout=PATIENCE)
    lab.page.wait_for_timeout(1000)  # the meshes hear of it after the switch
    finger = Finger(lab)
    finger.pull(HELD)
    lab.page.wait_for_timeout(1000)
    lab.page.screenshot(path=OUTPUT / "drag_hold.png", timeout=PATIENCE)
    finger.lift()
    expect(slider(lab, "duration (ms)")).not_to_have_attribute("aria-valuenow", "100", timeout=PATIENCE)
    lab.pause()

    lab.page.get_by_role("combobox", name="by hand").evaluate("b => b.click()")
    lab.page.get_by_role("option", name="pulse").evaluate("o => o.click()")
    finger.pull(PULLED)  # and back: given up
    finger.pull((TRUNK[0] + 3, TRUNK[1]))
    finger.lift()
    lab.press("t")
    expect(switch).not_to_be_checked(timeout=PATIENCE)
    pull(lab, PULLED)  # without Shift: the picture turns, and nobody is pushed
    lab.page.mouse.up()
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
