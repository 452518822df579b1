"""Gains of one controller: presets, sliders from their declarations, what has changed since."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import viser

from momentum_lab.app import html, look_html
from momentum_lab.app.gain_notes import GainNotes
from momentum_lab.app.response_sliders import ResponseSliders
from momentum_lab.app.widgets import Bound, Post, nice_step
from momentum_lab.app.wire import Truth
from momentum_lab.control.gains import GainInfo, declared_gains
from momentum_lab.control.presets import STANDARD, presets, save_preset
from momentum_lab.control.registry import CONTROLLERS
from momentum_lab.errors import InputError
from momentum_lab.events import SetGain, SetGains


class TuningPanel:
    """The widgets for the gains of one controller.

    Args:
        gui: where they go.
        post: where events go.
        tell: shows a person what was wrong.
        truth: what is the case at the start.
    """

    def __init__(self, gui: viser.GuiApi, post: Post, tell: Callable[[str], None], truth: Truth) -> None:
        self.controller = truth.controller
        self._post, self._tell = post, tell
        self._declared = declared_gains(CONTROLLERS[truth.controller].gains)
        self._presets = {name: p.values(truth.controller) for name, p in presets(truth.controller).items()}
        self._base = STANDARD
        self._values = dict(truth.gains)
        self._preset: Any = gui.add_dropdown(
            "preset", tuple(self._presets), initial_value=STANDARD, hint="Sets all gains of this controller."
        )
        self._folder = gui.add_folder("Gains", expand_by_default=False)
        with self._folder:
            gui.add_html(look_html.WIDE)
            self._response = ResponseSliders(gui, post, truth.gains)
            self._sliders = self._add_sliders(gui, truth)
        self._changed = gui.add_html("")
        self._resets = {name: self._reset_button(gui, name) for name in self._declared}
        self._reset = gui.add_button("Reset the gains", color="gray", icon=viser.Icon.RESTORE)
        self._keeping = gui.add_folder("Keep these gains", expand_by_default=False)
        with self._keeping:
            self._name = gui.add_text("name", "", hint="Small letters, digits and hyphens.")
            keep = gui.add_button("Save as a preset", color="gray", icon=viser.Icon.DEVICE_FLOPPY)
        self._texts: dict[str, str] = {}
        self._preset.on_update(self._choose)
        self._reset.on_click(lambda _: self._set(self._presets[self._base]))
        keep.on_click(lambda _: self._keep())
        self._tell_changes()

    def _add_sliders(self, gui: viser.GuiApi, truth: Truth) -> dict[str, Bound[float]]:
        notes, sliders = GainNotes(gui), {}
        for name, gain in self._declared.items():
            sliders[name] = Bound[float](gain_slider(gui, gain, truth.gains[name]), _setter(name), self._post)
            notes.add(note(gain))
        return sliders

    def follow(self, truth: Truth) -> None:
        """Show what is the case."""
        for name, slider in self._sliders.items():
            slider.follow(truth.gains[name])
        self._response.follow(truth.gains)
        if truth.gains == self._values:
            return
        self._values = dict(truth.gains)
        if self._values != self._presets[self._base]:
            self._rest_on(next((n for n, v in self._presets.items() if v == self._values), self._base))
        self._tell_changes()

    def remove(self) -> None:
        """Leave the tab."""
        for handle in (
            self._preset,
            self._folder,
            self._changed,
            *self._resets.values(),
            self._reset,
            self._keeping,
        ):
            handle.remove()

    def _tell_changes(self) -> None:
        """Mark the gains that differ from the preset, and offer to take each of them back."""
        before = self._presets[self._base]
        changed = {name for name in self._declared if self._values[name] != before[name]}
        for name, gain in self._declared.items():
            self._label(name, ("● " if name in changed else "") + label(gain))
            button = self._resets[name]
            if name in changed:
                button.label = change(gain, before[name], self._values[name])
            if button.visible != (name in changed):
                button.visible = name in changed
        content = html.sentence(_heading(self._base, bool(changed)))
        if content != self._texts.get(""):
            self._texts[""] = self._changed.content = content

    def _label(self, name: str, text: str) -> None:
        if self._texts.setdefault(name, label(self._declared[name])) != text:
            self._texts[name] = self._sliders[name].handle.label = text

    def _reset_button(self, gui: viser.GuiApi, name: str) -> Any:
        button = gui.add_button(
            f"{name} as before",
            visible=False,
            color="gray",
            icon=viser.Icon.RESTORE,
            hint="Takes this change back.",
        )
        button.on_click(lambda _: self._post(SetGain(name, self._presets[self._base][name])))
        return button

    def _choose(self, event: Any) -> None:
        name = self._preset.value
        if event.client is None or name not in self._presets:
            return  # it was `_rest_on`, or no browser
        self._base = name
        self._set(self._presets[name])
        self._tell_changes()

    def _rest_on(self, base: str) -> None:
        if base != self._base:
            self._base = base
            self._preset.value = base

    def _set(self, values: dict[str, float]) -> None:
        changed = {name: value for name, value in values.items() if self._values.get(name) != value}
        if changed:
            self._post(SetGains(changed))

    def _keep(self) -> None:
        try:
            path = save_preset(self._name.value.strip(), self.controller, self._values)
        except InputError as error:
            self._tell(str(error))
            return
        self._presets[path.stem] = dict(self._values)
        self._preset.options = tuple(self._presets)
        self._rest_on(path.stem)
        self._tell_changes()


def changed_gains(
    declared: Iterable[GainInfo], values: dict[str, float], before: dict[str, float] | None = None
) -> list[str]:
    """Gains that differ from what they were, in words: name, before, now, unit.

    Args:
        declared: the gains.
        values: what they are now, by name.
        before: what they were; None: their defaults.
    """
    were = {gain.name: gain.default for gain in declared} if before is None else before
    return [
        change(gain, were[gain.name], values[gain.name])
        for gain in declared
        if values[gain.name] != were[gain.name]
    ]


def change(gain: GainInfo, before: float, now: float) -> str:
    """One change in words."""
    return f"{words(gain)}: {before:g} → {now:g} {unit(gain)}".strip()


def label(gain: GainInfo) -> str:
    """What a slider is called: name and unit."""
    return f"{words(gain)} ({unit(gain)})" if unit(gain) else words(gain)


def words(gain: GainInfo) -> str:
    """The name of a gain in words."""
    return gain.name.replace("_", " ")


def unit(gain: GainInfo) -> str:
    """Its unit as it is written on the screen; empty for a ratio."""
    return "" if gain.unit == "1" else gain.unit.replace("^2", "²").replace("^3", "³")


def _heading(base: str, changed: bool) -> str:
    if changed:
        return f"Changed since {base}; press a line to take it back:"
    return "All gains are at their defaults." if base == STANDARD else f"All gains are those of {base}."


def gain_slider(gui: viser.GuiApi, gain: GainInfo, value: float) -> Any:
    """A slider as a gain declares it."""
    return gui.add_slider(
        label(gain),
        gain.low,
        gain.high,
        nice_step(gain.low, gain.high, gain.default),
        value,
        hint=note(gain),
    )


def note(gain: GainInfo) -> str:
    """What a gain does and its default; its range stands at the ends of its slider."""
    return f"{gain.help} Default {gain.default:g} {unit(gain) or '(no unit)'}."


def _setter(name: str) -> Callable[[float], SetGain]:
    return lambda value: SetGain(name, value)
