"""What a hand in the picture does: with Shift or without, when it lets go or while it pulls, level or upright."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import viser

from momentum_lab.app import html
from momentum_lab.app.pull import lifted, pulled
from momentum_lab.app.widgets import one_of

MODIFIER: Final = "shift"
"""What a hand that pulls holds down, unless a drag pushes anyway."""

_BY_HAND = ("pulse", "hold")
_PLANES = {"over the ground": pulled, "up and sideways": lifted}


class HandPanel:
    """The widgets of a hand.

    Args:
        gui: where they go.
        redraw: asks for a new picture.
    """

    def __init__(self, gui: viser.GuiApi, redraw: Callable[[], None]) -> None:
        self._redraw = redraw
        gui.add_html(html.sentence("Or hold Shift and drag the robot in the picture."))
        self._plain: Any = gui.add_checkbox(
            "drag pushes the robot",
            False,
            hint="Drag without Shift, as with a finger (key T). Beside the robot a drag still turns the picture.",
        )
        self._by_hand: Any = gui.add_dropdown(
            "by hand",
            _BY_HAND,
            hint="pulse pushes for the duration below when you let go, hold pulls for as long as you do. "
            "Back where you began, or Z: no push.",
        )
        self._plane: Any = gui.add_dropdown(
            "pulls", tuple(_PLANES), hint="In which plane your hand moves: level, or upright and facing you."
        )
        self._plain.on_update(lambda _: redraw())

    @property
    def by_hand(self) -> str:
        """What a hand in the picture does: `pulse` or `hold`.

        Raises:
            InputError: a browser has chosen something else.
        """
        return one_of(self._by_hand, "by hand", _BY_HAND)

    @property
    def pulled(self) -> Callable[..., Any]:
        """How far a hand has pulled, out of eye, grabbed point and pointer: over one plane or the other.

        Raises:
            InputError: a browser has chosen something else.
        """
        return _PLANES[one_of(self._plane, "pulls", tuple(_PLANES))]

    @property
    def modifier(self) -> str | None:
        """What has to be held down for a drag to push; None: nothing."""
        return None if self._plain.value else MODIFIER

    def toggle(self) -> None:
        """Let a drag push the robot, or turn the picture again."""
        self._plain.value = not self._plain.value
        self._redraw()
