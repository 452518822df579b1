"""A picture of what a browser shows."""

from __future__ import annotations

import io
from collections.abc import Callable

import numpy as np
import viser
from PIL import Image

from momentum_lab.errors import InputError

# A browser that draws in software needs seconds, s.
_PATIENCE = 30.0


def view_of(client: viser.ClientHandle) -> bytes:
    """What a browser tab shows of the scene, as a PNG file on white.

    Raises:
        InputError: the browser does not answer.
    """
    camera = client.camera
    return encoded(
        render(
            lambda patience: client.get_render(
                camera.image_height, camera.image_width, transport_format="png", timeout=patience
            )
        )
    )


def render(ask: Callable[[float], np.ndarray]) -> np.ndarray:
    """The picture (h, w, 3 or 4) that a browser answers with; it is told for how long it is waited for, s.

    Raises:
        InputError: it does not answer, or has gone.
    """
    try:
        return ask(_PATIENCE)
    except (TimeoutError, RuntimeError) as error:
        raise InputError(
            "picture", "no answer", "a browser that draws: pause the run and try again"
        ) from error


def encoded(pixels: np.ndarray) -> bytes:
    """Pixels (h, w, 3 or 4) as a PNG file; what can be seen through is white."""
    picture = Image.fromarray(pixels).convert("RGBA")
    white = Image.new("RGBA", picture.size, "white")
    file = io.BytesIO()
    Image.alpha_composite(white, picture).convert("RGB").save(file, format="PNG")
    return file.getvalue()
