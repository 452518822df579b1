"""The runs tab: two robots side by side, a run that is kept for comparison, and what differs."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from html import escape
from typing import Any

import msgspec
import viser

from momentum_lab.app import html
from momentum_lab.app.differences import LAY_THERE
from momentum_lab.app.story import Facts
from momentum_lab.app.widgets import Bound, Post
from momentum_lab.app.wire import Truth
from momentum_lab.beside import Beside
from momentum_lab.choice_words import NOTHING
from momentum_lab.control.registry import CONTROLLERS
from momentum_lab.events import RunAgain, SetBeside
from momentum_lab.palette import BLUE, VERMILLION

AS_FIRST = "as the first"
# How often the table changes on the screen, s.
_PERIOD = 0.3
_COUNTED = "seconds count from the latest push before"
_KEEP, _AGAIN = "Keep this run as A  (M)", "Same pushes again  (N)"


class RunsPanel:
    """The widgets of the runs tab.

    Args:
        gui: where they go.
        post: where events go.
        redraw: asks for a new picture.
        truth: what is the case at the start.

    Attributes:
        wants_kept: whether the run of now is to be kept at the next drawing.
        wants_forgotten: whether the kept run is to be forgotten then.
        shows_ghost: whether the kept run is drawn.
    """

    def __init__(self, gui: viser.GuiApi, post: Post, redraw: Callable[[], None], truth: Truth) -> None:
        self._post, self._redraw = post, redraw
        self._truth = truth
        self.wants_kept = self.wants_forgotten = False
        self._has_kept = False
        self._next, self._text = -math.inf, ""
        gui.add_html(html.sentence("Two robots, pushed alike; the curves of the second one are thin:"))
        self._second: Bound[bool] = Bound(
            gui.add_checkbox("a second robot", truth.beside is not None), self._with_second, post
        )
        self._priority: Bound[float] = Bound(
            gui.add_slider("its priority", 0.0, 1.0, 0.01, 1.0, disabled=True, hint="From 0 to 1 (no unit)."),
            self._with_priority,
            post,
        )
        self._controller: Bound[str] = Bound(
            gui.add_dropdown("its controller", (AS_FIRST, *CONTROLLERS), disabled=True),
            self._with_controller,
            post,
        )
        self._gains: Bound[bool] = Bound(
            gui.add_checkbox(
                "it keeps its gains",
                False,
                disabled=True,
                hint="The gains of now stay with the second robot; the sliders move those of the first only.",
            ),
            self._with_gains,
            post,
        )
        gui.add_html(
            html.sentence(
                "Keep a run, change something, push again: the kept run goes along as a ghost, its curves dashed."
            )
        )
        keep = gui.add_button(_KEEP, color=BLUE, icon=viser.Icon.PIN)
        again = gui.add_button(_AGAIN, color=VERMILLION, icon=viser.Icon.REPEAT)
        self._ghost: Any = gui.add_checkbox("show A  (G)", True, disabled=True)
        self._forget = gui.add_button("Forget A", color="gray", icon=viser.Icon.PINNED_OFF, visible=False)
        self._table = gui.add_html("")
        keep.on_click(lambda _: self.keep())
        again.on_click(lambda _: self.run_again())
        self._ghost.on_update(lambda _: redraw())
        self._forget.on_click(lambda _: self._forget_kept())

    @property
    def shows_ghost(self) -> bool:
        """Whether the kept run is drawn."""
        return bool(self._ghost.value)

    def keep(self) -> None:
        """Keep the run of now."""
        self.wants_kept = True
        self._redraw()

    def run_again(self) -> None:
        """Push the robot again as before; the run of now is kept if none has been."""
        self.wants_kept = self.wants_kept or not self._has_kept
        self._post(RunAgain())

    def toggle_ghost(self) -> None:
        """Show the ghost, or hide it."""
        self._ghost.value = not self._ghost.value
        self._redraw()

    def follow(self, truth: Truth, has_kept: bool) -> None:
        """Show what is the case."""
        self._truth = truth
        beside = truth.beside
        self._second.follow(beside is not None)
        for widget in (self._priority, self._controller, self._gains):
            if widget.handle.disabled != (beside is None):
                widget.handle.disabled = beside is None
        if beside is not None:
            self._priority.follow(truth.priority if beside.priority is None else beside.priority)
            self._controller.follow(beside.controller or AS_FIRST)
            self._gains.follow(bool(beside.gains))
        if has_kept != self._has_kept:
            self._has_kept = has_kept
            self._ghost.disabled, self._forget.visible = not has_kept, has_kept

    def is_time(self) -> bool:
        """Whether the table may change again."""
        if time.monotonic() < self._next:
            return False
        self._next = time.monotonic() + _PERIOD
        return True

    def compare(self, columns: list[tuple[str, Facts]], settings: dict[str, tuple[str, ...]]) -> None:
        """Show runs side by side.

        Args:
            columns: what each run is called, and what it amounts to; fewer than two: nothing is shown.
            settings: what was chosen differently, one value per run.
        """
        text = table(columns, settings) if len(columns) > 1 else ""
        if text != self._text:
            self._text = self._table.content = text

    def _forget_kept(self) -> None:
        self.wants_forgotten = True
        self._redraw()

    def _with_second(self, on: bool) -> SetBeside:
        return SetBeside(Beside(priority=1.0 if self._truth.priority < 0.5 else 0.0) if on else None)

    def _with_priority(self, value: float) -> SetBeside:
        return self._changed(priority=value)

    def _with_controller(self, name: str) -> SetBeside:
        return self._changed(controller=None if name == AS_FIRST else name, gains={})

    def _with_gains(self, on: bool) -> SetBeside:
        return self._changed(gains=self._truth.gains if on else {})

    def _changed(self, **changes: Any) -> SetBeside:
        beside = self._truth.beside
        return SetBeside(None if beside is None else msgspec.structs.replace(beside, **changes))


def table(columns: list[tuple[str, Facts]], settings: dict[str, tuple[str, ...]]) -> str:
    """Runs side by side: what came out, then what was chosen differently.

    Args:
        columns: what each run is called, and what it amounts to.
        settings: what was chosen differently, one value per run.
    """
    facts = [each for _, each in columns]
    rows = [
        ("result", tuple(_result(each) for each in facts)),
        ("CoM moved at most", tuple(f"{1e3 * each.excursion:.0f} mm" for each in facts)),
        ("angular momentum at most", tuple(f"{each.angular_momentum:.1f} kg m²/s" for each in facts)),
        ("at rest after", tuple(_seconds(each.settled_after) for each in facts)),
        ("smallest CoP margin", tuple(_millimetres(each.margin) for each in facts)),
    ]
    head = "".join(f'<th style="text-align:left">{escape(name)}</th>' for name, _ in columns)
    body = "".join(_row(name, values) for name, values in rows)
    chosen = "".join(_row(name, values) for name, values in settings.items())
    different = chosen or _row("nothing was chosen differently", ())
    whole = f'<tr><td colspan="{len(columns) + 1}" class="dim"'
    return (
        '<div class="lab small n" data-runs="1"><table style="border-collapse:collapse;width:100%">'
        f"<tr><th></th>{head}</tr>{body}{whole}>{_COUNTED}</td></tr>"
        f'{whole} style="padding-top:.4em">what differs</td></tr>'
        f"{different}</table></div>"
    )


def _row(name: str, values: tuple[str, ...]) -> str:
    cells = "".join(f'<td style="padding-left:.4em">{escape(value)}</td>' for value in values)
    return f'<tr style="border-top:1px solid #ddd"><td class="dim">{escape(name)}</td>{cells}</tr>'


def _result(facts: Facts) -> str:
    if facts.lay_there:
        return LAY_THERE
    return "stands" if facts.fall_time is None else f"fell after {facts.fall_time:.2f} s"


def _seconds(value: float | None) -> str:
    return NOTHING if value is None else f"{value:.2f} s"


def _millimetres(value: float | None) -> str:
    return NOTHING if value is None else f"{round(1e3 * value)} mm"
