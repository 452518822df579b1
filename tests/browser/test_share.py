"""A person gives a run away: as a code, as an address, as files; and opens what somebody else has given."""

from __future__ import annotations

import io
import json
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Download, expect

from momentum_lab.events import ApplyPush, LoggedEvent, SetGains
from momentum_lab.physics.push import Push
from momentum_lab.replay import replayed, trace_agreement
from momentum_lab.run_file import Run, read_run, run_of, run_of_trace
from momentum_lab.scenario import Scenario
from momentum_lab.share_code import from_code, link, to_code
from momentum_lab.trace import load_trace
from tests.browser.conftest import OUTPUT, Opener, Served
from tests.browser.lab_page import PATIENCE, TALL, LabPage

pytestmark = [
    pytest.mark.browser,
    pytest.mark.timeout(240),
    pytest.mark.filterwarnings("ignore:Queued a:UserWarning"),
]


def code_of(lab: LabPage) -> str:
    lab.click("Make a code")
    field = lab.page.get_by_label("code to copy")
    expect(field).to_have_value(re.compile("lab1-"), timeout=PATIENCE)
    return field.input_value()


def type_code(lab: LabPage, text: str) -> None:
    """Into the field that has no text yet; its label does not know it."""
    label = lab.page.locator("label:text-is('code')").last
    label.locator("xpath=ancestor::div[contains(@class, 'Flex')][1]//input").fill(text)


def choose_file(lab: LabPage, what: str) -> None:
    lab.page.get_by_role("combobox", name="file").evaluate("b => b.click()")
    lab.page.get_by_role("option", name=what).evaluate("o => o.click()")


def downloaded(lab: LabPage, what: str, folder: Path) -> Path:
    choose_file(lab, what)
    button = lab.page.get_by_role("button", name="Download", exact=True)
    expect(button).to_be_enabled(timeout=PATIENCE)  # not before the file before it has gone out
    with lab.page.expect_download(timeout=PATIENCE) as caught:
        lab.click("Download")
    download: Download = caught.value
    path = folder / download.suggested_filename
    download.save_as(path)
    return path


def test_files_and_codes_hold_the_run(served: Served, open_page: Opener, tmp_path: Path) -> None:
    lab = open_page(served.url, height=TALL).until_furnished()  # a list does not open out of sight
    lab.press("p")
    lab.expect_text("Last push")
    lab.expect_com_travel(1.0)  # the push is over
    lab.pause()
    lab.open_tab("5", "Share")
    code = code_of(lab)
    lab.save(OUTPUT / "share.png")

    trace = load_trace(downloaded(lab, "trace, every tick (.npz)", tmp_path))
    run = from_code(code)
    session, _ = replayed(run)
    assert trace_agreement(trace, session).agrees
    assert len(trace.columns["time"]) == run.ticks
    assert np.abs(trace.columns["push_wrench"][:, 0]).max() > 200.0
    assert run_of_trace(trace) == run
    assert read_run(downloaded(lab, "run file (.json)", tmp_path)) == run
    report = downloaded(lab, "report (.html)", tmp_path).read_text()
    assert report.startswith("<!doctype html>")
    assert "apply push" in report
    assert code in report
    plots = Image.open(io.BytesIO(downloaded(lab, "picture of the plots (.png)", tmp_path).read_bytes()))
    assert plots.size[0] > 600
    view = np.array(Image.open(downloaded(lab, "picture of the view (.png)", tmp_path)))
    assert (view.min(axis=2) < 100).mean() > 0.005  # there is a robot in it
    lab.expect_text("paused")


def test_an_address_opens_the_run(served: Served, open_page: Opener) -> None:
    """A run of a second, played here: the page plays it too, stops where it ends, and hands on the same run."""
    events = (
        LoggedEvent(50, SetGains({"linear_damping": 11.0})),
        LoggedEvent(200, ApplyPush(Push(force=150.0))),
    )
    run = run_of(replayed(Run(Scenario("theirs"), events, ticks=1000))[0])
    lab = open_page(link(served.url, to_code(run))).until_furnished()
    lab.expect_text("The opened run ends here, with the same bits")
    lab.expect_text(r"simulated time\s*1\.00 s · paused")
    lab.expect_com_travel(0.5)
    lab.save(OUTPUT / "opened.png")
    lab.open_tab("5", "Share")
    assert from_code(code_of(lab)) == run
    lab.expect_text("Its last sample has the same bits as the original")


def test_what_is_no_run_is_told_and_nothing_is_lost(
    served: Served, open_page: Opener, tmp_path: Path
) -> None:
    lab = open_page(served.url).until_furnished()
    lab.pause()
    simulated = lab.time
    lab.open_tab("5", "Share")
    type_code(lab, "lab1-AAAA")
    lab.page.wait_for_timeout(500)
    lab.click("Open the code")
    lab.expect_text("letters are missing or changed")
    lab.dismiss_notices()
    bad = tmp_path / "bad.json"
    bad.write_text(json.dumps({"format": "momentum_lab run", "version": 1, "scenario": {"name": 3}}))
    lab.page.locator("input[type=file]").first.set_input_files(bad)
    lab.expect_text("name in bad.json: got 3; allowed: text")
    assert lab.time == simulated
    good = tmp_path / "good.toml"
    good.write_text('format = "momentum_lab run"\nversion = 1\n[scenario]\nname = "mine"\nrobot = "g1"\n')
    lab.page.locator("input[type=file]").first.set_input_files(good)
    lab.page.evaluate("document.activeElement.blur()")  # keys stay with a field that has the focus
    lab.open_tab("2", "Control")
    expect(lab.page.locator("input[value='mine']").first).to_be_attached(timeout=PATIENCE)
    lab.expect_status("standing")
