"""A browser tab without a browser: it counts what the lab sends, so that drawing can be measured without a screen."""

from __future__ import annotations

import multiprocessing
import re
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from types import TracebackType
from typing import Any

import msgspec
import viser
import zstandard
from websockets.sync.client import ClientConnection, connect

from momentum_lab.app.profile import TEST
from momentum_lab.errors import ServerError
from momentum_lab.scenario import Scenario, load_scenario

# What the page says about simulated time.
_SIMULATED = re.compile(r"simulated time <b>([0-9.]+) s</b>")
# Messages that move something in the scene.
_MOVING = frozenset({"SetPositionMessage", "SetOrientationMessage", "SceneNodeUpdateMessage"})
# Settling before and between what is measured, s.
_WARM_UP, _PUSH_EVERY = 2.0, 1.0


@dataclass(frozen=True, slots=True)
class AppMeasurement:
    """How the app does with one client that reads as fast as it can.

    Attributes:
        seconds: how long was measured.
        real_time_factor: simulated seconds per second, as the page tells it.
        drawings_per_second: pictures of a moving robot received per second.
        messages_per_drawing: how many things one picture changes.
        first_picture: from opening the connection to the first picture of the robot, s.
    """

    seconds: float
    real_time_factor: float
    drawings_per_second: float
    messages_per_drawing: float
    first_picture: float


@dataclass
class Received:
    """What a client has received.

    Attributes:
        turned: how often each node of the scene was turned; a picture turns a node once.
        changes: how many things were moved, turned or changed in the scene.
        told: when the simulated time was last told, and what it was, s.
        kinds: how many messages of each type.
        latest: the latest message of each type.
        notices: what notifications have said.
        labels: uuid of each widget by its label.
    """

    turned: Counter[str] = field(default_factory=Counter)
    changes: int = 0
    told: tuple[float, float] = (0.0, 0.0)
    kinds: Counter[str] = field(default_factory=Counter)
    latest: dict[str, dict[str, Any]] = field(default_factory=dict)
    notices: list[str] = field(default_factory=list)
    labels: dict[str, str] = field(default_factory=dict)

    @property
    def drawings(self) -> int:
        """Pictures of a moving robot: at least as many as the busiest joint was turned."""
        return max(self.turned.values(), default=0)

    def take(self, messages: list[dict[str, Any]]) -> None:
        """Count one window of messages."""
        for message in messages:
            self.kinds[message["type"]] += 1
            self.latest[message["type"]] = message
            self.changes += message["type"] in _MOVING
            if message["type"] == "SetOrientationMessage":
                self.turned[message["name"]] += 1
            properties = message.get("props") or {}
            if message["type"] == "NotificationShowMessage":
                self.notices.append(properties["body"])
            if "label" in properties and "uuid" in message:
                self.labels[properties["label"]] = message["uuid"]
            told = _SIMULATED.search(str((message.get("updates") or {}).get("content", "")))
            if told:
                self.told = (time.perf_counter(), float(told.group(1)))


class BareClient:
    """A connection that speaks viser's protocol and draws nothing.

    Args:
        url: where the lab is, http://host:port.
    """

    def __init__(self, url: str) -> None:
        address = url.replace("http://", "ws://")
        protocol: Any = f"viser-v{viser.__version__}"
        self._socket: ClientConnection = connect(
            address, subprotocols=[protocol], max_size=None, compression=None
        )
        self._zstd = zstandard.ZstdDecompressor()
        self.received = Received()
        self.send(_camera())

    def send(self, message: dict[str, Any]) -> None:
        """Send one message as a browser would."""
        self.send_raw(msgspec.msgpack.encode(message))

    def send_raw(self, data: bytes) -> None:
        """Send bytes as no browser would."""
        self._socket.send(data)

    def set_value(self, label: str, value: Any) -> None:
        """Give a widget a value, whether it is allowed or not; True presses a button.

        Raises:
            KeyError: no widget with that label has been received.
        """
        uuid = self.received.labels[label]
        self.send({"type": "GuiUpdateMessage", "uuid": uuid, "updates": {"value": value}})

    def read(self, seconds: float) -> Received:
        """Take everything that comes for a while."""
        end = time.perf_counter() + seconds
        for messages in self._windows(end):
            self.received.take(messages)
        return self.received

    def read_until(self, seen: Any, patience: float) -> Received:
        """Take what comes until `seen(received)` holds.

        Raises:
            TimeoutError: it does not hold in time.
        """
        end = time.perf_counter() + patience
        for messages in self._windows(end):
            self.received.take(messages)
            if seen(self.received):
                return self.received
        raise TimeoutError(f"not seen within {patience} s")

    def close(self) -> None:
        """Close the tab."""
        self._socket.close()

    def __enter__(self) -> BareClient:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _windows(self, end: float) -> Iterator[list[dict[str, Any]]]:
        while (left := end - time.perf_counter()) > 0.0:
            try:
                data = self._socket.recv(timeout=left)
            except TimeoutError:
                return
            yield self._messages(data)

    def _messages(self, data: str | bytes) -> list[dict[str, Any]]:
        """One window: lengths of the plain and the packed text, the packed text, then raw arrays."""
        if isinstance(data, str):
            return []
        length, packed = int.from_bytes(data[:8], "little"), int.from_bytes(data[8:16], "little")
        text = self._zstd.decompress(data[16 : 16 + packed], max_output_size=length)
        found: list[dict[str, Any]] = msgspec.msgpack.decode(text)["messages"]
        return found


def measure_app(seconds: float = 10.0, scenario: Scenario | None = None) -> AppMeasurement:
    """Serve the lab in a process of its own, push the robot every second from one bare client, and count.

    Args:
        seconds: how long to measure.
        scenario: what the session starts with; None: standing Talos.

    Raises:
        ServerError: the lab does not start.
    """
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    server = context.Process(target=_serve, args=(theirs, scenario or load_scenario("stand")))
    server.start()
    theirs.close()
    try:
        if not ours.poll(60.0):
            raise ServerError("app", "no answer within 60 s", "a machine that can run it")
        with BareClient(ours.recv()) as client:
            return _measure(client, seconds)
    finally:
        ours.close()
        server.join(10.0)
        server.kill()


def _measure(client: BareClient, seconds: float) -> AppMeasurement:
    opened = time.perf_counter()
    client.read_until(lambda received: "Push  (P)" in received.labels, 60.0)
    first_picture = time.perf_counter() - opened
    client.set_value("Push  (P)", True)
    client.read(_WARM_UP)
    received = client.received
    drawings, changes, (then, simulated) = received.drawings, received.changes, received.told
    start = time.perf_counter()
    while time.perf_counter() - start < seconds:
        client.set_value("Push  (P)", True)
        client.read(min(_PUSH_EVERY, seconds - (time.perf_counter() - start)))
    elapsed = time.perf_counter() - start
    pictures = received.drawings - drawings
    now, simulated_now = received.told
    return AppMeasurement(
        seconds=elapsed,
        real_time_factor=(simulated_now - simulated) / (now - then),
        drawings_per_second=pictures / elapsed,
        messages_per_drawing=(received.changes - changes) / max(1, pictures),
        first_picture=first_picture,
    )


def _serve(pipe: Connection, scenario: Scenario) -> None:
    """The lab, until the pipe closes."""
    from momentum_lab.app.server import LabServer

    with LabServer(scenario, profile=TEST) as lab, pipe:
        pipe.send(lab.url)
        pipe.poll(None)


def _camera() -> dict[str, Any]:
    """The first thing a browser tells: where its camera is."""
    return {
        "type": "ViewerCameraMessage",
        "wxyz": (1.0, 0.0, 0.0, 0.0),
        "position": (3.0, 0.0, 1.0),
        "fov": 0.6,
        "near": 0.01,
        "far": 1000.0,
        "image_height": 800,
        "image_width": 1280,
        "look_at": (0.0, 0.0, 1.0),
        "up_direction": (0.0, 0.0, 1.0),
    }
