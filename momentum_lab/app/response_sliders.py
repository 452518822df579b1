"""Two sliders in place of two gains: how the CoM comes back, as damping ratio and natural frequency."""

from __future__ import annotations

import viser

from momentum_lab.app import html
from momentum_lab.app.widgets import Bound, Post
from momentum_lab.control.second_order import PAIRS, damping_ratio, gains_for, natural_frequency
from momentum_lab.events import SetGains

_RATIOS, _FREQUENCIES = (0.0, 3.0), (0.5, 10.0)


class ResponseSliders:
    """Damping ratio and natural frequency of the CoM, for controllers whose law has both gains.

    Args:
        gui: where they go.
        post: where events go.
        gains: all gains of the controller, by name.
    """

    def __init__(self, gui: viser.GuiApi, post: Post, gains: dict[str, float]) -> None:
        self._gains = dict(gains)
        self._pair = next((pair for pair in PAIRS if pair[0] in gains and pair[1] in gains), None)
        if self._pair is None:
            return
        damping, stiffness = (name.replace("_", " ") for name in self._pair)
        ratio, frequency = self._response()
        self._ratio: Bound[float] = Bound(
            gui.add_slider(
                "damping ratio ζ",
                *_RATIOS,
                0.01,
                ratio,
                hint="ζ = d/(2√k) (no unit). Below 1 the CoM overshoots, above 1 it creeps back. "
                f"Sets the {damping} d.",
            ),
            lambda value: self._event(value, self._response()[1]),
            post,
        )
        self._frequency: Bound[float] = Bound(
            gui.add_slider(
                "frequency ω (1/s)",
                *_FREQUENCIES,
                0.05,
                frequency,
                hint=f"ω = √k: how fast the CoM comes back. Sets the {stiffness} k, and d so that ζ stays.",
            ),
            lambda value: self._event(self._response()[0], value),
            post,
        )
        gui.add_html(html.sentence(f"They are the {damping} and the {stiffness} below in other words."))

    def follow(self, gains: dict[str, float]) -> None:
        """Show what is the case."""
        self._gains = dict(gains)
        if self._pair is not None:
            ratio, frequency = self._response()
            self._ratio.follow(ratio)
            self._frequency.follow(frequency)

    def _event(self, ratio: float, frequency: float) -> SetGains:
        assert self._pair is not None
        damping, stiffness = gains_for(ratio, frequency)
        return SetGains({self._pair[0]: damping, self._pair[1]: stiffness})

    def _response(self) -> tuple[float, float]:
        """Damping ratio and natural frequency of the gains, within the ends of the sliders."""
        assert self._pair is not None
        damping, stiffness = (self._gains[name] for name in self._pair)
        return _within(damping_ratio(damping, stiffness), _RATIOS), _within(
            natural_frequency(stiffness), _FREQUENCIES
        )


def _within(value: float, ends: tuple[float, float]) -> float:
    return min(max(value, ends[0]), ends[1])
