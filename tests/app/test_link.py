"""A real worker: it keeps time, answers, and is gone when its pipe is."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from itertools import pairwise

import pytest

from momentum_lab.app.birth import warm_up
from momentum_lab.app.link import Link
from momentum_lab.app.wire import Frame
from momentum_lab.errors import InputError
from momentum_lab.events import (
    ApplyPush,
    Pause,
    Play,
    SelectRobot,
    SetGain,
    SetPriority,
    SetSpeed,
    StepOnce,
)
from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario

PATIENCE = 20.0


class Reader:
    """A link and its frames, read one by one."""

    def __init__(self) -> None:
        warm_up()
        self.link = Link(Scenario("s"), ("talos", "g1"), ("s",))
        self.frames: Iterator[Frame] = self.link.frames()
        self.first = next(self.frames)

    def until(self, seen) -> Frame:
        """The first frame of which something holds."""
        end = time.monotonic() + PATIENCE
        for frame in self.frames:
            if seen(frame):
                return frame
            assert time.monotonic() < end, "not seen in time"
        raise AssertionError("the worker has gone")


@pytest.fixture
def reader() -> Iterator[Reader]:
    reader = Reader()
    yield reader
    reader.link.close()


def alive(pid: int | None) -> bool:
    """Whether a process is still there; the remains of one that has ended do not count."""
    try:
        with open(f"/proc/{pid}/stat") as file:
            return file.read().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


def simulated(frame: Frame) -> float:
    """Time of the frame's sample, the first number of a row."""
    return float(memoryview(frame.row).cast("d")[0])


def test_it_stands_and_keeps_going(reader):
    assert reader.first.truth.playing
    assert reader.first.truth.robot == "talos"
    later = reader.until(lambda frame: simulated(frame) > 0.2)
    assert later.truth.fall is None
    assert later.truth.failures == 0


def test_pause_step_and_play(reader):
    reader.link.post(Pause())
    paused = reader.until(lambda frame: not frame.truth.playing)
    reader.link.post(StepOnce(3))
    stepped = reader.until(lambda frame: simulated(frame) > simulated(paused) + 1e-6)
    assert simulated(stepped) - simulated(paused) == pytest.approx(0.003, abs=1e-6)
    assert not stepped.truth.playing
    reader.link.post(Play())
    reader.until(lambda frame: frame.truth.playing and simulated(frame) > simulated(stepped) + 0.02)


def test_a_paused_session_answers_when_a_picture_is_wanted(reader):
    reader.link.post(Pause())
    reader.until(lambda frame: not frame.truth.playing)
    reader.link.want_frame()
    assert not next(reader.frames).truth.playing


def test_slow_motion(reader):
    reader.link.post(SetSpeed(0.125))
    slow = reader.until(lambda frame: frame.truth.speed == 0.125)
    start, then = time.monotonic(), simulated(slow)
    later = reader.until(lambda _: time.monotonic() - start > 0.8)
    assert simulated(later) - then < 0.2


def test_what_a_session_refuses_comes_back_in_words_and_it_goes_on(reader):
    reader.link.post(SetGain("nonsense", 1.0))
    refused = reader.until(lambda frame: frame.notices)
    assert refused.notices[0].startswith("gain: got nonsense; allowed: one of")
    reader.link.post(SetPriority(0.5))
    assert reader.until(lambda frame: frame.truth.priority == 0.5).notices == ()


def test_what_the_inbox_refuses_never_leaves(reader):
    with pytest.raises(InputError, match="robot: got nobody"):
        reader.link.post(SelectRobot("nobody"))


def test_a_push_moves_the_robot_and_is_told(reader):
    reader.link.post(ApplyPush(Push(force=217.0)))
    pushed = reader.until(lambda frame: frame.truth.push is not None)
    assert pushed.truth.push.force == 217.0


def test_another_robot(reader):
    run = reader.first.truth.run
    reader.link.post(SelectRobot("g1"))
    changed = reader.until(lambda frame: frame.truth.robot == "g1")
    assert changed.truth.run > run
    assert len(changed.history) % len(changed.row) == 0


def test_history_is_every_twentieth_tick_in_order(reader):
    times: list[float] = []
    width = len(reader.first.row) // 8
    while len(times) < 12:
        times += memoryview(next(reader.frames).history).cast("d")[::width].tolist()
    assert [b - a for a, b in pairwise(times)] == pytest.approx([0.02] * (len(times) - 1))


def test_a_reader_that_does_not_read_does_not_stop_time(reader):
    before = simulated(next(reader.frames))
    time.sleep(1.0)
    next(reader.frames)  # this one was sent before the sleep
    assert simulated(next(reader.frames)) - before > 0.3


def test_closing_ends_the_process_and_the_frames():
    reader = Reader()
    pid = reader.link.process.pid
    assert alive(pid)
    reader.link.close()
    reader.link.close()
    assert not alive(pid)
    assert list(reader.frames) == []
    reader.link.post(Pause())  # goes nowhere, says nothing


def test_a_worker_whose_server_is_gone_ends_by_itself():
    reader = Reader()
    pid = reader.link.process.pid
    reader.frames.close()  # closes the server's end of the pipe, as a dying server would
    end = time.monotonic() + PATIENCE
    while alive(pid) and time.monotonic() < end:
        time.sleep(0.02)
    assert not alive(pid)
    reader.link.close()


def test_warming_up_leaves_the_environment_alone(monkeypatch):
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "7")
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    warm_up()
    assert os.environ["OPENBLAS_NUM_THREADS"] == "7"
    assert "OMP_NUM_THREADS" not in os.environ
