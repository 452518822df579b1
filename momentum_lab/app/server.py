"""Serving the lab: one page, one session in its own process for every browser tab that opens it."""

from __future__ import annotations

import contextlib
import errno
import signal
import socket
import threading
import warnings
import webbrowser
from collections.abc import Iterator
from pathlib import Path
from types import TracebackType

import viser

from momentum_lab.app.birth import warm_up
from momentum_lab.app.control_panel import Choices
from momentum_lab.app.first_pose import FirstPose
from momentum_lab.app.library import Library
from momentum_lab.app.parting import part
from momentum_lab.app.profile import NORMAL, RenderProfile
from momentum_lab.app.quiet import quiet
from momentum_lab.app.robots import RobotShelf
from momentum_lab.app.visitor import Visitor
from momentum_lab.app.wake import wake_safely
from momentum_lab.errors import ServerError
from momentum_lab.robot.catalog import robot_names
from momentum_lab.run_file import Run, as_run
from momentum_lab.scenario import Scenario, scenario_names, sides
from momentum_lab.session import Session

MOST_VISITORS = 12
"""Browser tabs at a time; each one has a process that keeps a core busy."""

_HIGHEST_PORT = 65535


class LabServer:
    """The lab on a port; use it as a context manager, or call `close`.

    Args:
        first: what every new session starts with.
        host: address to listen on.
        port: port to listen on; 0 for any free one.
        profile: how much browsers have to draw.
        library: the lessons; None: those that ship with the package.
        lesson: the script of the lesson that every browser tab begins with.
        demo: how long nobody has to touch a tab before it plays by itself, s; None: it never does.

    Raises:
        ServerError: the host or the port cannot be used.
        InputError: the scenario cannot start, or a mesh of its robot is missing.
    """

    def __init__(
        self,
        first: Scenario | Run,
        host: str = "127.0.0.1",
        port: int = 0,
        profile: RenderProfile = NORMAL,
        library: Library | None = None,
        lesson: Path | None = None,
        demo: float | None = None,
    ) -> None:
        _check_address(host, port)
        self._library, self._lesson, self._demo = library or Library(), lesson, demo
        self._first, self._profile = as_run(first), profile
        scenario = self._first.scenario
        warm_up()
        self._shelf = RobotShelf(profile.cell)
        # Refuses what cannot start.
        sessions = [Session(side, self._shelf.get(side.robot).model, capacity=1) for side in sides(scenario)]
        self._pose = FirstPose.of(sessions[0])
        self._choices = Choices(
            tuple(dict.fromkeys((*robot_names(), scenario.robot))),
            tuple(dict.fromkeys((*scenario_names(), scenario.name))),
        )
        self._visitors: dict[int, Visitor] = {}
        self._left: set[int] = set()
        self._lock = threading.Lock()
        # A tab may close while a picture for it is under way; viser says so for every such picture.
        warnings.filterwarnings("ignore", message=r"Queued a \w+ on a closed connection")
        with quiet():
            self._viser = viser.ViserServer(host=host, port=port, verbose=False)
        self.host, self.port = host, self._viser.get_port()
        if port not in (0, self.port):
            self.close()
            raise _in_use(port)
        self._viser.on_client_connect(self._welcome)
        self._viser.on_client_disconnect(self._farewell)

    @property
    def url(self) -> str:
        """Where a browser finds the lab."""
        host = {"0.0.0.0": "127.0.0.1", "::": "[::1]"}.get(self.host, self.host)
        return f"http://{host}:{self.port}"

    @property
    def visitors(self) -> list[Visitor]:
        """The browser tabs that are open now."""
        with self._lock:
            return list(self._visitors.values())

    def close(self) -> None:
        """End all sessions and give the port back."""
        with quiet():
            part(self._viser)
            self._viser.stop()
        for visitor in self.visitors:
            visitor.close()

    def __enter__(self) -> LabServer:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _welcome(self, client: viser.ClientHandle) -> None:
        with self._lock:
            if client.client_id in self._left:
                self._left.discard(client.client_id)
                return
            if len(self._visitors) >= MOST_VISITORS:
                client.add_notification("The lab is full", f"{MOST_VISITORS} tabs are open: close one.")
                return
            wake_safely(client)
            self._visitors[client.client_id] = Visitor(
                client,
                self._shelf,
                self._first,
                self._pose,
                self._choices,
                self._profile,
                self.url,
                self._library,
                self._lesson,
                self._demo,
            )

    def _farewell(self, client: viser.ClientHandle) -> None:
        with self._lock:
            visitor = self._visitors.get(client.client_id)
            if visitor is None:
                self._left.add(client.client_id)  # gone before it was welcomed
                return
        visitor.close()
        with self._lock:
            del self._visitors[client.client_id]


def serve(
    first: Scenario | Run,
    host: str = "127.0.0.1",
    port: int = 8080,
    open_browser: bool = True,
    profile: RenderProfile = NORMAL,
    library: Library | None = None,
    lesson: Path | None = None,
    demo: float | None = None,
) -> None:
    """Serve the lab until Ctrl+C or SIGTERM.

    Args:
        first: what every new session starts with.
        host: address to listen on.
        port: port to listen on; 0 for any free one.
        open_browser: whether to open the page in this machine's browser.
        profile: how much browsers have to draw.
        library: the lessons; None: those that ship with the package.
        lesson: the script of the lesson that every browser tab begins with.
        demo: how long nobody has to touch a tab before it plays by itself, s; None: it never does.

    Raises:
        ServerError: the host or the port cannot be used.
        InputError: the scenario cannot start, or a mesh of its robot is missing.
    """
    with _ended_by_signal() as ended, LabServer(first, host, port, profile, library, lesson, demo) as lab:
        print(f"momentum lab: {lab.url}  (Ctrl+C ends it)", flush=True)
        if open_browser:
            webbrowser.open(lab.url)
        ended.wait()


@contextlib.contextmanager
def _ended_by_signal() -> Iterator[threading.Event]:
    """An event that Ctrl+C and SIGTERM set, for as long as the context lasts."""
    ended = threading.Event()
    before = {
        number: signal.signal(number, lambda *_: ended.set()) for number in (signal.SIGINT, signal.SIGTERM)
    }
    try:
        yield ended
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _check_address(host: str, port: int) -> None:
    """Refuse an address that cannot be listened on; viser would move to another port or wait for ever."""
    if not 0 <= port <= _HIGHEST_PORT:
        raise ServerError("port", port, f"0 (any free port) to {_HIGHEST_PORT}")
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        with socket.socket(family, kind, protocol) as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            probe.bind(address)
    except OSError as error:
        if error.errno == errno.EADDRINUSE:
            raise _in_use(port) from error
        if error.errno == errno.EACCES:
            raise ServerError("port", port, "a port that this user may open: 1024 or higher, or 0") from error
        raise ServerError("host", host, "an address of this machine, such as 127.0.0.1 or 0.0.0.0") from error


def _in_use(port: int) -> ServerError:
    return ServerError("port", f"{port}, which is in use", "a free port, or 0 to let the system choose one")
