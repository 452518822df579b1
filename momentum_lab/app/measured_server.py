"""The lab in a process of its own that tells what it costs and can be made to look old."""

from __future__ import annotations

import math
import multiprocessing
import os
import time
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from types import TracebackType
from typing import Any

import viser

from momentum_lab.app.profile import TEST
from momentum_lab.app.server import LabServer
from momentum_lab.errors import ServerError
from momentum_lab.scenario import Scenario

# How long the lab may take to start, and to answer, s.
_PATIENCE = 60.0
# Things that are changed at once while messages are sent in a hurry: about as many as a drawing changes.
_AT_ONCE = 32


@dataclass(frozen=True, slots=True)
class Vitals:
    """What the lab has cost so far.

    Attributes:
        cpu: processor time of the server's process, without its sessions, s.
        memory: resident memory of the server and of the sessions, bytes; NaN where the system does not tell.
        late_ticks: ticks of all open sessions that began late.
    """

    cpu: float
    memory: float
    late_ticks: int


class MeasuredServer:
    """The lab, served by a process that is there for nothing else; use it as a context manager.

    Args:
        scenario: what sessions start with.

    Raises:
        ServerError: the lab does not start.
    """

    def __init__(self, scenario: Scenario) -> None:
        context = multiprocessing.get_context("spawn")
        self._pipe, theirs = context.Pipe()
        self._process = context.Process(target=_serve, args=(theirs, scenario))
        self._process.start()
        theirs.close()
        try:
            self.url: str = self._answer(_PATIENCE)
        except ServerError:
            self.close()
            raise

    def vitals(self) -> Vitals:
        """What the lab has cost so far."""
        self._pipe.send("vitals")
        answer: Vitals = self._answer(_PATIENCE)
        return answer

    def begin_aging(self, messages: int) -> None:
        """Send so many messages to the first client as fast as it goes; `aged` tells when they are sent."""
        self._pipe.send(messages)

    def aged(self) -> bool:
        """Whether the messages have been sent; true once."""
        return self._pipe.poll(0.0) and bool(self._answer(_PATIENCE))

    def close(self) -> None:
        """End the lab."""
        self._pipe.close()
        self._process.join(10.0)
        self._process.kill()
        self._process.join()

    def __enter__(self) -> MeasuredServer:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _answer(self, patience: float) -> Any:
        try:
            if self._pipe.poll(patience):
                return self._pipe.recv()
        except EOFError:
            pass
        raise ServerError("app", "no answer", f"one within {patience:.0f} s")


def _serve(pipe: Connection, scenario: Scenario) -> None:
    """The lab, until the pipe closes."""
    with LabServer(scenario, profile=TEST) as lab, pipe:
        pipe.send(lab.url)
        while True:
            try:
                asked = pipe.recv()
            except EOFError:
                return
            pipe.send(_vitals(lab) if asked == "vitals" else send_many(lab.visitors[0].client, asked))


def _vitals(lab: LabServer) -> Vitals:
    visitors = lab.visitors
    pids = [os.getpid(), *(visitor.worker_pid for visitor in visitors if visitor.worker_pid)]
    frames = [visitor.latest for visitor in visitors]
    return Vitals(
        cpu=time.process_time(),
        memory=sum(resident_memory(pid) for pid in pids),
        late_ticks=sum(frame.late_ticks for frame in frames if frame is not None),
    )


def resident_memory(pid: int) -> float:
    """Resident memory of a process, bytes; NaN where the system has no /proc."""
    try:
        pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    except OSError:
        return math.nan
    return float(pages * os.sysconf("SC_PAGE_SIZE"))


def send_many(client: viser.ClientHandle, count: int) -> bool:
    """Send a client at least so many messages the way a drawing sends them, about things that nobody sees."""
    frames = [client.scene.add_frame(f"/age/{i}", show_axes=False) for i in range(_AT_ONCE)]
    for block in range(math.ceil(count / _AT_ONCE)):
        with client.atomic():
            for frame in frames:
                frame.visible = block % 2 == 1
        client.flush()
    client.scene.remove_by_name("/age")
    return True


def stolen_time() -> float:
    """Processor time that the host of a virtual machine has given to others so far, s; NaN where none is told."""
    try:
        ticks = int(Path("/proc/stat").read_text().split(None, 9)[8])
    except (OSError, IndexError, ValueError):
        return math.nan
    return ticks / float(os.sysconf("SC_CLK_TCK"))
