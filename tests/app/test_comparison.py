"""Two robots, a ghost and a table in one browser tab that only remembers."""

from __future__ import annotations

import re

import msgspec
import numpy as np
import pytest

from momentum_lab.app.camera import VIEWS, of_two
from momentum_lab.app.comparison import Comparison
from momentum_lab.app.playback import Playback
from momentum_lab.app.plots import Plots
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.runs_panel import AS_FIRST, RunsPanel
from momentum_lab.app.view_panel import ViewSettings
from momentum_lab.app.wire import Foreseen, Frame, Other
from momentum_lab.beside import Beside
from momentum_lab.events import ApplyPush, Branch, Foresee, LookBack, Reset, RunAgain, SetBeside, SetPriority
from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario
from tests.app.fakes import FakeClient

PUSH = Push(force=150.0)


class Desk:
    """A playback, and everything that is drawn of it."""

    def __init__(self, beside: Beside | None) -> None:
        self.playback = Playback(Scenario("s", beside=beside))
        self.client, self.posted = FakeClient(), []
        session = self.playback.session
        self.loaded = LoadedRobot(session.robot, (), session.recording.layout)
        self.panel = RunsPanel(self.client.gui, self.posted.append, lambda: None, self.playback.truth(1.0))
        self.panel.is_time = lambda: True
        self.now = 0.0
        self.foreseen: tuple[Foreseen, ...] = ()
        self.plots = Plots(self.client.gui, clock=lambda: self.now)
        self.plots.begin(session.robot, session.recording.layout)
        self.comparison = Comparison(self.client)
        self.show()

    def play(self, ticks: int) -> None:
        """Play on, with a frame every 20 ticks."""
        for _ in range(ticks // 20):
            self.playback.tick(20)
            self.show()

    def show(self) -> None:
        frame = self._frame()
        sample = self.playback.shown
        self.comparison.begin(frame, self.loaded, self.panel, self.plots)
        self.comparison.draw(frame, sample, ViewSettings())
        self.plots.add(np.frombuffer(frame.history).reshape(1, -1))
        self.comparison.after(frame, sample, self.panel, self.plots)

    def _frame(self) -> Frame:
        playback = self.playback
        truth, row = playback.truth(1.0), playback.shown.row.tobytes()
        other_truth, shown = playback.beside_truth(truth), playback.beside_shown
        other = None
        if other_truth is not None and shown is not None:
            other = Other(other_truth, shown.row.tobytes(), shown.row.tobytes())
        foreseen, self.foreseen = self.foreseen, ()
        return Frame(truth, row, row, other=other, foreseen=foreseen)

    @property
    def table(self) -> str:
        return self.client.gui.html[2].content

    def node(self, name: str):
        return self.client.scene.nodes[name]


def test_two_robots_stand_beside_each_other_with_their_names():
    desk = Desk(Beside(priority=1.0))
    assert (desk.node("/name").text, desk.node("/beside/name").text) == ("priority 0", "priority 1")
    x, y, z = desk.node("/beside").position
    assert abs(y) > 1.0  # beside, further than the arms reach
    assert (x, z) == (pytest.approx(0.0, abs=1e-6), 0.0)
    base = desk.node("/beside/robot/1")
    np.testing.assert_allclose(base.position, desk.playback.session.state.q[:3], atol=1e-3)
    assert "/beside/marks/com" in desk.client.scene.nodes
    desk.playback.take(SetBeside(None))
    desk.show()
    assert desk.node("/beside").removed
    assert desk.node("/name").removed


def test_names_follow_what_differs():
    desk = Desk(Beside(priority=1.0))
    desk.playback.take(SetPriority(0.25))
    desk.show()
    assert desk.node("/name").text == "priority 0.25"


def test_a_run_that_was_gone_on_with_otherwise_says_so_in_the_table():
    desk = Desk(None)
    desk.playback.take(ApplyPush(PUSH))
    desk.play(200)
    desk.playback.take(LookBack(0.1))
    desk.playback.take(SetPriority(1.0))
    desk.playback.take(Branch())
    desk.play(100)
    desk.panel.wants_kept = True
    desk.play(20)
    desk.playback.take(SetPriority(0.5))  # for the next push
    desk.playback.take(RunAgain())
    desk.play(300)
    assert re.search(r"priority</td>.*>1<.*>0.5<", desk.table)


def test_two_robots_in_the_table():
    desk = Desk(Beside(priority=1.0))
    desk.play(60)
    assert "priority 1" in desk.table
    assert "CoM moved at most" in desk.table


def test_a_kept_run_goes_along_as_a_ghost_with_dashed_curves_and_a_table():
    desk = Desk(None)
    desk.playback.take(ApplyPush(Push(force=150.0)))
    desk.play(200)
    assert desk.table == ""
    desk.panel.keep()
    desk.playback.take(SetPriority(1.0))
    desk.playback.take(Reset())
    desk.show()
    desk.playback.take(ApplyPush(Push(force=150.0)))
    desk.play(100)
    assert "/ghost/1" in desk.client.scene.nodes
    assert "<td" in desk.table
    for word in ("A", "now", "priority", "smallest CoP margin", "at rest after"):
        assert word in desk.table
    desk.plots.draw()
    places = next(handle for name, handle in desk.client.gui.widgets.items() if name.startswith("plot"))
    com, kept = places.data[1], places.data[7]
    both = np.isfinite(com[1:-1]) & np.isfinite(kept[1:-1])
    assert both.sum() >= 3
    # The same push at the same time: the CoM starts alike before the priorities tell it apart.
    np.testing.assert_allclose(com[1:3], kept[1:3], atol=0.05)
    desk.panel._forget_kept()
    desk.show()
    assert desk.node("/ghost/1").removed
    assert desk.table == ""


def test_running_again_keeps_the_run_before_it():
    desk = Desk(None)
    desk.playback.take(ApplyPush(Push(force=150.0)))
    desk.play(100)
    desk.playback.take(SetPriority(1.0))  # after the push: meant for the next run
    desk.show()
    desk.panel.run_again()
    assert desk.posted == [RunAgain()]
    desk.playback.take(RunAgain())
    desk.show()
    assert desk.comparison.kept is not None
    assert (desk.comparison.kept.truth.priority, desk.playback.session.choices.priority) == (0.0, 1.0)
    assert len(desk.comparison.kept.story) == 6  # of 100 ms
    desk.panel.run_again()
    assert not desk.panel.wants_kept  # A stays A


def test_what_was_foreseen_stays_until_it_has_come_true():
    desk = Desk(Beside(priority=1.0))
    desk.playback.take(Foresee(PUSH))
    said = []
    while not desk.foreseen:
        said.append(desk.comparison.tried(desk.playback.foreseen_part))
        desk.foreseen = desk.playback.look_ahead(50)
    desk.show()
    assert said[0] == "Trying the push on a copy: 0 %."
    assert said[15] == "Trying the push on a copy: 50 %."
    answer = desk.comparison.tried(desk.playback.foreseen_part)
    assert re.fullmatch(r"Tried, not pushed: priority 0: would .*\. priority 1: would .*\.", answer)
    paths = [desk.node("/foreseen/com"), desk.node("/beside/foreseen/com")]
    desk.playback.take(ApplyPush(PUSH))
    desk.play(1400)
    assert not any(path.removed for path in paths)
    assert desk.comparison.tried(None) == ""  # by now it has been pushed
    desk.play(200)
    assert all(path.removed for path in paths)


def test_the_widgets_ask_for_plain_data():
    desk = Desk(None)
    widgets = desk.client.gui.widgets
    assert widgets["its priority"].disabled
    widgets["a second robot"].set_by_person(True)
    assert desk.posted == [SetBeside(Beside(priority=1.0))]
    desk.playback.take(desk.posted[0])
    desk.show()
    assert not widgets["its priority"].disabled
    widgets["its priority"].set_by_person(0.4)
    widgets["its controller"].set_by_person("slack-qp")
    widgets["its controller"].set_by_person(AS_FIRST)
    widgets["it keeps its gains"].set_by_person(True)
    widgets["a second robot"].set_by_person(False)
    asked = [event.beside for event in desk.posted[1:]]
    gains = desk.playback.truth(1.0).gains
    assert asked == [
        Beside(priority=0.4),
        Beside("slack-qp", 1.0),
        Beside(priority=1.0),
        Beside(priority=1.0, gains=gains),
        None,
    ]


def test_text_of_strangers_is_no_html():
    desk = Desk(Beside(priority=1.0))
    truth = msgspec.structs.replace(desk.playback.truth(1.0), robot="<script>")
    desk.panel.compare([("<b>", desk.comparison._stories[0].facts(truth))] * 2, {"robot": ("<i>", "x")})
    assert "<script>" not in desk.table
    assert "&lt;b&gt;" in desk.table
    assert "&lt;i&gt;" in desk.table


@pytest.mark.parametrize("name", VIEWS)
def test_a_view_of_two_is_wide_enough_for_both(name):
    assert of_two(VIEWS[name], np.array([0.0, 1.5])).width > VIEWS[name].width
    if VIEWS[name].azimuth == 0.0:  # from the front their whole distance is seen
        assert of_two(VIEWS[name], np.array([0.0, 1.5])).width > VIEWS[name].width + 1.5


def test_a_robot_put_beside_a_fallen_one_counts_no_fall_but_its_own():
    desk = Desk(None)
    desk.playback.take(ApplyPush(Push(force=600.0)))
    while desk.playback.session.fall is None:
        desk.play(100)
    desk.playback.take(SetBeside(Beside(priority=1.0)))
    desk.play(40)
    fell = f"fell after {desk.playback.session.fall.time:.2f} s"  # pushed at the start
    assert re.search(rf"result</td><td[^>]*>{fell}</td><td[^>]*>had fallen already<", desk.table)
    desk.playback.take(Reset())
    desk.playback.take(ApplyPush(Push(force=600.0)))
    while desk.playback.beside.session.fall is None:
        desk.play(100)
    assert "had fallen already" not in desk.table
    assert f">fell after {desk.playback.beside.session.fall.time - 0.001:.2f} s<" in desk.table
