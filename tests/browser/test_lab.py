"""A person in front of the lab: from the first picture to the second tab."""

from __future__ import annotations

import re
import time
from collections.abc import Iterator

import numpy as np
import pytest
import viser
from playwright.sync_api import FloatRect, Locator, expect

from momentum_lab.app.camera import START_VIEW, Camera
from momentum_lab.app.page_plan import BAR_HEIGHT
from momentum_lab.app.profile import TEST
from momentum_lab.app.status_bar import INVITATION
from momentum_lab.app.world import add_world
from tests.app.test_link import alive
from tests.app.test_server import children
from tests.browser.conftest import OUTPUT, Opener, Served
from tests.browser.lab_page import CANVAS, PATIENCE, TALL, LabPage, differing

pytestmark = [
    pytest.mark.browser,
    pytest.mark.timeout(240),
    pytest.mark.filterwarnings("ignore:Queued a:UserWarning"),
]


# Keys that follow each other faster are one that is held down, ms.
REPEATED = 150


@pytest.fixture(scope="session")
def empty_url() -> Iterator[str]:
    """The same world and the same panels without a robot."""
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)

    @server.on_client_connect
    def _(client: viser.ClientHandle) -> None:
        add_world(client, TEST)
        Camera(client, 0.877).look(START_VIEW, np.zeros(2))
        client.gui.main_panel.dock_right()
        client.gui.main_panel.set_width(350.0)
        plots = client.gui.add_panel()
        with plots.add_tab("Plots"):
            client.gui.add_markdown("nothing")
        plots.dock_left()
        plots.set_width(350.0)

    yield f"http://127.0.0.1:{server.get_port()}"
    server.stop()


def test_a_robot_stands_in_the_picture(served: Served, empty_url: str, open_page: Opener) -> None:
    lab = open_page(served.url, height=TALL).until_furnished()
    lab.expect_status("standing")
    lab.expect_text(re.escape(INVITATION))
    expect(lab.page).to_have_title("Momentum lab")
    for plot in range(4):
        lab.expect_ticks(plot)
    with_robot = lab.picture(CANVAS)
    lab.save(OUTPUT / "standing_test.png")
    assert_below_the_picture(lab)
    lab.page.close()
    empty = open_page(empty_url, height=TALL)
    expect(empty.page.get_by_text("nothing")).to_be_visible(timeout=PATIENCE)
    empty.dismiss_notices()
    without = empty.picture(CANVAS)
    differs = np.abs(with_robot - without).max(axis=2) > 40
    rows = np.flatnonzero(differs.sum(axis=1) > 10)
    assert differs.mean() > 0.08
    assert rows[-1] - rows[0] > 0.75 * CANVAS["height"]


def test_a_push_a_slider_a_fall_and_a_reload(served: Served, open_page: Opener) -> None:
    lab = open_page(served.url).until_furnished()
    lab.click("Push (P)")
    lab.expect_com_travel(1.0)
    lab.expect_status("angular goal gives way by [0-9]+ N m")
    lab.expect_status("standing")
    lab.expect_text("Last push: 217 N for 100 ms forward")

    lab.press("2")
    expect(lab.page.get_by_role("tab", name="Control")).to_have_attribute("aria-selected", "true")
    assert left_of(lab, "preset") == pytest.approx(left_of(lab, "planner"), abs=0.5)
    lab.page.get_by_text("Gains", exact=True).evaluate("g => g.click()")
    lab.slide("linear damping (1/s)", "ArrowRight")
    lab.expect_text("linear damping: [0-9.]+ → [0-9.]+ 1/s")  # this text comes from the session
    lab.click("Reset the gains")
    lab.expect_text("All gains are at their defaults")

    lab.press("1")
    expect(lab.page.get_by_role("tab", name="Push")).to_have_attribute("aria-selected", "true")
    lab.slide("force (N)", "End")
    lab.press("p")
    lab.expect_status("fallen at [0-9.]+ s: ")
    lab.pause()
    lab.save(OUTPUT / "fallen_test.png")
    lab.press("k")
    lab.click("Stand up again (R)")
    lab.expect_status("standing")

    lab.page.reload()
    lab.until_furnished()
    lab.expect_status("standing")
    lab.expect_text(re.escape(INVITATION))


def left_of(lab: LabPage, name: str) -> float:
    """Where the box beside a name begins, px."""
    row = lab.page.locator("label").filter(has_text=re.compile(f"^{name}$")).first
    box = lab.page.locator(f"[id='{row.get_attribute('for', timeout=PATIENCE)}']").bounding_box()
    assert box is not None
    return box["x"]


def test_the_second_tab_has_a_robot_of_its_own(served: Served, open_page: Opener) -> None:
    first = open_page(served.url).until_furnished()
    before = settled_children(served.process.pid)
    second = open_page(served.url).until_furnished()
    (worker,) = children(served.process.pid) - before
    second.press("p")
    second.expect_com_travel(1.0)
    second.expect_text("Last push")
    first.expect_text(re.escape(INVITATION))
    assert first.com_travel() < 0.3
    second.page.close()
    end = time.monotonic() + 20.0
    while alive(worker) and time.monotonic() < end:
        time.sleep(0.05)
    assert not alive(worker)
    assert before <= children(served.process.pid)


def test_paused_at_the_moment_that_teaches(served: Served, open_page: Opener) -> None:
    lab = open_page(served.url, height=TALL).until_furnished()
    paused = pause_in_saturation(lab)
    for steps in range(1, 4):  # a millisecond each
        lab.press("j")
        lab.expect_time(paused + 1e-3 * steps)
        lab.page.wait_for_timeout(REPEATED)
    lab.press("3")
    expect(lab.page.get_by_role("tab", name="View")).to_have_attribute("aria-selected", "true")
    lab.click("minimal")
    minimal = lab.picture(CANVAS)
    lab.click("everything")
    lab.picture_with(lambda now: differing(now, minimal) > 0.002, "no marks")
    assert lab.time == pytest.approx(paused + 3e-3, abs=1e-9)
    lab.press("h")
    lab.expect_text("How this lab works")


def test_look_back_and_go_on_from_there(served: Served, open_page: Opener) -> None:
    """A fall is looked back at from its end to before the push, and from there the story goes on without it."""
    lab = open_page(served.url).until_furnished()
    lab.slide("force (N)", "End")
    lab.press("p")
    lab.expect_status("fallen at [0-9.]+ s: ")
    lab.slide("look back (s)", "Home")
    lab.expect_text("s before the end")
    lab.expect_status("standing")
    lab.expect_text("Go on without 1 later push")
    lab.save(OUTPUT / "looking_back_test.png")
    lab.press("b")
    expect(lab.page.get_by_role("button", name="Pause", exact=True)).to_be_visible(timeout=PATIENCE)
    lab.expect_gone("s before the end")
    lab.press("p")
    lab.expect_text("Last push")
    lab.expect_status("standing|gives way")


def test_scrub_to_an_instant_in_between_and_go_on_from_there(served: Served, open_page: Opener) -> None:
    """While paused a hand drags time back to before a fall; the same bits then fall at the same instant again."""
    lab = open_page(served.url, height=TALL).until_furnished()
    lab.slide("force (N)", "End")
    lab.press("p")
    lab.expect_status("fallen at [0-9.]+ s: ")
    fallen = seconds("fallen at ([0-9.]+) s", lab.status.inner_text())
    lab.pause()
    end = lab.time
    lying = lab.picture(CANVAS)
    target = fallen - 0.3  # the push began 0.55 s before the fall
    scrub(lab, target - end)
    lab.expect_text("s before the end")
    lab.until(lambda: abs(lab.time - target) < 0.1, f"the slider does not come to {target:.2f} s")
    lab.picture_with(lambda now: differing(now, lying) > 0.02, "the robot still lies")
    line = lab.page.get_by_text("simulated time").inner_text()
    shown, behind = seconds(r"time\s*([0-9.]+)", line), seconds("([0-9.]+) s before the end", line)
    assert shown == pytest.approx(target, abs=0.1)  # a pixel of the slider is a few hundredths of a second
    assert shown + behind == pytest.approx(end, abs=0.02)
    assert "fallen" not in lab.status.inner_text()
    lab.press("b")
    lab.expect_gone("s before the end")
    lab.expect_status(f"fallen at {fallen:.2f} s")


def test_on_a_phone(served: Served, open_page: Opener) -> None:
    lab = open_page(served.url, 390, 844).until_furnished()
    pause_in_saturation(lab)
    lab.save(OUTPUT / "phone_test.png")
    assert box_of(lab.status)["y"] < box_of(lab.page.get_by_role("tab", name="Push"))["y"]
    for words in ("Push (P)", "+20 ms"):
        box = box_of(lab.page.get_by_role("button", name=words, exact=True).first)
        assert box["x"] >= 0
        assert box["x"] + box["width"] <= 390


def assert_below_the_picture(lab: LabPage) -> None:
    """Status, time and its buttons stand between the panels, and lower than whatever the start view shows."""
    canvas = box_of(lab.page.locator("canvas").first)
    for place in (
        lab.status,
        *(lab.page.get_by_role("button", name=name, exact=True) for name in ("Pause", "1/8")),
    ):
        box = box_of(place)
        assert canvas["x"] <= box["x"] < box["x"] + box["width"] <= canvas["x"] + canvas["width"]
        assert canvas["y"] + canvas["height"] - BAR_HEIGHT <= box["y"] < canvas["y"] + canvas["height"]


def box_of(place: Locator) -> FloatRect:
    """Where something is on the page."""
    box = place.bounding_box()
    assert box is not None
    return box


def settled_children(pid: int) -> set[int]:
    """All processes below a process, once none has come or gone for a second: tabs of other tests have closed."""
    last, since = children(pid), time.monotonic()
    end = since + 20.0
    while time.monotonic() - since < 1.0 and time.monotonic() < end:
        time.sleep(0.05)
        if (now := children(pid)) != last:
            last, since = now, time.monotonic()
    return last


def seconds(pattern: str, words: str) -> float:
    """The number in a line of the page."""
    found = re.search(pattern, words)
    assert found is not None, f"no {pattern} in {words!r}"
    return float(found[1])


def scrub(lab: LabPage, target: float) -> None:
    """Drag the look-back slider from its end to some seconds before it (below 0)."""
    row = lab.page.locator("label:text-is('look back (s)')").first
    thumb = lab.page.locator(f"[id='{row.get_attribute('for')}'] [role=slider]").first
    least = float(thumb.get_attribute("aria-valuemin") or "nan")
    track = thumb.locator("xpath=..").bounding_box()
    knob = thumb.bounding_box()
    assert track is not None
    assert knob is not None
    y = knob["y"] + knob["height"] / 2
    lab.page.mouse.move(knob["x"] + knob["width"] / 2, y)
    lab.page.mouse.down()
    for part in (0.5, 1.0):
        lab.page.mouse.move(track["x"] + track["width"] * (1.0 - part * target / least), y)
    lab.page.mouse.up()


def pause_in_saturation(lab: LabPage) -> float:
    """Stop time 120 ms after the push began: the CoP is on the border, the CMP ahead of it; the time, s."""
    lab.pause()
    paused = lab.time
    lab.press("p")
    for steps in range(1, 7):
        lab.press("l")
        lab.expect_time(paused + 0.02 * steps)
        lab.page.wait_for_timeout(REPEATED)
    lab.expect_status("CoP on the toes: angular goal gives way")
    return lab.time
