"""The process that owns one session: it keeps time, takes events and sends frames, and never waits for a reader.

A frame is only sent when the server has taken the one before, so that a slow reader gets fewer frames and the
simulation does not notice. The process ends when its pipe closes.
"""

from __future__ import annotations

import gc
import math
import time
from collections.abc import Callable
from multiprocessing.connection import Connection

import msgspec
import numpy as np
from threadpoolctl import threadpool_limits

from momentum_lab.app.classroom import Classroom
from momentum_lab.app.demo_wire import DemoEvent
from momentum_lab.app.lesson_wire import LessonEvent
from momentum_lab.app.pacer import Pacer
from momentum_lab.app.playback import Playback
from momentum_lab.app.wire import (
    Foreseen,
    Frame,
    FrameTaken,
    FrameWanted,
    OpenRun,
    Other,
    RecordingWanted,
    RunWanted,
    TakeBack,
    Truth,
    packed,
    unpacked_message,
)
from momentum_lab.errors import LabError
from momentum_lab.events import Event, Play, SetSpeed
from momentum_lab.recording import Recording
from momentum_lab.run_file import Run

FRAMES_PER_SECOND = 40.0
HISTORY_EVERY = 20
"""Ticks between two samples of the plots."""

# Ticks in a row before the pipe is looked at again.
_BATCH = 8
# Shorter waits than this cost more than they give, s; and how long a paused session waits for an event, s.
_SHORT, _LONG = 0.001, 1.0
# Messages taken in a row: a flood of them must not stop time.
_MOST_MESSAGES = 16
# Ticks of a foresight in a row: while time runs, as long as a due tick may wait; in a pause, as long as a person may.
_AHEAD, _AHEAD_IN_PAUSE = 5, 50
# How many times a person is told meanwhile how far that is.
_STEPS_AHEAD = 10
# Samples that a reader who does not read may miss.
_MOST_HISTORY = 1000


def main(connection: Connection, first: bytes) -> None:
    """Run a session until the pipe closes.

    Args:
        connection: the worker's end of the pipe.
        first: the run to start with, as JSON.
    """
    with threadpool_limits(1), connection:
        try:
            Worker(connection, Playback(msgspec.json.decode(first, type=Run))).run()
        except (EOFError, BrokenPipeError, ConnectionResetError):
            return


class Worker:
    """A playback and the pipe it is steered through.

    Args:
        connection: the worker's end of the pipe.
        playback: the playback.
        clock: seconds, for tests.
    """

    def __init__(
        self, connection: Connection, playback: Playback, clock: Callable[[], float] = time.perf_counter
    ) -> None:
        self._clock = clock
        self._connection = connection
        self._room = Classroom(playback)
        self._pacer = Pacer(playback.session.scenario.timestep)
        self._history: list[np.ndarray] = []
        self._other_history: list[np.ndarray] = []
        self._foreseen: tuple[Foreseen, ...] = ()
        self._notices: list[str] = []
        self._taken = True
        self._news = True
        self._next_frame = 0.0

    @property
    def _playback(self) -> Playback:
        """What is played now."""
        return self._room.stage

    def run(self) -> None:
        """Keep going until the pipe closes.

        Raises:
            EOFError: it has closed.
        """
        gc.collect()
        gc.freeze()  # what is loaded by now never becomes garbage
        self._pacer.start(self._clock(), self._playback.speed)
        while True:
            self._listen(self._rest(self._clock()))
            if self._playback.playing:
                self._advance(min(self._pacer.due(self._clock()), _BATCH))
            self._look_ahead()
            self._send(self._clock())

    def _listen(self, wait: float) -> None:
        """Wait for something in the pipe, and take all that is there: a person's event never waits for a batch."""
        for _ in range(_MOST_MESSAGES):
            if not self._connection.poll(wait):
                return
            self._receive()
            wait = 0.0

    def _receive(self) -> None:
        """One message out of the pipe."""
        message = unpacked_message(self._connection.recv_bytes())
        match message:
            case FrameTaken():
                self._taken = True
            case FrameWanted():
                self._news = True
            case RunWanted():
                self._connection.send_bytes(packed(self._playback.taken()))
            case RecordingWanted():
                self._connection.send_bytes(packed(self._playback.recorded()))
                self._pacer.start(self._clock(), self._playback.speed)  # a long one takes its time
            case _:
                self._take(message)

    def _take(self, event: Event | LessonEvent | DemoEvent | OpenRun | TakeBack) -> None:
        before = self._playback
        run, playing, ticks = before.run, before.playing, before.session.ticks
        try:
            self._room.take(event)
        except LabError as error:
            self._notices.append(str(error))
        playback = self._playback
        if playback.run != run:
            self._forget()
        if playback is not before:
            self._history += _rows(playback.session.recording)
            if playback.beside is not None:
                self._other_history += _rows(playback.beside.session.recording)
        if playback.run != run or playing != playback.playing or isinstance(event, Play | SetSpeed):
            self._pacer.start(self._clock(), playback.speed)
        if playback.run != run or playback.session.ticks != ticks:
            self._remember()
        # A person waits for this: the next tick is sent at once, and nothing before it; no tick comes in a pause.
        self._news = not playback.playing
        self._next_frame = min(self._next_frame, self._clock())

    def _advance(self, due: int) -> None:
        playback = self._playback
        for _ in range(due):
            if not playback.playing:
                break  # an opened run has come to its end
            self._pacer.begin(self._clock())
            run = playback.run
            playback.tick(1)
            if playback.run != run:
                self._forget()
            if playback.session.ticks % HISTORY_EVERY == 0:
                self._remember()
        self._news = self._news or due > 0

    def _forget(self) -> None:
        """What has been sent, or belongs to another run, is told to nobody."""
        self._history.clear()
        self._other_history.clear()
        self._foreseen = ()

    def _remember(self) -> None:
        beside = self._playback.beside
        self._history.append(self._playback.latest.row.copy())
        if beside is not None:
            self._other_history.append(beside.shown(0).row.copy())
        for history in (self._history, self._other_history):
            del history[:-_MOST_HISTORY]

    def _look_ahead(self) -> None:
        """A few ticks of what somebody wants to know beforehand; those that are due go first."""
        if not self._playback.foresights:
            return
        step = self._foreseeing()
        self._foreseen = self._playback.look_ahead(_AHEAD if self._playback.playing else _AHEAD_IN_PAUSE)
        self._news = self._news or self._foreseeing() != step

    def _foreseeing(self) -> float | None:
        """How far that is, in steps that are worth a picture in a pause."""
        part = self._playback.foreseen_part
        return None if part is None else math.floor(part * _STEPS_AHEAD) / _STEPS_AHEAD

    def _send(self, now: float) -> None:
        """A frame, if there is something new, the last one has been taken and it is time for the next."""
        if not (self._news and self._taken) or now < self._next_frame:
            return
        truth = self._playback.truth(self._pacer.real_time_factor(now))
        frame = Frame(
            truth=truth,
            late_ticks=self._pacer.late_ticks,
            row=self._playback.shown.row.tobytes(),
            history=_joined(self._history),
            notices=tuple(self._notices),
            lesson=self._room.news(),
            other=self._other(truth),
            foreseen=self._foreseen,
            foreseeing=self._foreseeing(),
            demo=self._room.in_demo,
            left=self._room.left,
        )
        self._forget()
        self._notices.clear()
        self._taken = self._news = False
        self._next_frame = max(self._next_frame + 1.0 / FRAMES_PER_SECOND, now)
        self._connection.send_bytes(packed(frame))

    def _other(self, first: Truth) -> Other | None:
        """The robot beside the first."""
        truth, shown = self._playback.beside_truth(first), self._playback.beside_shown
        if truth is None or shown is None:
            return None
        return Other(truth, shown.row.tobytes(), _joined(self._other_history), self._playback.names)

    def _rest(self, now: float) -> float:
        """How long nothing has to be done, s; an event ends it early."""
        if self._playback.foresights:
            return 0.0
        if self._playback.playing:
            wait = self._pacer.wait(now)
            if wait == 0.0:
                return 0.0
            self._playback.prepare()
            return max(wait, _SHORT)
        if self._news and self._taken:
            return max(0.0, self._next_frame - now)
        return _LONG


def _rows(recording: Recording) -> list[np.ndarray]:
    return list(recording.rows(HISTORY_EVERY)[-_MOST_HISTORY:].copy())


def _joined(rows: list[np.ndarray]) -> bytes:
    return b"".join(row.tobytes() for row in rows)
