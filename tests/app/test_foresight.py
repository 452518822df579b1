"""What would a push do: the answer is what the push then does, bit for bit, and asking changes nothing."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.app.foresight import SECONDS
from momentum_lab.app.foresight_scene import ForesightScene, dashes, words_of
from momentum_lab.app.playback import Playback
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.wire import Fallen, Foreseen, FrameTaken, rows_of
from momentum_lab.app.worker import Worker
from momentum_lab.beside import Beside
from momentum_lab.errors import InputError
from momentum_lab.events import ApplyPush, Foresee, Pause, SetBeside, SetPriority
from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario
from tests.app.fakes import FakeClient
from tests.app.test_worker import Pipe, played

PUSH = Push(velocity_change=0.2)
TICKS = round(1e3 * SECONDS)


def answers(playback: Playback) -> tuple[Foreseen, ...]:
    for _ in range(TICKS):
        if found := playback.look_ahead(7):
            return found
    raise AssertionError("no answer")


@pytest.mark.parametrize("controller", ["computed-torque", "slack-qp"])
def test_the_push_does_what_was_foreseen_bit_for_bit(controller):
    playback = Playback(Scenario("s", robot="g1", controller=controller, beside=Beside(priority=1.0)))
    playback.tick(100)
    playback.take(SetPriority(0.25))  # waits for the next tick, in what is foreseen too
    playback.take(Foresee(PUSH))
    foreseen = answers(playback)
    playback.take(ApplyPush(PUSH))
    playback.tick(TICKS)
    assert playback.beside is not None
    for session, answer in zip((playback.session, playback.beside.session), foreseen, strict=True):
        assert session.recording.rows()[-TICKS::10].tobytes() == answer.rows
        assert (session.fall is None) == (answer.fall is None)
    assert foreseen[0].rows != foreseen[1].rows


def test_asking_changes_nothing():
    one, two = (Playback(Scenario("s", robot="g1")) for _ in range(2))
    for playback in (one, two):
        playback.tick(50)
    one.take(Foresee(PUSH))
    for playback in (one, two):
        for _ in range(100):
            playback.tick(3)
            playback.look_ahead(5)
    assert one.session.recording.rows().tobytes() == two.session.recording.rows().tobytes()
    assert one.truth(1.0).push is None


def test_a_push_too_hard_is_foreseen_to_fell_the_robot():
    playback = Playback(Scenario("s", robot="g1"))
    playback.take(Foresee(Push(velocity_change=1.5)))
    (answer,) = answers(playback)
    assert answer.fall is not None
    assert playback.truth(1.0).fall is None


def test_a_push_that_cannot_be_is_refused():
    playback = Playback(Scenario("s", robot="g1"))
    with pytest.raises(InputError, match="body: got tail"):
        playback.take(Foresee(Push(force=10.0, body="tail")))
    assert playback.foresights == ()


def test_the_worker_answers_once_and_time_goes_on():
    pipe = played([[FrameTaken()]] * 3 + [[FrameTaken(), Foresee(Push(force=100.0))]] + [[FrameTaken()]] * 10)
    found = [frame for frame in pipe.frames if frame.foreseen]
    parts = [frame.foreseeing for frame in pipe.frames if frame.foreseeing is not None]
    assert found[0].foreseeing is None
    assert parts
    assert parts == sorted(parts)
    assert len(found) == 1
    assert pipe.frames[-1].late_ticks == 0
    assert pipe.frames[-1].truth.push is None


# In the picture


def test_paths_lead_from_where_the_robot_is_to_where_it_would_be(talos, pushed):
    rows = pushed.recording.rows(10)
    loaded, client = LoadedRobot(talos, (), pushed.recording.layout), FakeClient()
    scene = ForesightScene(client, loaded, Foreseen(0.0, rows.tobytes(), None))
    com = rows_of(rows.tobytes(), loaded.layout.width)[:, loaded.layout.slices["com"]]
    drawn = client.scene.nodes["/foreseen/com"].points
    np.testing.assert_allclose(drawn[0, 0], com[0], atol=1e-6)
    assert drawn[:, :, 0].max() == pytest.approx(com[:, 0].max(), abs=1e-3)
    assert "would stand; the CoM goes " in client.scene.nodes["/foreseen/end"].text
    scene.remove()
    assert all(node.removed for node in client.scene.nodes.values())


def test_dashes_leave_gaps_and_what_is_no_number():
    path = np.column_stack([np.arange(9.0), np.zeros(9), np.zeros(9)])
    path[5] = np.nan
    assert dashes(path)[:, 0, 0].tolist() == [0.0, 1.0, 2.0, 6.0]


def test_a_pause_tells_how_far_a_try_with_two_robots_is():
    """Nothing else is sent in a pause: a frame with the part that is done, and then the answers of both."""

    class Busy(Pipe):
        def poll(self, seconds: float) -> bool:
            return super().poll(max(seconds, 0.01))

    asked = [[FrameTaken(), SetBeside(Beside(priority=1.0)), Pause()], [FrameTaken(), Foresee(PUSH)]]
    pipe = Busy([*asked, *([[FrameTaken()]] * 20)], {}, until=103.0)
    with pytest.raises(EOFError):
        Worker(pipe, Playback(Scenario("s", robot="g1")), clock=lambda: pipe.now).run()
    last = next(i for i, frame in enumerate(pipe.frames) if frame.foreseen)
    parts = [frame.foreseeing for frame in pipe.frames[:last] if frame.foreseeing is not None]
    assert len(pipe.frames[last].foreseen) == 2
    assert len(parts) >= 3
    assert parts == sorted(set(parts))


def test_a_robot_that_lies_there_does_not_fall_again():
    assert words_of(Foreseen(9.0, b"", Fallen(3.25, "x")), 0.5) == "has fallen already"


def test_a_fall_is_told_from_the_push_on():
    assert words_of(Foreseen(2.0, b"", Fallen(3.25, "x")), 0.5) == "would fall after 1.25 s"
