"""Where status and time stand: a bar below the picture, or above the tabs where the page has no room for one."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

import viser

from momentum_lab.app.page_plan import LEAST_BAR

# Around the bar, pixels.
_GAP = 8.0
# By how much the width of the picture may change before the bar follows, pixels.
_SAME = 2.0
_CELLS = ("status", "time", "words", "buttons", "speed", "strip", "look")


def cell(name: str) -> str:
    """What stands before a widget and puts it into its place in a bar; it is nothing where there is no bar.

    Args:
        name: of the place.
    """
    return f'<span class="lab-cell lab-{name}"></span>'


# All widgets of a panel are children of one box; the mark of a bar among them makes it a grid. Where nothing else is
# said a widget stands in the place of the sentence: the two buttons that come and go are never there with it.
_GRID = "div:has(>div>.lab-bar)"
_UNSEEN = "position:absolute;width:1px!important;height:1px;overflow:hidden;clip-path:inset(50%)"
_STYLE = (
    "<style>div:has(>.lab-cell){display:none}"
    f"{_GRID}{{display:grid;align-items:center;grid-template-columns:1fr 1fr;padding:0 .2em;"
    "grid-template-areas:'status time' 'status words' 'buttons speed' 'strip strip' 'look look'}"
    f"{_GRID}>*{{grid-area:words;min-width:0;padding-bottom:.25em}}"
    + "".join(f"{_GRID}>div:has(>.lab-{name})+*{{grid-area:{name}}}" for name in _CELLS)
    # "Pause" and "1/2" say by themselves what they are for; a screen reader still reads the labels.
    + "".join(
        f"{_GRID}>div:has(>.lab-{name})+*>div>div:has(label){{{_UNSEEN}}}" for name in ("buttons", "speed")
    )
    # What is said of two robots is long, and a bar that grows would cover their feet.
    + f"{_GRID} [data-status] span{{font-size:1.05em!important;line-height:1.25}}"
    # Nobody needs a tab to choose the only one.
    + "[data-floating-window]:has(.lab-bar) [data-dock-strip]{display:none!important}</style>"
)


@contextlib.contextmanager
def time_bar(client: viser.ClientHandle, picture: float) -> Iterator[None]:
    """A bar along the lower edge of the picture, for the widgets that are added meanwhile; it stays as wide as that.

    Args:
        client: the browser tab.
        picture: width of the picture, pixels.
    """
    panel = client.gui.add_panel()
    with panel.add_tab("Time", viser.Icon.CLOCK):
        client.gui.add_html(f'<span class="lab-cell lab-bar"></span>{_STYLE}')
        yield
    panel.float(x=_GAP, y=-_GAP, width=picture - 2.0 * _GAP)
    shown = picture

    def fit(camera: viser.CameraHandle) -> None:
        nonlocal shown
        if abs(camera.image_width - shown) > _SAME:
            shown = float(camera.image_width)
            panel.set_width(max(shown, LEAST_BAR) - 2.0 * _GAP)

    client.camera.on_update(fit)
