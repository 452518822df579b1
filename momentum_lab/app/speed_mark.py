"""Which of the speed buttons is chosen: viser's groups of buttons do not show it, a rule of style does."""

from __future__ import annotations

from collections.abc import Iterable

from momentum_lab.app.time_bar import cell


def speed_cell(speeds: Iterable[float], chosen: float) -> str:
    """What stands before the buttons of these speeds: their place in the bar, and the chosen one filled."""
    rules = (
        f"div:has(>.lab-speed)+* button:nth-of-type({place})"
        "{background:color-mix(in srgb,currentColor 20%,transparent);font-weight:700}"
        for place, speed in enumerate(speeds, start=1)
        if speed == chosen
    )
    return f"{cell('speed')}<style>{''.join(rules)}</style>"


def speed_words(speed: float) -> str:
    """At what speed time runs, as the buttons name it; nothing at that of the world."""
    if speed == 1.0:
        return ""
    inverse = round(1.0 / speed) if speed > 0.0 else 0
    named = f"1/{inverse}" if inverse and speed * inverse == 1.0 else f"{speed:g}"
    return f" · at {named}"
