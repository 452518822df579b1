"""A finished run as a film: the browser tab draws it below the floor, out of sight, while the lab goes on above."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import viser

from momentum_lab.app.encoder import encoder, ffmpeg
from momentum_lab.app.pull import finite
from momentum_lab.app.reel import Reel
from momentum_lab.app.reel_scene import ReelScene
from momentum_lab.app.snapshot import render
from momentum_lab.app.view_panel import ViewSettings
from momentum_lab.app.world import add_floor
from momentum_lab.errors import InputError

Report = Callable[[float], None]

_STUDIO = "/film"
# Deep enough that neither of the two floors comes into the other's picture, m.
_BELOW = np.array([0.0, 0.0, -100.0])
# Width over height.
_SHAPE = 16.0 / 9.0


@dataclass(frozen=True, slots=True)
class _Shot:
    """From where the film is taken, and its size in pixels; both even, as films want it."""

    position: np.ndarray
    wxyz: np.ndarray
    fov: float
    width: int
    height: int

    @classmethod
    def of(cls, camera: viser.CameraHandle, lines: int) -> _Shot:
        """What a tab's camera sees now, seen below the floor, and more of it at the sides where docks hide it.

        Raises:
            InputError: the browser tells numbers that no camera has.
        """
        position, wxyz = finite(camera.position, 3, "camera"), finite(camera.wxyz, 4, "camera")
        fov, height = finite((camera.fov, camera.image_height), 2, "camera").tolist()
        if not 0.0 < fov < math.pi or height < 1.0:
            given = f"{fov:g} rad, {height:g} pixels"
            raise InputError("camera", given, "a field of view from 0 to pi, a picture of some height")
        height = min(height, float(lines))
        width, height = (2 * max(1, round(side / 2)) for side in (_SHAPE * height, height))
        return cls(position + _BELOW, wxyz, fov, width, height)


def film(client: viser.ClientHandle, reel: Reel, settings: ViewSettings, lines: int, report: Report) -> bytes:
    """The run from where the tab looks now, on a light page, as an .mp4 file in simulated time.

    Args:
        client: the browser tab that draws the pictures.
        reel: what to show.
        settings: which marks, and how; what is chosen meanwhile is for the next film.
        lines: height of the film, or of the tab's picture if that is lower, pixels.
        report: told the fraction that is done; whatever it raises ends the film.

    Raises:
        InputError: there is no ffmpeg, the browser does not answer, or tells nonsense.
    """
    ffmpeg()
    shot = _Shot.of(client.camera, lines)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "film.mp4"
        with (
            encoder(path, (shot.width, shot.height), reel.rate) as write,
            _studio(client, reel, replace(settings, shown=set(settings.shown))) as scene,
        ):
            for i in range(len(reel.rows)):
                with client.atomic():
                    scene.draw(i)
                write(_taken(client, shot))
                report((i + 1) / len(reel.rows))
        return path.read_bytes()


@contextmanager
def _studio(client: viser.ClientHandle, reel: Reel, settings: ViewSettings) -> Iterator[ReelScene]:
    """The robot of the film on a floor of its own."""
    node = client.scene.add_frame(_STUDIO, position=_BELOW, show_axes=False)
    try:
        add_floor(client, float(reel.ground.floor.origin[2]), "light", _STUDIO)
        yield ReelScene(client, reel, settings, _STUDIO)
    finally:
        node.remove()


def _taken(client: viser.ClientHandle, shot: _Shot) -> np.ndarray:
    """One picture (h, w, 3)."""
    return render(
        lambda patience: client.get_render(
            shot.height,
            shot.width,
            wxyz=shot.wxyz,
            position=shot.position,
            fov=shot.fov,
            transport_format="jpeg",
            timeout=patience,
        )
    )
