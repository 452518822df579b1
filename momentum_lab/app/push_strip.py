"""Above the slider that looks back: when the robot was pushed, as marks along it."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence

import viser

from momentum_lab.app.viser_page import ROW

# How often the marks move while time runs, s.
_PERIOD = 1.0
# The slider's row: what stands right of its track, and left of it, in its own lengths.
_LEFT, _RIGHT = "calc(var(--mantine-spacing-xs) + 4px)", "calc(3rem + 2 * var(--mantine-spacing-xs) + 4px)"
_PUSH = "var(--mantine-color-dimmed)"
# The words of the slider go into this line, and their place to the slider itself.
_WIDE = (
    f"<style>div:has(>.lab-look)+* {ROW}>div:has(>*>label){{"
    "width:0!important;height:0;padding:0!important;overflow:hidden}</style>"
)


class PushStrip:
    """One line above the slider, which becomes as wide as its panel.

    Args:
        gui: where it goes.
        words: what the slider is called.
        clock: seconds, for tests.
    """

    def __init__(self, gui: viser.GuiApi, words: str, clock: Callable[[], float] = time.monotonic) -> None:
        self._words, self._clock = words, clock
        self._next, self._text = -math.inf, ""
        self._handle = gui.add_html(in_html(words, ()))

    def follow(self, ages: Sequence[float], reach: float, playing: bool) -> None:
        """Show pushes: at once in a pause, else once a second.

        Args:
            ages: how long before the end of the run they began, s.
            reach: how far the slider goes back, s.
            playing: whether time runs.
        """
        if playing and self._clock() < self._next:
            return
        self._next = self._clock() + _PERIOD
        text = in_html(self._words, [100.0 * (1.0 - age / reach) for age in ages if 0.0 <= age <= reach])
        if text != self._text:
            self._text = self._handle.content = text


def in_html(words: str, places: Sequence[float]) -> str:
    """The line: words, and a mark at each place, in percent of the slider from its left end."""
    marks = "".join(
        f'<span data-push style="position:absolute;left:{place:.1f}%;bottom:0;width:4px;height:.8em;'
        f'margin-left:-2px;background:{_PUSH}"></span>'
        for place in places
    )
    note = f'<span style="color:{_PUSH}">▮</span> push' if places else ""
    return (
        f'{_WIDE}<div class="lab-strip" style="margin:0 {_RIGHT} -.3em {_LEFT};position:relative;height:1.2em;'
        f'font-size:.8em;line-height:1.2;display:flex;gap:1.5em;color:{_PUSH}">'
        f"<span>{words}</span><span>{note}</span>{marks}</div>"
    )
