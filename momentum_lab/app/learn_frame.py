"""What stands around a step of a lesson: title and question above, the ways on and back below, a page between."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from typing import Any

import viser

from momentum_lab.app import learn_html
from momentum_lab.app.learn_style import WAY
from momentum_lab.app.walk import Walk
from momentum_lab.palette import BLUE

_BACK, _LEAVE = "Back  (U)", "Leave the lesson"
_NEXT, _SKIP, _FINISH = "Next  (I)", "Skip  (I)", "Finish  (I)"


class LearnFrame:
    """The frame stays where it is, so that a key that is pressed again finds the same button.

    Args:
        client: the browser tab.
        tab: where everything goes.
        forward: what leads to the next step.
        back: what leads to the step before.
        leave: what leads out of the lesson.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        tab: Any,
        forward: Callable[[], None],
        back: Callable[[], None],
        leave: Callable[[], None],
    ) -> None:
        self._client, self._gui, self._tab = client, client.gui, tab
        self._body: viser.GuiFormHandle | None = None
        with tab:
            self._heading = self._gui.add_html("", order=1.0, visible=False)
            self._way = self._gui.add_html(WAY, order=4.0, visible=False)
            self._forward = self._gui.add_button(_NEXT, color=BLUE, order=4.5, visible=False)
            self._others = self._gui.add_button_group(" ", (_BACK, _LEAVE), order=5.0, visible=False)
        self._forward.on_click(lambda _: forward())
        self._others.on_click(lambda event: back() if event.target.value == _BACK else leave())
        self._go_on, self._go_back = forward, back

    def listen(self) -> None:
        """Give the buttons their keys."""
        self._gui.add_command("Next step of the lesson", hotkey="I").on_trigger(lambda _: self._go_on())
        self._gui.add_command("Previous step of the lesson", hotkey="U").on_trigger(lambda _: self._go_back())

    def head(self, walk: Walk) -> None:
        """Title, question and place of the step that is open."""
        record = walk.record
        self._heading.content = learn_html.heading(
            record.number, record.title, record.question, walk.place, len(record.steps)
        )

    def show(self, walk: Walk | None) -> None:
        """Show what is around a step, with the buttons that make sense; nothing without a lesson."""
        for handle in (self._heading, self._way, self._forward, self._others):
            handle.visible = walk is not None
        if walk is not None:
            self._forward.label, self._forward.disabled = _way_on(walk), walk.waits
            others = (_BACK, _LEAVE) if walk.place else (_LEAVE,)
            if others != self._others.options:
                self._others.options = others

    @contextlib.contextmanager
    def fresh(self) -> Iterator[None]:
        """An empty page instead of the one before."""
        with self._client.atomic():
            if self._body is not None:
                self._body.remove()
            with self._tab:
                self._body = self._gui.add_form(None, order=3.0)
            with self._body:
                yield

    @property
    def page(self) -> Any:
        """Where widgets of the page go that come later."""
        return self._body or self._tab


def _way_on(walk: Walk) -> str:
    """What the button says that leads to the next step."""
    if walk.waits:
        return "Predict first"
    if walk.step.kind == "play" and not walk.all_seen:
        return _SKIP
    return _FINISH if walk.last else _NEXT
