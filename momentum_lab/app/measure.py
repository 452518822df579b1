"""The app measured from outside: the real server, one bare client that pushes, and a second one that comes late."""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

from momentum_lab.app.bare_client import BareClient, Received
from momentum_lab.app.figures import AppMeasurement, growth, longest_gap
from momentum_lab.app.measured_server import MeasuredServer, stolen_time
from momentum_lab.errors import ServerError
from momentum_lab.scenario import Scenario, load_scenario

PUSH = "Push  (P)"
_ARROW = "/marks/push"
# A push stays in the picture for a little more than a second; the next one has to appear anew.
_PUSH_EVERY = 1.5
# Simulated time until a new robot stands still, s; and settling after the first push, s.
_CALM, _WARM_UP = 2.0, 3.0
# How long silence is listened to, s.
_LISTEN = 2.0
# What was sent in a hurry is on its way for so long, s: an hour of drawings would have been read long ago.
_SETTLING = 2.0
# Growth of memory is told from here on, and from so many seconds more, s.
_FIRST_MINUTE, _ENOUGH = 60.0, 60.0
# A run of ten minutes or more is followed by an hour's worth of messages, a shorter one by less in proportion.
_HOUR, _LONG = 3600.0, 600.0
_PATIENCE = 60.0

Report = Callable[[float], None]


@dataclass
class Course:
    """What a run with pushes notes down.

    Attributes:
        delays: from each push to the drawing that shows it, s.
        times: when memory was looked at, from the start of the run, s.
        memory: what it was then, bytes.
    """

    delays: list[float] = field(default_factory=list)
    times: list[float] = field(default_factory=list)
    memory: list[float] = field(default_factory=list)

    @property
    def growth(self) -> float | None:
        """Of the memory after the first minute, MB per minute; None when it cannot be told."""
        late = [(t, size) for t, size in zip(self.times, self.memory, strict=True) if t >= _FIRST_MINUTE]
        if not late or late[-1][0] - late[0][0] < 0.9 * _ENOUGH or not math.isfinite(late[-1][1]):
            return None
        return 60e-6 * growth([t for t, _ in late], [size for _, size in late])


def measure_app(
    seconds: float = 20.0, scenario: Scenario | None = None, report: Report = lambda _: None
) -> AppMeasurement:
    """Serve the lab in a process of its own, push the robot again and again from one bare client, and count.

    Args:
        seconds: how long to measure; listening to silence and the second connection come on top.
        scenario: what the session starts with; None: standing Talos.
        report: is told the fraction done.

    Raises:
        ServerError: the lab does not start, or a push is never seen.
    """
    with MeasuredServer(scenario or load_scenario("stand")) as server:
        opened = time.perf_counter()
        with BareClient(server.url) as client:
            client.read_until(_furnished, _PATIENCE)
            first_picture = time.perf_counter() - opened
            return _measured(server, client, seconds, first_picture, report)


def _measured(
    server: MeasuredServer, client: BareClient, seconds: float, first_picture: float, report: Report
) -> AppMeasurement:
    drawn_while_standing = _standing(client)
    client.set_value(PUSH, True)
    received = client.read(_WARM_UP)
    before, then, simulated = server.vitals(), *received.told
    pictures, messages, stolen = received.drawings, received.messages, stolen_time()
    start = time.perf_counter()
    course = _run(server, client, seconds, report)
    elapsed, after, stolen = time.perf_counter() - start, server.vitals(), stolen_time() - stolen
    pictures, messages = received.drawings - pictures, received.messages - messages
    now, simulated_now = received.told
    sent_while_paused = _paused(client)
    aged = _HOUR * min(1.0, seconds / _LONG)
    stall, first_picture_aged = _newcomer(server, client, round(aged * messages / elapsed))
    return AppMeasurement(
        seconds=elapsed,
        real_time_factor=(simulated_now - simulated) / (now - then),
        drawings_per_second=pictures / elapsed,
        messages_per_second=messages / elapsed,
        late_ticks_per_minute=(after.late_ticks - before.late_ticks) / (elapsed / 60.0),
        stolen=1e3 * stolen / (elapsed / 60.0),
        server_cpu=(after.cpu - before.cpu) / elapsed,
        push_delay=statistics.median(course.delays),
        push_delay_longest=max(course.delays),
        memory_growth=course.growth,
        sent_while_paused=sent_while_paused,
        drawn_while_standing=drawn_while_standing,
        first_picture=first_picture,
        aged=aged,
        first_picture_aged=first_picture_aged,
        stall=stall,
    )


def _run(server: MeasuredServer, client: BareClient, seconds: float, report: Report) -> Course:
    """Push every second and a half."""
    course, start = Course(), time.perf_counter()
    while (passed := time.perf_counter() - start) < seconds:
        course.delays.append(_push(client))
        client.read(max(0.1, _PUSH_EVERY - (time.perf_counter() - start - passed)))
        course.times.append(time.perf_counter() - start)
        course.memory.append(server.vitals().memory)
        report(passed / seconds)
    return course


def _push(client: BareClient) -> float:
    """Press the button once the last push is out of the picture; how long until a drawing shows the arrow, s."""
    try:
        client.read_until(lambda received: _ARROW not in received.shown, _PATIENCE)
        pressed = time.perf_counter()
        client.set_value(PUSH, True)
        received = client.read_until(lambda received: _ARROW in received.shown, _PATIENCE)
    except TimeoutError as error:
        raise ServerError(
            "app", "a push that is not drawn", f"one that is, within {_PATIENCE:.0f} s"
        ) from error
    return received.shown[_ARROW] - pressed


def _standing(client: BareClient) -> float:
    """Changes in the scene per second while the robot stands still and time runs."""
    changes = client.read_until(lambda received: received.told[1] > _CALM, _PATIENCE).changes
    return (client.read(_LISTEN).changes - changes) / _LISTEN


def _paused(client: BareClient) -> float:
    """Messages per second while time stands still in the middle of a push."""
    client.set_value("time", "Pause")
    messages = client.read(0.5).messages
    messages = client.read(_LISTEN).messages - messages
    client.set_value("time", "Play")
    return messages / _LISTEN


def _newcomer(server: MeasuredServer, client: BareClient, messages: int) -> tuple[float, float]:
    """Another tab opens after so many messages: the longest time without a drawing, and its first picture, s."""
    server.begin_aging(messages)
    client.read_until(lambda _: server.aged(), _HOUR)
    client.read(_SETTLING)
    client.set_value(PUSH, True)
    client.read(0.3)
    with ThreadPoolExecutor(1) as pool:
        start = pushed = time.perf_counter()
        waited = pool.submit(_first_picture, server.url)
        while not waited.done():
            if time.perf_counter() - pushed > 1.0:
                pushed = time.perf_counter()
                client.set_value(PUSH, True)
            client.read(0.05)
    return longest_gap(client.received.pictures, start, time.perf_counter()), waited.result()


def _first_picture(url: str) -> float:
    start = time.perf_counter()
    with BareClient(url) as other:
        other.read_until(_furnished, _PATIENCE)
        return time.perf_counter() - start


def _furnished(received: Received) -> bool:
    return PUSH in received.labels
