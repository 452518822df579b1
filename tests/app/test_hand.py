"""A hand in the picture: grab, pull, let go; what is posted, shown and refused."""

from __future__ import annotations

import asyncio
import math
import threading
from types import SimpleNamespace

import msgspec
import numpy as np
import pytest

from momentum_lab.app.hand import Hand, Note
from momentum_lab.app.inbox import MOST_PUSHES, checked_event
from momentum_lab.app.pull import Scale
from momentum_lab.app.pulling import Pulling, Reach
from momentum_lab.app.push_panel import PushPanel
from momentum_lab.app.robot_scene import RobotScene
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.view_panel import ViewSettings
from momentum_lab.app.visitor import Visitor
from momentum_lab.events import ApplyPush, ApplyPushes, Branch, HoldPush, LetGo
from momentum_lab.physics.held_push import Pushed
from momentum_lab.physics.push import MAX_DURATION, Push
from momentum_lab.recording import Layout
from momentum_lab.robot.geometry import LinkMesh
from momentum_lab.robot.posture import standing_posture
from tests.app.fakes import FakeClient
from tests.app.loops import run
from tests.conftest import assert_close

TRIANGLE = (np.eye(3, dtype=np.float32), np.array([[0, 1, 2]], dtype=np.uint32))
SIZE = 0.877
GRABBED = np.array([0.05, 0.0, 1.1])
ABOVE = (0.0, 0.0, 6.0)


class Desk:
    """A tab with one robot, a push panel and a hand; pushes go nowhere."""

    def __init__(self, robot, offset=(0.0, 0.0, 0.0)) -> None:
        self.client = FakeClient()
        trunk = robot.model.frames[robot.trunk].parentJoint
        loaded = LoadedRobot(robot, (LinkMesh(trunk, *TRIANGLE, (0.5, 0.5, 0.5)),), Layout.of(robot))
        self.posted, self.told, self.busy = [], [], False
        self.panel = PushPanel(self.client.gui, self.posted.append, self.told.append, lambda: None)
        self.panel.set_robot(loaded)
        self.pushes: tuple = ()
        settings = ViewSettings()
        pulling = Pulling(self.client, self.panel, settings, self.posted.append, lambda: self.pushes)
        self.hand = Hand(self.panel.hand, pulling, self.told.append)
        body = RobotScene(self.client, loaded, standing_posture(robot))
        self.reach = Reach(body, loaded, SIZE, np.array(offset))
        self.trunk = trunk
        self.scale = Scale.of(robot, SIZE, settings.arrow_scale, self.panel.form.strongest)

    def drag(self, phase: str, x: float, y: float, z: float = 0.0, **changes) -> None:
        """One event of a hand that is so far from where it has grabbed, m; the picture is two metres high."""
        start = GRABBED + self.reach.offset
        told = {"start": tuple(start), "end": tuple(start + [x, y, z]), "eye": ABOVE, **changes}
        on_screen = ((0.5, 0.5), (0.5 + 0.25 * (x + y), 0.5 - 0.5 * z), (1600, 800))
        places = (told["start"], told["end"], told["eye"])
        self.hand.note(Note(self.reach, self.trunk, phase, places, on_screen))
        if not self.busy:
            self.hand.act()

    def see(self, playing: bool = True, run: int = 0, push: Push | None = None) -> None:
        """A frame of the session has come."""
        self.hand.follow(SimpleNamespace(playing=playing, run=run, push=push))

    def set(self, label: str, value: object) -> None:
        self.client.gui.widgets[label].set_by_person(value)

    @property
    def size(self) -> str:
        """What the panel says about the push that its widgets describe."""
        return self.client.gui.html[1].content

    @property
    def label(self):
        return self.client.scene.nodes["/hand/label"]


@pytest.fixture
def desk(talos) -> Desk:
    return Desk(talos)


def test_letting_go_pushes_with_the_force_of_the_arrow(desk):
    desk.drag("start", 0.01, 0.0)
    desk.drag("update", 0.1, 0.0)
    desk.drag("update", 0.0, 0.2)
    force = 0.2 * desk.scale.newtons_per_metre
    assert desk.label.text == f"{force:.0f} N on trunk"
    assert_close(desk.label.position, GRABBED + [0.0, 0.2, 0.0], 1e-6)
    assert desk.posted == []
    desk.drag("end", 0.0, 0.2)
    (event,) = desk.posted
    push = event.push
    assert (push.force, push.direction_deg, push.duration) == (round(force), 90.0, 0.1)
    assert push.body == "trunk"
    assert push.point is not None
    assert push.height is None
    assert desk.label.removed


def test_the_panel_shows_the_push_and_gives_it_again(desk):
    desk.set("duration (ms)", 250.0)
    desk.drag("start", 0.2, -0.2)
    desk.drag("end", 0.2, -0.2)
    (event,) = desk.posted
    assert event.push.duration == 0.25
    assert desk.panel.push() == event.push
    desk.panel.refresh()
    force = f"{event.push.force:.0f} N"
    assert f"P repeats what your hand did: {force} for 250 ms on the trunk, direction -45°." in desk.size
    desk.panel.apply_again()
    desk.panel.apply()
    assert desk.posted == [event] * 3
    desk.set("force (N)", 50.0)  # it can be edited, too
    desk.panel.refresh()
    assert "your hand" not in desk.size
    desk.panel.apply()
    assert desk.posted[-1] == ApplyPush(msgspec.structs.replace(event.push, force=50.0))


def test_another_body_has_no_grabbed_point(desk):
    desk.drag("start", 0.2, 0.0)
    desk.drag("end", 0.2, 0.0)
    desk.set("body", "head")
    assert desk.panel.push().point is None
    assert not desk.client.gui.widgets["where it was grabbed"].visible


def test_back_where_it_began_there_is_no_push_and_both_ends_of_the_arrow_say_so(desk):
    home = lambda: desk.client.scene.nodes["/hand/home"]  # noqa: E731
    desk.drag("start", 0.03, 0.0)
    assert not home().visible
    desk.drag("update", 0.2, 0.0)
    assert (home().visible, home().text) == (True, "back here: no push")
    desk.drag("update", 0.04, 0.0)  # 4 cm are 16 of 800 pixels, and 27 N
    assert desk.label.text == "let go: no push"
    assert not home().visible
    desk.drag("end", 0.04, 0.0)
    assert desk.posted == []
    desk.drag("start", 0.04, 0.0)
    desk.drag("end", 0.04, 0.0)  # a hand that has never been further away pulls gently
    assert desk.posted[0].push.force == round(0.04 * desk.scale.newtons_per_metre)


def test_the_way_out_and_back_counts_however_fast_it_was(desk):
    desk.drag("start", 0.0, 0.0)
    desk.busy = True  # all of this comes while the server is at something else
    for x in (0.1, 0.3, 0.03):
        desk.drag("update", x, 0.0)
    desk.busy = False
    desk.drag("end", 0.03, 0.0)
    assert desk.posted == []
    assert desk.told == []


@pytest.mark.parametrize("way", ["pulse", "hold"])
def test_a_hand_can_give_up(desk, way):
    desk.set("by hand", way)
    desk.drag("start", 0.2, 0.0)
    desk.drag("update", 0.3, 0.0)
    desk.hand.give_up()
    assert way == "hold" or desk.label.removed
    desk.drag("update", 0.4, 0.0)
    desk.drag("end", 0.4, 0.0)
    assert [type(event) for event in desk.posted] == [HoldPush, HoldPush, LetGo] * (way == "hold")


@pytest.mark.parametrize("way", ["pulse", "hold"])
def test_a_robot_that_stands_up_again_is_not_pulled_by_the_hand_that_pulled_before(desk, way):
    desk.set("by hand", way)
    desk.see(run=3)
    desk.drag("start", 0.2, 0.0)
    desk.see(run=3)
    desk.drag("update", 0.21, 0.0)
    desk.see(run=4)  # Reset, the same pushes again, another scenario
    posted = len(desk.posted)
    assert way == "pulse" or isinstance(desk.posted[-1], LetGo)
    desk.drag("update", 0.3, 0.0)
    desk.drag("end", 0.3, 0.0)
    assert len(desk.posted) == posted
    assert all(node.removed for name, node in desk.client.scene.nodes.items() if name.startswith("/hand"))
    desk.drag("start", 0.2, 0.0)
    desk.see(run=4)
    desk.drag("end", 0.2, 0.0)
    assert len(desk.posted) > posted


def test_what_was_held_as_long_as_a_push_can_be_does_not_begin_again_with_the_next_move(desk):
    desk.set("by hand", "hold")
    desk.drag("start", 0.2, 0.0)
    (held,) = [event.push for event in desk.posted]
    for seconds, kinds in ((MAX_DURATION - 0.001, [HoldPush]), (MAX_DURATION, [HoldPush, LetGo])):
        (latest,) = Pushed().held_from(2.0, held).until(2.0 + seconds, 1e-3)
        desk.see(run=-1, push=latest)
        assert [type(event) for event in desk.posted] == kinds
    assert "10 s at most" in desk.told[0]
    desk.drag("update", 0.3, 0.0)
    desk.drag("end", 0.3, 0.0)
    assert [type(event) for event in desk.posted] == [HoldPush, LetGo]
    assert len(desk.told) == 1


def test_a_robot_that_has_left_gets_no_push_of_its_link(desk):
    desk.drag("start", 0.2, 0.0)
    desk.reach.body.remove()
    desk.drag("end", 0.2, 0.0)
    desk.drag("start", 0.2, 0.0)
    desk.drag("end", 0.2, 0.0)
    assert (desk.posted, desk.told) == ([], [])


def test_whoever_goes_on_from_an_earlier_instant_has_let_go(desk):
    """The session lets go there, too: a hand that still held would begin again with its next move."""
    desk.set("by hand", "hold")
    tab = Visitor.__new__(Visitor)
    tab._demo = SimpleNamespace(demo=SimpleNamespace(touch=lambda: None))
    tab._panels, tab._link = SimpleNamespace(hand=desk.hand), SimpleNamespace(post=desk.posted.append)
    desk.drag("start", 0.2, 0.0)
    tab.post(Branch())
    desk.drag("update", 0.3, 0.0)
    desk.drag("end", 0.3, 0.0)
    assert [type(event) for event in desk.posted] == [HoldPush, LetGo, Branch]


def test_up_and_sideways_pulls_up(desk):
    desk.set("pulls", "up and sideways")
    eye = (4.0, 0.0, 1.1)
    desk.drag("start", 0.0, 0.1, eye=eye)
    desk.drag("update", 0.0, 0.1, 0.1, eye=eye)
    assert_close(desk.label.position, GRABBED + [0.0, 0.1, 0.1], 1e-6)
    desk.drag("end", 0.0, 0.1, 0.1, eye=eye)
    push = desk.posted[0].push
    assert (push.direction_deg, push.elevation_deg) == (90.0, 45.0)
    assert push.force == round(math.hypot(0.1, 0.1) * desk.scale.newtons_per_metre)
    assert desk.panel.push() == push


def test_no_hand_is_stronger_than_the_slider(desk):
    desk.drag("start", 50.0, 0.0)
    assert desk.label.text == f"{desk.panel.form.strongest:.0f} N on trunk, the most"
    desk.drag("end", 50.0, 0.0)
    assert desk.posted[0].push.force == desk.panel.form.strongest


def test_a_held_push_follows_the_hand_and_ends_with_it(desk):
    desk.set("by hand", "hold")
    desk.drag("start", 0.1, 0.0)
    desk.drag("update", 0.1002, 0.0)  # a hand that trembles
    desk.drag("update", 0.2, 0.0)
    desk.drag("update", 0.0, 0.2)
    desk.drag("end", 0.0, 0.2)
    assert [type(event) for event in desk.posted] == [HoldPush, HoldPush, HoldPush, LetGo]
    pushes = [event.push for event in desk.posted[:-1]]
    assert [push.direction_deg for push in pushes] == [0.0, 0.0, 90.0]
    assert pushes[1].force == pytest.approx(2.0 * pushes[0].force, abs=0.02 * desk.panel.form.strongest)
    assert all(push.point == pushes[0].point for push in pushes)


def test_a_held_push_grows_weaker_without_a_step(desk):
    desk.set("by hand", "hold")
    for x in (0.03, 0.2, 0.04):
        desk.drag("start" if x == 0.03 else "update", x, 0.0)
    forces = [event.push.force for event in desk.posted]
    assert forces[-1] == pytest.approx(0.2 * forces[1], abs=0.02 * desk.panel.form.strongest)


def test_what_was_held_can_be_repeated_piece_by_piece(desk):
    desk.set("by hand", "hold")
    desk.drag("start", 0.1, 0.0)
    desk.drag("update", 0.2, 0.0)
    pieces = [event.push for event in desk.posted]
    desk.pushes = tuple(
        msgspec.structs.replace(piece, start=start, duration=1.5)
        for piece, start in zip(pieces, (3.0, 4.5), strict=True)
    )
    desk.drag("end", 0.2, 0.0)
    desk.panel.apply_again()
    (repeated,) = [event for event in desk.posted if isinstance(event, ApplyPushes)]
    assert [push.start for push in repeated.pushes] == [0.0, 1.5]
    assert [push.force for push in repeated.pushes] == [push.force for push in pieces]
    assert desk.panel.push().impulse == pytest.approx(sum(p.impulse for p in desk.pushes), rel=0.01)
    desk.set("by hand", "pulse")
    desk.drag("start", 0.1, 0.0)
    desk.drag("end", 0.1, 0.0)
    assert desk.posted[-1].push.duration == 0.1  # and not the three seconds of what was held


def test_a_hold_of_very_many_pieces_can_be_repeated_and_says_what_is_coarser(desk):
    desk.set("by hand", "hold")
    for i in range(137):
        desk.drag("update" if i else "start", 0.1 + 0.002 * (i % 2) * i, 0.0)
    pieces = [event.push for event in desk.posted]
    desk.pushes = tuple(
        msgspec.structs.replace(piece, start=3.0 + 0.02 * i, duration=0.02) for i, piece in enumerate(pieces)
    )
    assert len(pieces) > MOST_PUSHES
    desk.drag("end", 0.1, 0.0)
    assert desk.told == []
    desk.panel.apply_again()
    checked_event(desk.posted[-1], (), ())
    assert desk.told == [
        f"Your hand pulled in {len(pieces)} pieces; they are repeated in 50, with the same impulse."
    ]
    desk.panel.apply()
    desk.panel.apply_again()
    assert len(desk.told) == 1


def test_in_a_pause_a_hold_would_last_no_time_and_is_a_pulse(desk):
    desk.set("by hand", "hold")
    desk.see(playing=False)
    desk.drag("start", 0.2, 0.0)
    assert desk.label.text.endswith("waits for play")
    desk.drag("end", 0.2, 0.0)
    assert [type(event) for event in desk.posted] == [ApplyPush]


def test_the_robot_beside_the_first_is_grabbed_where_it_is_drawn(desk, talos):
    beside = Desk(talos, offset=(0.3, 1.2, 0.0))
    for each in (desk, beside):
        each.drag("start", 0.2, 0.0)
        each.drag("end", 0.2, 0.0)
    assert beside.posted == desk.posted


@pytest.mark.parametrize(
    "changes",
    [
        {"start": (math.nan, 0.0, 0.0)},
        {"end": (math.inf, 0.0, 0.0)},
        {"end": "far"},
        {"eye": (0.0, 0.0, math.nan)},
        {"eye": None},
    ],
)
def test_what_a_browser_makes_up_is_told_and_no_push(desk, changes):
    desk.drag("start", 0.2, 0.0)
    desk.drag("update", 0.2, 0.0, **changes)
    desk.drag("end", 0.2, 0.0)
    assert desk.posted == []
    assert "allowed:" in desk.told[0]
    assert desk.label.removed


def test_a_hold_that_goes_wrong_ends(desk):
    desk.set("by hand", "hold")
    desk.drag("start", 0.2, 0.0)
    desk.drag("update", math.nan, 0.0)
    assert [type(event) for event in desk.posted] == [HoldPush, LetGo]


@pytest.mark.parametrize(
    ("label", "value"), [("by hand", "throw"), ("pulls", "round"), ("duration (ms)", math.nan)]
)
def test_what_no_widget_offers_is_told_and_no_push(desk, label, value):
    desk.client.gui.widgets[label].value = value
    desk.drag("start", 0.2, 0.0)
    desk.drag("end", 0.2, 0.0)
    assert desk.posted == []
    assert label.split()[0] in desk.told[0]


def test_moves_and_ends_of_nothing_are_nothing(desk):
    desk.drag("update", 0.2, 0.0)
    desk.drag("end", 0.2, 0.0)
    assert (desk.posted, desk.told) == ([], [])


def test_without_shift_a_drag_pulls_while_that_is_switched_on(desk):
    desk.hand.reach(desk.reach)
    (mesh,) = [node for node in desk.client.scene.nodes.values() if node.method == "add_mesh_simple"]
    assert mesh.dragged == ("left", "shift")
    for modifier in (None, "shift"):
        desk.hand.toggle()
        desk.see(playing=True)
        assert mesh.dragged == ("left", modifier)
        assert len(mesh.callbacks) == 1
    desk.reach.body.remove()
    desk.set("drag pushes the robot", True)
    desk.see(playing=True)
    assert mesh.dragged == ("left", "shift")  # viser refuses new callbacks of what has gone


class Flickering:
    """A panel whose switch is turned over whenever somebody has looked at it."""

    def __init__(self) -> None:
        self.looked = 0

    @property
    def modifier(self) -> str | None:
        self.looked += 1
        return (None, "shift")[self.looked % 2]


def test_a_switch_that_is_turned_meanwhile_is_followed_in_the_next_frame(desk):
    desk.hand._panel = Flickering()
    (mesh,) = [node for node in desk.client.scene.nodes.values() if node.method == "add_mesh_simple"]
    desk.hand.reach(desk.reach)
    assert mesh.dragged == ("left", "shift")
    for modifier in (None, "shift"):
        desk.see(playing=True)
        assert mesh.dragged == ("left", modifier)


def test_events_stay_in_order(desk):
    desk.hand.reach(desk.reach)
    (mesh,) = [node for node in desk.client.scene.nodes.values() if node.method == "add_mesh_simple"]

    async def drag() -> None:
        camera = SimpleNamespace(position=ABOVE, image_width=1600, image_height=800)
        for phase, x in (("start", 0.01), *(("update", 0.002 * i) for i in range(50)), ("end", 0.2)):
            await mesh.callbacks[0](
                SimpleNamespace(
                    client=SimpleNamespace(camera=camera),
                    phase=phase,
                    start_position=tuple(GRABBED),
                    end_position=tuple(GRABBED + [x, 0.0, 0.0]),
                    start_screen_pos=(0.5, 0.5),
                    end_screen_pos=(0.5 + 0.25 * x, 0.5),
                )
            )
        await asyncio.get_running_loop().shutdown_default_executor()

    run(drag)
    (event,) = desk.posted
    assert event.push.force == round(0.2 * desk.scale.newtons_per_metre)


def test_no_thread_waits_for_a_hand_that_is_busy_and_no_note_is_left_behind(desk):
    """While one thread tells what was wrong another one brings notes: it goes at once, and they are done."""
    busy, go_on = threading.Event(), threading.Event()

    def tell(_words: str) -> None:
        busy.set()
        assert go_on.wait(20.0)

    desk.hand._tell = tell
    first = threading.Thread(target=desk.drag, args=("start", 0.2, 0.0), kwargs={"eye": None})
    first.start()
    assert busy.wait(20.0)
    second = threading.Thread(target=lambda: (desk.drag("start", 0.1, 0.0), desk.drag("end", 0.2, 0.0)))
    second.start()
    second.join(5.0)
    waited = second.is_alive()
    go_on.set()
    first.join(20.0)
    second.join(20.0)
    assert not waited
    assert [type(event) for event in desk.posted] == [ApplyPush]
