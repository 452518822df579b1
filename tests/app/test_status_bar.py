"""Status and time: readable, truthful, and with the right buttons."""

from __future__ import annotations

import re
from typing import Any

import msgspec
import pytest

from momentum_lab.app.playback import Playback
from momentum_lab.app.status_bar import INVITATION, StatusBar
from momentum_lab.app.wire import Fallen
from momentum_lab.events import Branch, LookBack, Pause, Play, Reset, SetSpeed, StepOnce
from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario
from momentum_lab.status import Status
from tests.app.fakes import FakeGui

STANDING = Status("standing", "standing", "green")
BORDER = Status("border", "CoP on the toes: angular goal gives way by 88 N m", "orange")


class Bar:
    def __init__(self) -> None:
        self.gui = FakeGui()
        self.posted: list[Any] = []
        self.now = 0.0
        self.bar = StatusBar(self.gui, self.posted.append, clock=lambda: self.now)
        self.truth = Playback(Scenario("s")).truth(1.0)
        self.simulated = 0.0

    def show(self, status: Status, seconds: float = 0.2, **changes: Any) -> str:
        self.truth = msgspec.structs.replace(self.truth, **changes)
        self.now += seconds
        self.simulated += seconds
        self.bar.follow(self.truth, status, self.simulated)
        return self.text

    @property
    def text(self) -> str:
        content = " ".join(handle.content for handle in self.gui.html if handle.visible)
        return re.sub("<span[^>]*>|</span>", "", content)

    def press(self, group: str, name: str) -> None:
        assert name in self.gui.widgets[group].options
        self.gui.widgets[group].set_by_person(name)


@pytest.fixture
def bar() -> Bar:
    return Bar()


def test_it_invites_before_the_first_push_and_tells_the_last_one_after_it(bar):
    assert INVITATION in bar.show(STANDING)
    text = bar.show(STANDING, push=Push(force=217.0, direction_deg=90.0))
    assert INVITATION not in text
    assert "Last push: 217 N for 100 ms to the left." in text
    text = bar.show(STANDING, push=Push(force=50.0, direction_deg=30.0, body="left_hand"))
    assert "50 N for 100 ms 30° from forward on the left hand." in text


def test_a_push_that_is_tried_is_told_instead_of_the_invitation(bar):
    bar.bar.follow(bar.truth, STANDING, 0.1, "Trying the push on a copy: 40 %.")
    assert "Trying the push on a copy: 40 %." in bar.text
    assert INVITATION not in bar.text


def test_a_short_saturation_stays_readable(bar):
    bar.show(STANDING)
    assert "angular goal gives way by 88 N m" in bar.show(BORDER)
    assert "angular goal gives way by 88 N m" in bar.show(STANDING, 0.3)
    assert "angular goal" not in bar.show(STANDING, 0.8)


def test_worse_news_are_told_at_once(bar):
    bar.show(BORDER)
    fallen = Status("fallen", "fallen at 1.32 s: the CoM sank to 0.5 m", "vermillion")
    assert "✖ fallen at 1.32 s" in bar.show(fallen, fall=Fallen(1.32, "the CoM sank to 0.5 m"))


def test_a_pause_shows_the_present_moment(bar):
    bar.show(BORDER)
    assert "standing" in bar.show(STANDING, 0.2, playing=False)


def test_one_click_stands_the_robot_up(bar):
    button = bar.gui.widgets["Stand up again  (R)"]
    bar.show(STANDING)
    assert not button.visible
    bar.show(Status("fallen", "fallen at 1 s: x", "vermillion"), fall=Fallen(1.0, "x"))
    assert button.visible
    button.set_by_person(True)
    assert bar.posted == [Reset()]
    bar.simulated = 0.0
    assert "standing" in bar.show(STANDING, fall=None)
    assert not button.visible


def test_a_stopped_simulation_can_be_stood_up_too(bar):
    bar.show(Status("stopped", "stopped: x", "black"), stopped="x", playing=False)
    assert bar.gui.widgets["Stand up again  (R)"].visible


def test_buttons_and_what_they_post(bar):
    bar.show(STANDING)
    for name in ("Pause", "+1 ms", "+20 ms", "Stand up"):
        bar.press("time", name)
    bar.show(STANDING, playing=False)
    bar.press("time", "Play")
    for name in ("1/8", "1/4", "1/2", "1"):
        bar.press("speed", name)
    assert bar.posted == [
        Pause(),
        StepOnce(1),
        StepOnce(20),
        Reset(),
        Play(),
        SetSpeed(0.125),
        SetSpeed(0.25),
        SetSpeed(0.5),
        SetSpeed(1.0),
    ]


def test_the_key_plays_what_is_paused_and_pauses_what_plays(bar):
    bar.show(STANDING)
    bar.bar.toggle()
    bar.show(STANDING, playing=False)
    bar.bar.toggle()
    assert bar.posted == [Pause(), Play()]


def test_figures_change_ten_times_a_second(bar):
    texts = {bar.show(STANDING, 0.025) for _ in range(40)}
    assert len(texts) <= 11


def test_the_end_of_the_process_is_told(bar):
    bar.bar.end()
    assert "the simulation has ended: reload the page" in bar.text


def test_looking_back(bar):
    """The slider asks for an instant; the button to go on from there is there while there is one."""
    slider, branch = bar.gui.widgets["look back (s)"], bar.gui.widgets["Go on from here  (B)"]
    bar.show(STANDING)
    assert not branch.visible
    slider.set_by_person(-1.25)
    assert bar.posted == [LookBack(1.25)]
    assert "1.25 s before the end" in bar.show(STANDING, seconds=1.0, behind=1.25, playing=False)
    assert branch.visible
    branch.set_by_person(True)
    assert bar.posted[-1] == Branch()
    bar.show(STANDING, seconds=1.0, behind=0.0, playing=True)
    assert slider.value == 0.0
    assert not branch.visible


def test_pushes_are_marked_along_the_slider(bar):
    bar.show(STANDING, seconds=4.0, pushed=(1.0, 3.0), playing=False)
    assert places(bar) == [pytest.approx(40.0), pytest.approx(80.0)]  # 3 s and 1 s before the end, of 5
    bar.show(STANDING, seconds=-2.0, behind=2.0)
    assert places(bar) == [pytest.approx(40.0), pytest.approx(80.0)]  # looking back moves no push
    bar.show(STANDING, seconds=98.0, behind=0.0, pushed=(1.0, 70.0))
    assert places(bar) == [pytest.approx(50.0)]  # the first is out of reach
    seen = [places(bar) for _ in range(40) if bar.show(STANDING, 0.025, playing=True)]
    assert 1 < len({tuple(each) for each in seen}) <= 3  # about once a second while time runs


def places(bar: Bar) -> list[float]:
    """Where pushes are marked, in percent of the slider."""
    (strip,) = (handle.content for handle in bar.gui.html if 'class="lab-strip"' in handle.content)
    return [float(place) for place in re.findall(r"data-push[^>]*left:([0-9.]+)%", strip)]


def test_what_going_on_would_forget_is_on_the_button(bar):
    button = bar.gui.widgets["Go on from here  (B)"]
    bar.show(STANDING, behind=1.0, playing=False)
    assert button.label == "Go on from here  (B)"
    bar.show(STANDING, forgotten=(1.5,))
    assert button.label == "Go on without 1 later push  (B)"
    bar.show(STANDING, forgotten=(1.5, 2.0, 3.0, 4.0, 5.0))
    assert button.label == "Go on without 5 later pushes  (B)"
    assert "Forgotten: pushed at 1.50 s, 2.00 s, 3.00 s and 2 more." in button.hint
    bar.show(STANDING, behind=0.0, forgotten=())
    assert button.label == "Go on from here  (B)"
    assert "Forgotten" not in button.hint


def test_the_slider_reaches_as_far_back_as_there_is(bar):
    slider = bar.gui.widgets["look back (s)"]
    bar.show(STANDING, seconds=4.0)
    assert slider.min == -5.0
    bar.show(STANDING, seconds=3.0)
    assert slider.min == -10.0
    bar.show(STANDING, seconds=0.0, behind=4.0)
    assert slider.min == -15.0
    bar.show(STANDING, seconds=200.0, behind=0.0)
    assert slider.min == -60.0
