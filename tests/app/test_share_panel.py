"""The share tab: codes and files out and in, and what is wrong told without losing anything."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable
from types import SimpleNamespace

import pytest

from momentum_lab.app import share_panel
from momentum_lab.app.exporter import finished
from momentum_lab.app.kept_before import WAY_BACK
from momentum_lab.app.playback import Playback
from momentum_lab.app.reel import Reel
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.share_panel import SharePanel, Sharing, file_name, opened_words
from momentum_lab.app.wire import Opened, RunTaken
from momentum_lab.events import ApplyPush, Pause, SetPriority
from momentum_lab.physics.push import Push
from momentum_lab.run_file import Run, decoded, encoded
from momentum_lab.scenario import Scenario
from momentum_lab.share_code import from_code, to_code
from tests.app.fakes import FakeGui, FakeHandle

URL = "http://127.0.0.1:8080"


class Desk:
    def __init__(self) -> None:
        self.gui, self.told, self.opened, self.sent = FakeGui(), [], [], {}
        self.playback = Playback(Scenario("My run!", robot="g1"))
        self.address = FakeHandle(value="")
        self.begun, self.lines, self.stops = [], [], False
        self.said, self.warned, self.taken_back = [], [], []
        sharing = Sharing(
            self.playback.taken,
            self.playback.recorded,
            self.opened.append,
            self.told.append,
            lambda name, content: self.sent.update({name: content}),
            lambda: b"picture",
            self.reel,
            self.film,
            URL,
            lambda: self.taken_back.append(True),
            self.said.append,
            self.warned.append,
        )
        self.panel = SharePanel(self.gui, sharing, self.address, clock=itertools.count(0.0, 10.0).__next__)

    def reel(self, taken: RunTaken) -> Reel:
        run = finished(taken)
        return Reel.of(run, LoadedRobot(run.robot, (), run.recording.layout))

    def film(self, reel: Reel, height: int, report: Callable[[float], None]) -> bytes:
        self.begun.append(self.gui.html[-1].content)
        for done in (0.25, 0.5, 1.0):
            report(done)
            self.lines.append(self.gui.html[-1].content)
            if self.stops:
                assert self.gui.widgets["Stop the film"].visible
                self.do("Stop the film")
        return b"film of %d" % height

    def do(self, label: str, value: object = True) -> None:
        self.gui.widgets[label].set_by_person(value)

    @property
    def code(self) -> str:
        return re.findall('data-code="([^"]+)"', self.gui.html[1].content)[0]


@pytest.fixture
def desk() -> Desk:
    return Desk()


def test_a_code_holds_all_that_was_done_and_what_waits(desk):
    desk.playback.take(ApplyPush(Push(force=20.0)))
    desk.playback.tick(30)
    desk.playback.take(Pause())
    desk.playback.take(SetPriority(0.5))
    desk.do("Make a code")
    run = from_code(desk.code)
    assert [(entry.tick, entry.event) for entry in run.events] == [
        (1, ApplyPush(Push(force=20.0))),
        (31, SetPriority(0.5)),
    ]
    assert run.ticks == 31
    assert f'value="{URL}/?run={desk.code}"' in desk.gui.html[1].content


def test_codes_are_opened_from_the_field_and_from_the_address(desk):
    run = Run(Scenario("other"))
    desk.gui.widgets["code"].value = to_code(run)
    desk.do("Open the code")
    desk.address.set_by_person(to_code(run))
    assert desk.opened == [run, run]
    assert desk.told == []


@pytest.mark.parametrize("code", ["hello", "lab1-AAAA", "lab9-x"])
def test_an_address_that_opens_nothing_says_so_until_it_is_closed(desk, code):
    desk.address.set_by_person(code)
    (words,) = desk.warned
    assert words.startswith("The address of this page opens no run. code: got ")
    assert (desk.told, desk.opened) == ([], [])


def test_a_code_of_the_run_before_does_not_stay(desk):
    desk.do("Make a code")
    assert desk.code
    desk.gui.widgets["code"].value = to_code(Run(Scenario("other")))
    desk.do("Open the code")
    assert desk.gui.html[1].content == ""
    assert desk.gui.widgets["code"].value == ""


def test_what_was_before_is_told_once_and_can_be_taken_back(desk):
    button, truth = desk.gui.widgets["Take back"], desk.playback.truth(1.0)
    desk.panel.follow(truth, ())
    assert not button.visible
    for _ in range(3):
        desk.panel.follow(truth, ("mine until 7.02 s",))
    assert desk.said == [f"My run! is open now. Your run (mine until 7.02 s) is kept: {WAY_BACK}."]
    assert button.visible
    desk.do("Make a code")
    button.set_by_person(True)
    assert desk.taken_back == [True]
    assert desk.gui.html[1].content == ""  # a code of the opened run
    desk.panel.follow(truth, ())
    assert not button.visible
    assert len(desk.said) == 1


def test_files_are_opened(desk):
    run = Run(Scenario("other"))
    desk.do("Open a run file", SimpleNamespace(name="run.json", content=encoded(run)))
    assert desk.opened == [run]


@pytest.mark.parametrize(
    ("label", "value", "message"),
    [
        ("Open the code", "nonsense", "code: got nonsense; allowed: a code that this lab has made"),
        ("Open a run file", SimpleNamespace(name="x.npz", content=b"PK"), "recording: got x.npz"),
        (
            "Open a run file",
            SimpleNamespace(name="x.doc", content=b"PK"),
            "run file: got x.doc; allowed: a file",
        ),
    ],
)
def test_what_is_no_run_is_told(desk, label, value, message):
    desk.gui.widgets["code"].value = "nonsense"
    desk.do(label, value)
    assert desk.told[0].startswith(message)
    assert desk.opened == []
    desk.do("Make a code")  # nothing is stuck
    assert from_code(desk.code).scenario.name == "My run!"


def test_the_run_file_and_the_picture_are_sent(desk):
    desk.gui.widgets["file"].value = "run file (.json)"
    desk.do("Download")
    desk.gui.widgets["file"].value = "picture of the view (.png)"
    desk.do("Download")
    assert list(desk.sent) == ["my-run-g1.json", "my-run-g1-view.png"]
    assert decoded("r.json", desk.sent["my-run-g1.json"]).ticks == 1
    assert not desk.gui.widgets["Download"].disabled


def test_what_a_table_leaves_out_is_told_until_the_next_download(desk, monkeypatch):
    thin = b"time [s],com/x [m]\r\n0,0\r\n0.006,0\r\n0.012,0\r\n"
    monkeypatch.setattr(share_panel, "made_elsewhere", lambda kind, taken: thin)
    desk.gui.widgets["file"].value = "table (.csv)"
    desk.do("Download")
    assert desk.sent == {"my-run-g1.csv": thin}
    assert "one tick in 6, a row each 6 ms" in desk.gui.html[-1].content
    assert desk.gui.html[-1].visible
    desk.gui.widgets["file"].value = "run file (.json)"
    desk.do("Download")
    assert not desk.gui.html[-1].visible


@pytest.mark.parametrize(("what", "height"), [("film (.mp4)", 720), ("small film (.mp4)", 360)])
def test_a_film_says_how_far_it_is(desk, what, height):
    desk.playback.tick(5)
    desk.gui.widgets["file"].value = what
    desk.do("Download")
    assert [re.findall(r"\d+ %", line) for line in desk.lines] == [["25 %"], ["50 %"], ["100 %"]]
    # A picture every ten seconds, and three quarters, a half, nothing left.
    left = [re.findall(r"\d+ s to go", line) for line in desk.lines]
    assert left == [["30 s to go"], ["20 s to go"], ["0 s to go"]]
    assert desk.sent == {"my-run-g1.mp4": b"film of %d" % height}
    assert not desk.gui.html[-1].visible
    assert not desk.gui.widgets["Stop the film"].visible


def test_before_a_film_begins_it_says_from_when_to_when_it_is_and_how_long_it_takes(desk):
    desk.playback.take(ApplyPush(Push(force=20.0)))
    desk.playback.tick(290)  # a picture each 40 ms: 0, 40, ..., 280
    desk.gui.widgets["file"].value = "film (.mp4)"
    desk.do("Download")
    desk.do("Download")
    assert all("Film from 0.0 s to 0.3 s of the run" in line for line in (*desk.begun, *desk.lines))
    assert "8 pictures; the first one tells how long it takes" in desk.begun[0]
    assert "8 pictures; it takes about 30 s" in desk.begun[1]  # what the first film took


def test_a_film_without_a_push_says_so(desk):
    desk.playback.tick(5)
    desk.gui.widgets["file"].value = "small film (.mp4)"
    desk.do("Download")
    assert "in which there was no push" in desk.begun[0]


def test_a_film_can_be_stopped_and_taken_again(desk):
    desk.playback.tick(5)
    desk.stops = True
    desk.gui.widgets["file"].value = "film (.mp4)"
    desk.do("Download")
    assert len(desk.lines) == 1
    assert desk.sent == {}
    assert desk.told == ["The film was stopped."]
    desk.stops = False
    desk.do("Download")
    assert list(desk.sent) == ["my-run-g1.mp4"]


def test_names_of_files_are_harmless():
    assert file_name(Run(Scenario("../../etc", robot="/home/me/My Robot.toml"))) == "etc-my-robot"
    assert file_name(Run(Scenario("ä", robot="ß"))) == "run"


def test_how_far_an_opened_run_is():
    assert "until 8.10 s" in opened_words(Opened(8.1))
    assert "same bits" in opened_words(Opened(8.1, True, True))
    assert "other bits" in opened_words(Opened(8.1, True, False))
    assert "Other things were done" in opened_words(Opened(8.1, True, None))
