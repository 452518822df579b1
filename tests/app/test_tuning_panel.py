"""Presets, marks and one's own presets, as the widgets do them."""

from __future__ import annotations

import msgspec
import pytest

from momentum_lab.app.playback import Playback
from momentum_lab.app.tuning_panel import TuningPanel
from momentum_lab.app.wire import Truth
from momentum_lab.control.presets import preset_named
from momentum_lab.events import Event, SetGains
from momentum_lab.scenario import Scenario
from tests.app.fakes import FakeGui


class Desk:
    """A panel and a session that does what it is asked for."""

    def __init__(self) -> None:
        self.gui, self.posted, self.told = FakeGui(), [], []
        self.playback = Playback(Scenario("stand", robot="g1"))
        self.panel = TuningPanel(self.gui, self.post, self.told.append, self.truth)

    @property
    def truth(self) -> Truth:
        return self.playback.truth(1.0)

    def post(self, event: Event) -> None:
        self.posted.append(event)
        self.playback.take(event)

    def do(self, label: str, value: object = True) -> None:
        """Use a widget, and look again."""
        self.gui.widgets[label].set_by_person(value)
        self.panel.follow(self.truth)

    def shown(self) -> list[str]:
        """The changes on the screen."""
        return [w.label for n, w in self.gui.widgets.items() if n.endswith("as before") and w.visible]


@pytest.fixture
def desk(tmp_path, monkeypatch) -> Desk:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    return Desk()


def test_a_preset_sets_all_its_gains_at_once(desk):
    desk.do("preset", "stiff")
    assert desk.posted == [SetGains(preset_named("stiff", "computed-torque").gains)]
    assert desk.truth.gains == preset_named("stiff", "computed-torque").values("computed-torque")
    assert desk.shown() == []
    assert "those of stiff" in desk.gui.html[-1].content


def test_changes_count_from_the_preset_and_are_marked(desk):
    desk.do("preset", "stiff")
    desk.do("linear damping (1/s)", 20.0)
    assert desk.shown() == ["linear damping: 12 → 20 1/s"]
    slider = desk.gui.widgets["linear damping (1/s)"]
    assert slider.label == "● linear damping (1/s)"
    desk.do("linear_damping as before")
    assert desk.truth.gains["linear_damping"] == 12.0
    assert slider.label == "linear damping (1/s)"
    assert desk.shown() == []


def test_damping_ratio_and_frequency_set_the_gains(desk):
    ratio, frequency = desk.gui.widgets["damping ratio ζ"], desk.gui.widgets["frequency ω (1/s)"]
    assert (ratio.value, frequency.value) == (1.0, 4.0)
    desk.do("frequency ω (1/s)", 5.0)
    assert desk.posted == [SetGains({"linear_damping": 10.0, "linear_stiffness": 25.0})]
    desk.do("damping ratio ζ", 0.5)
    assert desk.posted[-1] == SetGains({"linear_damping": 5.0, "linear_stiffness": 25.0})


def test_own_presets(desk):
    desk.do("friction", 0.3)
    desk.do("name", "slippery")
    desk.do("Save as a preset")
    assert desk.told == []
    assert preset_named("slippery", "computed-torque").gains == {"friction": 0.3}
    assert desk.gui.widgets["preset"].options[-1] == "slippery"
    assert desk.gui.widgets["preset"].value == "slippery"
    assert desk.shown() == []


def test_a_name_that_cannot_be_is_told_and_nothing_is_lost(desk):
    desk.do("friction", 0.3)
    desk.do("name", "../up")
    desk.do("Save as a preset")
    assert "1 to 40 small letters" in desk.told[0]
    assert desk.truth.gains["friction"] == 0.3


def test_controllers_without_such_a_law_have_no_such_sliders():
    gui = FakeGui()
    truth = Playback(Scenario("stand", robot="g1", controller="resolved-momentum")).truth(1.0)
    TuningPanel(gui, [].append, [].append, truth)
    assert "damping ratio ζ" not in gui.widgets


def test_everything_leaves_with_the_panel(desk):
    desk.panel.remove()
    assert desk.gui.widgets["preset"].removed
    assert desk.gui.widgets["Gains"].removed
    assert desk.gui.widgets["friction as before"].removed


def test_gains_that_come_from_elsewhere_are_followed(desk):
    gains = {**desk.truth.gains, **preset_named("soft", "computed-torque").gains}
    desk.panel.follow(msgspec.structs.replace(desk.truth, gains=gains))
    assert desk.gui.widgets["preset"].value == "soft"
    assert desk.shown() == []
