"""How the simulated robot differs from the one its controller believes in: one slider per declared error."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import viser

from momentum_lab.app import html, look_html
from momentum_lab.app.widgets import Bound, Post
from momentum_lab.app.wire import Truth
from momentum_lab.events import SetMismatch
from momentum_lab.physics.mismatch import EXACT, ModelError, changes, model_errors


class MismatchPanel:
    """The widgets of the model errors.

    Args:
        gui: where they go.
        post: where events go.
        truth: what is the case at the start.
    """

    def __init__(self, gui: viser.GuiApi, post: Post, truth: Truth) -> None:
        self._post, self._mismatch = post, truth.mismatch
        with gui.add_folder("Model errors", expand_by_default=False):
            words = "What the robot is and measures, and its controller is not told:"
            gui.add_html(look_html.WIDE + html.sentence(words))
            self._sliders = {
                error.name: Bound[float](
                    _slider(gui, error, getattr(truth.mismatch, error.name)), _setter(error.name), post
                )
                for error in model_errors().values()
            }
            none = gui.add_button("No model errors", color="gray", icon=viser.Icon.RESTORE)
        none.on_click(lambda _: self._to_defaults())
        # Outside the folder: seen when it is folded away, too.
        self._present = gui.add_html("", visible=False)
        self._text = ""
        self._say(truth)

    def follow(self, truth: Truth) -> None:
        """Show the errors that are the case."""
        self._mismatch = truth.mismatch
        for name, slider in self._sliders.items():
            slider.follow(getattr(truth.mismatch, name))
        self._say(truth)

    def _say(self, truth: Truth) -> None:
        """Which errors there are, in words."""
        declared = model_errors()
        present = [_in_words(declared[name], value) for name, value in changes(EXACT, truth.mismatch)]
        text = html.sentence(f"Model errors: {', '.join(present)}.")
        if text != self._text:
            self._text = self._present.content = text
            self._present.visible = bool(present)

    def _to_defaults(self) -> None:
        for name, value in changes(self._mismatch, EXACT):
            self._post(SetMismatch(name, value))


def _slider(gui: viser.GuiApi, error: ModelError, value: float) -> Any:
    unit, words = _unit(error), _words(error)
    return gui.add_slider(
        f"{words} ({unit})" if unit else words,
        error.low,
        error.high,
        error.step,
        value,
        hint=f"{error.help} Default {error.default:g} {unit or '(no unit)'}.",
    )


def _setter(name: str) -> Callable[[float], SetMismatch]:
    return lambda value: SetMismatch(name, value)


def _words(error: ModelError) -> str:
    return error.name.removesuffix("_ms").replace("_", " ")


def _unit(error: ModelError) -> str:
    return "" if error.unit == "1" else error.unit


def _in_words(error: ModelError, value: float) -> str:
    return f"{_words(error)} {value:g} {_unit(error)}".strip()
