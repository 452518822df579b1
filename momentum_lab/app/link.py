"""The server's end of a worker: starts the process, hands events in and frames out, and lets it go."""

from __future__ import annotations

import multiprocessing
import queue
import threading
from collections.abc import Collection, Iterator

import msgspec

from momentum_lab.app import worker
from momentum_lab.app.birth import born
from momentum_lab.app.demo_wire import DemoEvent
from momentum_lab.app.inbox import checked_event
from momentum_lab.app.lesson_wire import LessonEvent
from momentum_lab.app.wire import (
    Frame,
    FrameTaken,
    FrameWanted,
    OpenRun,
    RecordingWanted,
    RunTaken,
    RunWanted,
    TakeBack,
    packed,
    unpacked_answer,
)
from momentum_lab.errors import InputError
from momentum_lab.events import Event
from momentum_lab.run_file import Run, as_run
from momentum_lab.scenario import Scenario

# How long a worker may take to notice that its pipe is closed, s.
_PATIENCE = 5.0
# How long it may take to hand over a minute's recording on a busy machine, s.
_LONG_PATIENCE = 60.0


class Link:
    """A worker with its own session.

    Args:
        first: what the session starts with.
        robots: the robots that may be chosen.
        scenarios: the scenarios that may be chosen.
    """

    def __init__(self, first: Scenario | Run, robots: Collection[str], scenarios: Collection[str]) -> None:
        self._robots, self._scenarios = robots, set(scenarios)
        self._taken: queue.Queue[RunTaken] = queue.Queue()
        self._asking = threading.Lock()
        self._connection, theirs = multiprocessing.Pipe()
        self._sending = threading.Lock()
        self.process = born(worker.main, (theirs, msgspec.json.encode(as_run(first))), "session")
        theirs.close()

    def post(self, event: Event) -> None:
        """Hand an event to the session; it is lost if the session has gone.

        Raises:
            InputError: a value is not finite or not in range.
        """
        self._send(packed(checked_event(event, self._robots, self._scenarios)))

    def open(self, run: Run) -> None:
        """Let the session start a run that somebody has kept.

        Raises:
            InputError: its robot is not one that may be chosen.
        """
        if run.scenario.robot not in self._robots:
            raise InputError("robot", run.scenario.robot, f"one of {', '.join(self._robots)}")
        self._scenarios.add(run.scenario.name)
        self._send(packed(OpenRun(run)))

    def take_back(self) -> None:
        """Put the run on stage again that was there before another was opened."""
        self._send(packed(TakeBack()))

    def take_run(self) -> RunTaken:
        """The run as it is now, without samples; somebody has to read frames meanwhile.

        Raises:
            InputError: the session does not answer.
        """
        return self._take(RunWanted())

    def take_recording(self, patience: float = _LONG_PATIENCE) -> RunTaken:
        """The run as it is now, with the samples of both robots; somebody has to read frames meanwhile.

        Args:
            patience: how long to wait, s.

        Raises:
            InputError: the session does not answer.
        """
        return self._take(RecordingWanted(), patience)

    def _take(self, wanted: RunWanted | RecordingWanted, patience: float = _LONG_PATIENCE) -> RunTaken:
        with self._asking:
            while not self._taken.empty():
                self._taken.get()  # an answer that came too late for whoever asked
            self._send(packed(wanted))
            try:
                return self._taken.get(timeout=patience)
            except queue.Empty as error:
                raise InputError(
                    "run", "a session that does not answer", "one that runs: reload the page"
                ) from error

    def frames(self) -> Iterator[Frame]:
        """Frames as they come; asking for the next one says that the last one has been drawn."""
        with self._connection:
            while True:
                try:
                    data = self._connection.recv_bytes()
                except (EOFError, OSError):
                    return
                answer = unpacked_answer(data)
                if isinstance(answer, RunTaken):
                    self._taken.put(answer)
                    continue
                yield answer
                self._send(packed(FrameTaken()))

    def ask(self, event: LessonEvent | DemoEvent) -> None:
        """Hand on what a lesson or the demonstration asks for."""
        self._send(packed(event))

    def want_frame(self) -> None:
        """Ask for a frame even if nothing has happened."""
        self._send(packed(FrameWanted()))

    def close(self) -> None:
        """Let the worker go and wait until it is gone; `frames` ends."""
        self.process.terminate()
        self.process.join(_PATIENCE)
        if self.process.is_alive():
            self.process.kill()
            self.process.join()

    def _send(self, data: bytes) -> None:
        with self._sending:
            try:
                self._connection.send_bytes(data)
            except OSError:
                return  # the session has gone; whoever reads the frames finds out
