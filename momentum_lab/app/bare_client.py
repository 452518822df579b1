"""A browser tab without a browser: it counts what the lab sends, so that drawing can be measured without a screen."""

from __future__ import annotations

import re
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from types import TracebackType
from typing import Any

import msgspec
import viser
import zstandard
from websockets.sync.client import ClientConnection, connect

# What the page says about simulated time.
_SIMULATED = re.compile(r"simulated time \u2007*<b>([0-9.]+) s</b>")
# Messages that move something in the scene.
_MOVING = frozenset({"SetPositionMessage", "SetOrientationMessage", "SceneNodeUpdateMessage"})


@dataclass
class Received:
    """What a client has received.

    Attributes:
        turned: how often each node of the scene was turned; a picture turns a node once.
        pictures: when windows came in which the robot moves, s.
        shown: since when each node of the scene that has not been hidden has been there, s.
        changes: how many things were moved, turned or changed in the scene.
        told: when the simulated time was last told, and what it was, s.
        kinds: how many messages of each type.
        latest: the latest message of each type.
        notices: what notifications have said.
        labels: uuid of each widget by its label.
    """

    turned: Counter[str] = field(default_factory=Counter)
    pictures: list[float] = field(default_factory=list)
    shown: dict[str, float] = field(default_factory=dict)
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

    @property
    def messages(self) -> int:
        """Everything that has come."""
        return self.kinds.total()

    def take(self, messages: list[dict[str, Any]], now: float | None = None) -> None:
        """Count one window of messages that came at a time; None: this very moment."""
        now = time.perf_counter() if now is None else now
        for message in messages:
            self.kinds[message["type"]] += 1
            self.latest[message["type"]] = message
            self._take_scene(message, now)
            self._take_page(message, now)
        if any(message["type"] == "SetOrientationMessage" for message in messages):
            self.pictures.append(now)

    def _take_scene(self, message: dict[str, Any], now: float) -> None:
        kind = message["type"]
        self.changes += kind in _MOVING
        if kind == "SetOrientationMessage":
            self.turned[message["name"]] += 1
        if "props" in message and "name" in message:
            self.shown[message["name"]] = now
        if kind == "SetSceneNodeVisibilityMessage":
            if message["visible"]:
                self.shown.setdefault(message["name"], now)
            else:
                self.shown.pop(message["name"], None)

    def _take_page(self, message: dict[str, Any], now: float) -> None:
        properties = message.get("props") or {}
        if message["type"] == "NotificationShowMessage":
            self.notices.append(properties["body"])
        if "label" in properties and "uuid" in message:
            self.labels[properties["label"]] = message["uuid"]
        told = _SIMULATED.search(str((message.get("updates") or {}).get("content", "")))
        if told:
            self.told = (now, float(told.group(1)))


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
        """Take what comes until `seen(received)` holds; nothing, if it does already.

        Raises:
            TimeoutError: it does not hold in time.
        """
        if seen(self.received):
            return self.received
        for messages in self._windows(time.perf_counter() + patience):
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
