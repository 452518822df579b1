"""Several pushes in time: put together from the push above, changed, played, cleared."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import msgspec
import viser

from momentum_lab.app import html
from momentum_lab.app.inbox import MOST_PUSHES
from momentum_lab.app.push_panel import PushPanel
from momentum_lab.app.widgets import Post
from momentum_lab.errors import InputError
from momentum_lab.events import ApplyPushes
from momentum_lab.physics.push import Push

# How long after the last one the next push is proposed, and when one may start at the latest, s.
_GAP, _LATEST = 0.5, 20.0


class SequencePanel:
    """The widgets of a sequence of pushes.

    Args:
        gui: where they go.
        post: where events go.
        tell: shows a person what was wrong.
        panel: describes the push that is added.
        pushes: the pushes of the run so far.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        post: Post,
        tell: Callable[[str], None],
        panel: PushPanel,
        pushes: Callable[[], tuple[Push, ...]],
    ) -> None:
        self._gui, self._post, self._tell = gui, post, tell
        self._panel, self._of_run = panel, pushes
        self.sequence: tuple[Push, ...] = ()
        self._items: list[Any] = []
        with gui.add_folder("Sequence of pushes", expand_by_default=False):
            self._start: Any = gui.add_slider(
                "starts at (s)", 0.0, _LATEST, 0.05, 0.0, hint="Counted from when the sequence is played."
            )
            add = gui.add_button("Add to sequence", color="gray", icon=viser.Icon.PLUS)
            take = gui.add_button(
                "Take the pushes of this run",
                color="gray",
                icon=viser.Icon.HISTORY,
                hint="Those since the robot stood up, in the time they were in; the first one starts at once.",
            )
            self._told = gui.add_html(html.sentence("No pushes yet."))
            self._list = gui.add_folder("In the order of time", visible=False)
            play = gui.add_button("Play the sequence", icon=viser.Icon.PLAYER_PLAY)
            clear = gui.add_button("Clear the sequence", color="gray", icon=viser.Icon.TRASH)
        add.on_click(lambda _: self._attempt(self._add))
        take.on_click(lambda _: self._attempt(self._take))
        play.on_click(lambda _: self._attempt(self._play))
        clear.on_click(lambda _: self._show(()))

    def _attempt(self, act: Callable[[], None]) -> None:
        try:
            act()
        except InputError as error:
            self._tell(str(error))

    def _add(self) -> None:
        push = msgspec.structs.replace(self._panel.push(), start=float(self._start.value))
        if len(self.sequence) >= MOST_PUSHES:
            raise InputError("sequence", f"{MOST_PUSHES + 1} pushes", f"at most {MOST_PUSHES}")
        self._show((*self.sequence, push))
        self._start.value = min(round(push.start + push.duration + _GAP, 2), _LATEST)

    def _take(self) -> None:
        pushes = self._of_run()
        if not pushes:
            raise InputError("sequence", "a run without pushes", "a run in which the robot has been pushed")
        first = min(push.start for push in pushes)
        moved = [msgspec.structs.replace(push, start=round(push.start - first, 6)) for push in pushes]
        self._show(tuple(moved)[:MOST_PUSHES])
        if len(moved) > MOST_PUSHES:
            self._tell(
                f"The first {MOST_PUSHES} of the {len(moved)} pushes of this run: a sequence has no more."
            )

    def _play(self) -> None:
        if not self.sequence:
            raise InputError("sequence", "no pushes", "at least one: add the push above")
        self._post(ApplyPushes(self.sequence))

    def _change(self, push: Push) -> None:
        """Take a push out of the sequence and back to the widgets that describe it."""
        self._panel.show(push)
        self._start.value = min(push.start, _LATEST)
        kept = list(self.sequence)
        kept.remove(push)
        self._show(tuple(kept))

    def _show(self, sequence: tuple[Push, ...]) -> None:
        self.sequence = tuple(sorted(sequence, key=lambda push: push.start))
        for item in self._items:
            item.remove()
        self._items = [self._item(push) for push in self.sequence]
        self._list.visible = bool(self.sequence)
        self._told.content = html.sentence(
            "Press a push to change it: it goes back to the sliders." if self.sequence else "No pushes yet."
        )

    def _item(self, push: Push) -> Any:
        with self._list:
            item = self._gui.add_button(in_words(push), color="gray", icon=viser.Icon.PENCIL)
        item.on_click(lambda _: self._change(push))
        return item


def in_words(push: Push) -> str:
    """When, how hard, how long, and where to."""
    where = "" if push.body is None else f", {push.body.replace('_', ' ')}"
    return (
        f"{push.start:.2f} s: {push.force or 0.0:.0f} N, {1e3 * push.duration:.0f} ms, {push.towards}{where}"
    )
