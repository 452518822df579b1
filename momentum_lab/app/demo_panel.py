"""The switch of the demonstration in the view tab."""

from __future__ import annotations

import math

import viser

from momentum_lab.app.demo import Demo
from momentum_lab.patience import LEAST_PATIENCE, MOST_PATIENCE, PATIENCE


class DemoPanel:
    """Whether the lab plays by itself, and after how long.

    Args:
        gui: where the widgets go.
        demo: what they change.
    """

    def __init__(self, gui: viser.GuiApi, demo: Demo) -> None:
        self._demo = demo
        on = demo.patience is not None
        self._switch = gui.add_checkbox(
            "demonstration",
            on,
            hint="For lecture halls: plays by itself when nobody has touched the lab for a while.",
        )
        self._wait = gui.add_slider(
            "after rest of (s)",
            LEAST_PATIENCE,
            MOST_PATIENCE,
            1.0,
            demo.patience or PATIENCE,
            hint="How long nobody has to touch the lab before it plays by itself, in seconds.",
            disabled=not on,
        )
        self._switch.on_update(lambda _: self._set())
        self._wait.on_update(lambda _: self._set())

    def _set(self) -> None:
        on, wait = bool(self._switch.value), _patience(self._wait.value)
        self._wait.disabled = not on
        self._demo.patience = wait if on else None
        self._demo.touch()


def _patience(value: object) -> float:
    """A browser's number as one that can be asked for, s; the usual one for what is none."""
    if not isinstance(value, int | float) or not math.isfinite(value):
        return PATIENCE
    return min(max(float(value), LEAST_PATIENCE), MOST_PATIENCE)
