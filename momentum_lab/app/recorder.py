"""A finished run as a file that plays by itself: a .viser recording, or a page with the player in it."""

from __future__ import annotations

import html
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np
import viser
from viser.infra import StateSerializer

from momentum_lab.app.camera import (
    FIELD_OF_VIEW,
    START_VIEW,
    USUAL,
    VIEWS,
    camera_pose,
    of_two,
    wide_enough,
)
from momentum_lab.app.profile import NORMAL, RenderProfile
from momentum_lab.app.quiet import quiet
from momentum_lab.app.reel import Reel
from momentum_lab.app.reel_scene import ReelScene
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.view_panel import ViewSettings
from momentum_lab.app.world import add_floor, add_world
from momentum_lab.finished import FinishedRun

_CAPTION = (
    '<div style="position:fixed;top:0.6em;right:0.8em;z-index:1;pointer-events:none;'
    'font:14px/1.4 sans-serif;color:#333">{}</div>'
)

Report = Callable[[float], None]


def viser_file(run: FinishedRun, report: Report = lambda _: None, profile: RenderProfile = NORMAL) -> bytes:
    """The run as a .viser file: every picture's poses as the recording has them, to the last bit.

    Args:
        run: what to show.
        report: told the fraction that is done.
        profile: how much a browser will have to draw.

    Raises:
        InputError: nothing was recorded.
        RobotError: a mesh of the robot is missing.
    """
    with _recorded(_reel(run), report, profile) as serializer:
        return serializer.serialize()


def html_file(run: FinishedRun, report: Report = lambda _: None, profile: RenderProfile = NORMAL) -> bytes:
    """The run as one HTML file with everything in it that its pictures and their player need.

    Args:
        run: what to show.
        report: told the fraction that is done.
        profile: how much a browser will have to draw.

    Raises:
        InputError: nothing was recorded.
        RobotError: a mesh of the robot is missing.
    """
    reel = _reel(run)
    with _recorded(reel, report, profile) as serializer:
        return _titled(serializer.as_html(), html.escape(reel.title)).encode()


def _reel(run: FinishedRun) -> Reel:
    return Reel.of(run, LoadedRobot.of(run.robot))


@contextmanager
def _recorded(reel: Reel, report: Report, profile: RenderProfile) -> Iterator[StateSerializer]:
    """All pictures of a reel, drawn for nobody by a server that lives no longer than that."""
    with quiet():
        server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    try:
        serializer = server.get_scene_serializer()
        add_world(server, profile)
        add_floor(server, float(reel.ground.floor.origin[2]), "light")
        _look(server, reel)
        scene = ReelScene(server, reel, ViewSettings())
        for i in range(len(reel.rows)):
            scene.draw(i)
            # The player's clock adds these up: so every picture comes at the nearest number to its own time.
            serializer.insert_sleep(reel.time(i + 1) - reel.time(i))
            report((i + 1) / len(reel.rows))
        yield serializer
    finally:
        with quiet():
            server.stop()


def _look(server: viser.ViserServer, reel: Reel) -> None:
    """Stand where everything that happens is seen."""
    com, view, offset = _way(reel), VIEWS[START_VIEW], np.zeros(2)
    size = float(com[0, 2])
    if reel.side is not None:
        offset = reel.side.offset
        com = np.concatenate([com, _way(reel.side.reel)])
        view = of_two(view, offset / size)
    low, high = com[:, :2].min(axis=0), com[:, :2].max(axis=0)
    view = wide_enough(view, (high - low) / size)
    target, position = camera_pose(view, size, 0.5 * (low + high + offset), USUAL)
    server.initial_camera.fov = FIELD_OF_VIEW
    server.initial_camera.position = position
    server.initial_camera.look_at = target


def _way(reel: Reel) -> np.ndarray:
    """The CoM in every picture but the last one of a run that broke down (n, 3), m."""
    com: np.ndarray = reel.rows[:, reel.robot.layout.slices["com"]]
    return com[np.isfinite(com).all(axis=1)]


def _titled(page: str, title: str) -> str:
    page = page.replace("<title>Viser</title>", f"<title>{title}</title>", 1)
    return page.replace("<body>", "<body>" + _CAPTION.format(title), 1)
