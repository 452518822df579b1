"""The widgets of the model errors: sliders from declarations, the events they ask for, what they show."""

from __future__ import annotations

import re

import msgspec
import pytest

from momentum_lab.app.mismatch_panel import MismatchPanel
from momentum_lab.app.playback import Playback
from momentum_lab.events import Branch, LookBack, Pause, SetMismatch
from momentum_lab.physics.mismatch import EXACT, Mismatch, model_errors
from momentum_lab.scenario import Scenario
from tests.app.fakes import FakeGui


class Desk:
    def __init__(self) -> None:
        self.gui, self.posted = FakeGui(), []
        self.truth = Playback(Scenario("stand")).truth(1.0)
        self.panel = MismatchPanel(self.gui, self.posted.append, self.truth)

    def slider(self, name: str):
        words = name.removesuffix("_ms").replace("_", " ")
        return next(w for label, w in self.gui.widgets.items() if label.split(" (")[0] == words)

    def said(self) -> list[str]:
        """What is written below the folder, where it can be seen."""
        return [re.sub("<[^>]*>", "", line.content) for line in self.gui.html[1:] if line.visible]


@pytest.fixture
def desk() -> Desk:
    return Desk()


@pytest.mark.parametrize("error", model_errors().values(), ids=lambda error: error.name)
def test_every_error_has_a_slider_with_its_range_unit_and_help(desk, error):
    slider = desk.slider(error.name)
    assert (slider.min, slider.max, slider.step) == (error.low, error.high, error.step)
    assert slider.value == error.default
    assert error.help in slider.hint
    assert slider.label.endswith(f"({error.unit})") or error.unit == "1"
    slider.set_by_person(error.high)
    assert desk.posted == [SetMismatch(error.name, error.high)]


def test_it_shows_what_is_the_case_and_takes_it_back(desk):
    desk.panel.follow(msgspec.structs.replace(desk.truth, mismatch=Mismatch(-0.1, imu_noise=1e-3)))
    assert desk.slider("mass_error").value == -0.1
    assert desk.slider("imu_noise").value == 1e-3
    assert desk.said() == ["Model errors: mass error -0.1, imu noise 0.001 rad."]
    desk.gui.widgets["No model errors"].set_by_person(True)
    assert desk.posted == [SetMismatch("mass_error", 0.0), SetMismatch("imu_noise", 0.0)]
    desk.panel.follow(desk.truth)
    assert desk.said() == []


def test_a_choice_while_looking_back_holds_for_the_branch():
    playback = Playback(Scenario("stand"))
    playback.tick(50)
    playback.take(Pause())
    playback.take(LookBack(0.03))
    playback.take(SetMismatch("mass_error", 0.1))
    assert playback.truth(1.0).mismatch == Mismatch(mass_error=0.1)
    assert playback.session.choices.mismatch == EXACT
    playback.take(Branch())
    assert playback.session.choices.mismatch == Mismatch(mass_error=0.1)
    assert playback.session.log[-1].event == SetMismatch("mass_error", 0.1)
