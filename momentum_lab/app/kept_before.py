"""The way back from an opened run: what was on stage before it, and the button that puts it there again."""

from __future__ import annotations

from collections.abc import Callable

import viser

from momentum_lab.app import html
from momentum_lab.app.wire import Truth
from momentum_lab.palette import BLUE

WAY_BACK = "Take back, in the Share tab, returns to it"


class KeptBefore:
    """One line and a button, while there is something to take back.

    Args:
        gui: where they go.
        take_back: puts the run before the opened one on stage again.
        say: tells a person what has happened.
        leave: forgets what belongs to the run that is left.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        take_back: Callable[[], None],
        say: Callable[[str], None],
        leave: Callable[[], None],
    ) -> None:
        self._take_back, self._say, self._leave = take_back, say, leave
        self._left: tuple[str, ...] = ()
        self._line = gui.add_html("", visible=False)
        self._button = gui.add_button(
            "Take back",
            color=BLUE,
            icon=viser.Icon.ARROW_BACK_UP,
            visible=False,
            hint="Puts the run that was here before on stage again, as it was.",
        )
        self._button.on_click(lambda _: self._back())

    def follow(self, truth: Truth, left: tuple[str, ...]) -> None:
        """Show what can be taken back; a run that has just been left is told.

        Args:
            truth: what is the case.
            left: the runs that can be taken back, in words, the last one last.
        """
        if left == self._left:
            return
        before, self._left = self._left, left
        if left and len(left) >= len(before):
            self._say(f"{truth.scenario} is open now. Your run ({left[-1]}) is kept: {WAY_BACK}.")
        self._line.content = html.sentence(f"Kept: your run ({left[-1]}).") if left else ""
        self._line.visible = self._button.visible = bool(left)

    def _back(self) -> None:
        self._leave()
        self._take_back()
