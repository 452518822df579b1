"""The worker's loop on a pipe that plays a part: what a person asks for is shown at once, stalls are owned up to."""

from __future__ import annotations

import math

import pytest

from momentum_lab.app.playback import Playback
from momentum_lab.app.wire import Frame, FrameTaken, Message, packed, unpacked_answer
from momentum_lab.app.worker import Worker
from momentum_lab.events import ApplyPush, Pause
from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario

TAKEN = FrameTaken()


class Pipe:
    """The other end: answers each frame with what a test says, then hangs up. Time passes in `poll` only."""

    def __init__(self, answers: list[list[Message]], stalls: dict[int, float], until: float) -> None:
        self.now, self._until = 100.0, until
        self.frames: list[Frame] = []
        self.sent: list[float] = []
        self._answers, self._stalls = answers, dict(stalls)
        self._waiting: list[Message] = []

    def poll(self, seconds: float) -> bool:
        """Wait; once after each of the chosen frames much longer than was asked for."""
        if len(self.frames) > len(self._answers) or self.now > self._until:
            raise EOFError
        if not self._waiting:
            self.now += max(seconds, self._stalls.pop(len(self.frames), 0.0))
        return bool(self._waiting)

    def recv_bytes(self) -> bytes:
        return packed(self._waiting.pop(0))

    def send_bytes(self, data: bytes) -> None:
        self.frames.append(unpacked_answer(data))
        self.sent.append(self.now)
        if len(self.frames) <= len(self._answers):
            self._waiting += self._answers[len(self.frames) - 1]


def played(
    answers: list[list[Message]], stalls: dict[int, float] | None = None, until: float = math.inf
) -> Pipe:
    pipe = Pipe(answers, stalls or {}, until)
    with pytest.raises(EOFError):
        Worker(pipe, Playback(Scenario("s")), clock=lambda: pipe.now).run()
    return pipe


def simulated(frame: Frame) -> float:
    return float(memoryview(frame.row).cast("d")[0])


def test_frames_come_forty_times_a_second():
    pipe = played([[TAKEN]] * 20)
    assert (pipe.sent[-1] - pipe.sent[2]) / 18 == pytest.approx(0.025, abs=0.002)
    assert simulated(pipe.frames[-1]) - simulated(pipe.frames[2]) == pytest.approx(
        pipe.sent[-1] - pipe.sent[2], abs=0.003
    )
    assert pipe.frames[-1].late_ticks == 0


def test_a_push_is_in_the_very_next_frame_and_that_comes_at_once():
    # Without the push that frame would come 25 ms after the one before.
    pipe = played([[TAKEN]] * 3 + [[TAKEN, ApplyPush(Push(force=217.0))], [TAKEN]])
    before, after, later = pipe.frames[-3:]
    assert before.truth.push is None
    assert after.truth.push is not None
    assert after.truth.push.start <= simulated(after)
    assert pipe.sent[-2] - pipe.sent[-3] < 0.005
    assert simulated(later) - simulated(after) == pytest.approx(0.025, abs=0.003)


def test_a_pause_is_told_although_no_tick_follows():
    pipe = played([[TAKEN, Pause()]])
    assert not pipe.frames[-1].truth.playing


def test_a_frame_that_is_not_taken_is_the_last():
    assert len(played([[TAKEN], [], []], until=100.5).frames) == 2


@pytest.mark.parametrize(("stall", "late"), [(0.020, 0), (0.040, 19)])
def test_ticks_of_a_stall_are_late(stall, late):
    # Of the ticks of a stall, the first 16 have begun ahead of it, and those of its last 5 ms begin in time.
    pipe = played([[TAKEN]] * 6, stalls={3: stall})
    assert pipe.frames[-1].late_ticks == pytest.approx(late, abs=1 if late else 0)
