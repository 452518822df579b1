"""What holds the robot back, as text that keeps its place."""

from __future__ import annotations

import re

import msgspec
import numpy as np
import pytest

from momentum_lab.active_bounds import Active, Bounds, Goal
from momentum_lab.app.bounds_panel import BoundsPanel, in_html
from momentum_lab.app.playback import Playback
from momentum_lab.events import ApplyPush
from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario
from tests.app.fakes import FakeGui


class Desk:
    def __init__(self) -> None:
        self.now = 0.0
        self.gui = FakeGui()
        self.panel = BoundsPanel(self.gui, lambda: self.now)
        self.playback = Playback(Scenario("stand", robot="g1"))

    @property
    def text(self) -> str:
        return self.gui.html[0].content

    def see(self, **changes) -> None:
        playback = self.playback
        truth = msgspec.structs.replace(playback.truth(1.0), **changes)
        self.panel.see(playback.shown, playback.session.robot, truth)


@pytest.fixture
def desk() -> Desk:
    return Desk()


def words_of(text: str) -> str:
    return re.sub(r"\s+", " ", re.sub(r"<[^>]*>", " ", text))


def test_a_robot_at_rest_is_held_by_nothing(desk):
    desk.see()
    assert "left foot – right foot – joints –" in words_of(desk.text)
    assert "linear rate, ahead (N) 0 0 0" in words_of(desk.text)


def test_a_push_brings_the_toes_and_what_was_asked_and_granted(desk):
    desk.playback.take(ApplyPush(Push(force=120.0, duration=0.1)))
    desk.playback.tick(100)
    desk.see()
    words = words_of(desk.text)
    assert "left foot CoP on the toes right foot CoP on the toes" in words
    cop = desk.playback.shown["cop_desired"] - desk.playback.shown["cop_admissible"]
    assert numbers(words, "CoP ahead (mm)")[2] == pytest.approx(1e3 * cop[0], abs=1.0)


@pytest.mark.parametrize("direction", [0.0, 180.0, 90.0, -90.0])
def test_what_was_asked_less_what_was_granted_is_what_is_missing_axis_by_axis(desk, direction):
    desk.playback.take(ApplyPush(Push(force=120.0, duration=0.1, direction_deg=direction)))
    desk.playback.tick(100)
    desk.see()
    words, sample = words_of(desk.text), desk.playback.shown
    shown = {}
    for row, name in enumerate(
        [f"linear rate, {axis} (N)" for axis in ("ahead", "left", "up")]
        + [f"angular rate about {axis} (N m)" for axis in ("ahead", "left", "up")]
    ):
        asked, granted, missing = shown[name] = numbers(words, name)
        assert asked - granted == missing
        # The robot looks along x: its axes are the world's.
        assert asked == pytest.approx(sample["momentum_rate_desired"][row], abs=2.0)
        assert granted == pytest.approx(sample["momentum_rate_admissible"][row], abs=2.0)
    # What is asked for is against the push.
    towards = shown["linear rate, left (N)" if abs(direction) == 90.0 else "linear rate, ahead (N)"][0]
    assert (towards < -10.0) == (direction in (0.0, 90.0))
    assert (towards > 10.0) == (direction in (180.0, -90.0))


def test_numbers_keep_their_width():
    def width(value: float) -> int:
        goal = Goal("linear rate, ahead", "N", value, 0.0)
        text = re.sub("<[^>]*>", "|", in_html(Bounds((), (), (goal,), ()), ()))
        return len(text.split("|linear rate, ahead (N)|")[1].split("|")[1])

    assert len({width(value) for value in (0.0, -0.4, 7.0, -77.0, 777.0, -1234.0, 12345.0)}) == 1


def numbers(words: str, name: str) -> list[float]:
    """Asked, granted and missing of a goal on the screen."""
    found = re.search(re.escape(name) + 3 * r" (−?\d+)", words)
    assert found is not None, words
    return [float(each.replace("−", "-")) for each in found.groups()]


def test_it_changes_a_few_times_a_second_and_at_once_in_a_pause(desk):
    desk.playback.take(ApplyPush(Push(force=120.0, duration=0.1)))
    texts = []
    for _ in range(40):  # a second of frames
        desk.now += 0.025
        desk.playback.tick(25)
        desk.see()
        texts.append(desk.text)
    assert 5 <= len({id(text) for text in texts}) <= 10
    before = desk.text
    desk.playback.tick(1)
    desk.see(behind=0.4)
    assert desk.text == before
    desk.playback._look_back(920)
    desk.see(playing=False)
    assert desk.text != before


def test_the_lines_are_always_as_many(desk):
    many = tuple(Active(f"joint_{i}", "torque limit") for i in range(9))
    goal = Goal("linear rate, ahead", "N", 1234.5, np.nan)
    nothing = Bounds(((), ()), (), (goal,), ())
    everything = Bounds(((Active("left foot", "slides"),) * 3, ()), many, (goal,), ())
    few, all_of_them = (in_html(bounds, ("left", "right")) for bounds in (nothing, everything))
    assert few.count("<tr>") == all_of_them.count("<tr>")
    assert "joint_0: torque limit; joint_1: torque limit" in all_of_them
    assert "1234" in few
    assert words_of(few).count("–") == 5  # three holders, and two numbers that are none


def test_why_there_is_no_answer_is_told(desk):
    failure = (
        "cannot be met: friction of the left foot (short by 0.1); holding the posture with joint springs"
    )
    row = desk.playback.latest.row
    desk.see(failure=failure)
    assert "no answer" not in desk.text  # it was at another tick
    row[desk.playback.session.recording.slices["solver_failed"]] = 1.0
    desk.see(failure=failure, playing=False)
    assert f"no answer: {failure}" in words_of(desk.text)


def test_text_of_strangers_is_no_html():
    evil = Active("<b>", "<script>")
    text = in_html(Bounds(((evil,),), (evil,), (), ()), ("<i>",), "<script>")
    assert "<script>" not in text
    assert "<i>" not in text
