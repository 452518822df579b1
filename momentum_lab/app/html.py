"""Small pieces of HTML for the panels. Viser shows HTML as it is, so every text is escaped here."""

from __future__ import annotations

import re
from collections.abc import Iterable
from html import escape

from momentum_lab.app.marks import STYLES, MarkStyle
from momentum_lab.app.steady import blanks, steady
from momentum_lab.app.viser_page import DARK_PAGE, PHONE, SHEET

# On a dark page the style sheet below gives these names lighter colours.
COLORS = {
    "green": "var(--lab-green,#007a59)",
    "orange": "var(--lab-orange,#b35c00)",
    "vermillion": "var(--lab-vermillion,#c43d00)",
    "black": "var(--lab-black,#222222)",
}
_SIGNS = {"standing": "●", "border": "▲", "lifted": "▲", "solver": "■", "fallen": "✖", "stopped": "■"}

# The browser's own tab gets the lab's name; viser has no setting for it.
TITLE = (
    '<img alt="" src="data:," style="display:none" onerror="document.title=\'Momentum lab\'">'
    # Playing controls and the big button are what a hand looks for first.
    "<style>div:has(>.lab-big)+* button{height:3.1em!important;font-size:1.15em!important}"
    ".lab{padding:0 .75em .5em .75em;font-size:.875em;line-height:1.4}"
    ".lab b{font-weight:600}.lab .n,.lab.n{font-variant-numeric:tabular-nums}"
    ".lab.small{padding:.3em .75em .1em .75em;font-size:.78em;line-height:1.3}"
    ".lab .dim{color:#6b6b6b}"
    f"{DARK_PAGE}{{--lab-green:#3cc79a;--lab-orange:#f0a544;--lab-vermillion:#ff8a5b;"
    "--lab-black:#e6e6e6}"
    f"{DARK_PAGE} .lab .dim{{color:#a6a6a6}}"
    f'{DARK_PAGE} .lab svg [fill="#000000"]{{fill:#fff}}'
    f'{DARK_PAGE} .lab svg [stroke="#000000"]{{stroke:#fff}}'
    # Viser's sheet on a phone is as wide as 20 letters and leaves the rest of the row empty.
    f"{PHONE}{{{SHEET}{{width:100vw!important}}}}</style>"
)
# A whole number of N or N m, and a place for three of its figures: the usual losses.
_SIZE = re.compile(r"\b(\d+)(?= N\b)")
_THREE_FIGURES = "display:inline-block;min-width:3ch;text-align:right"
_DASHED = ' stroke-dasharray="4 2.5"'
BIG_NEXT = '<span class="lab-big"></span>'


def status_line(kind: str, words: str, color: str) -> str:
    """The status: a sign, a colour and words."""
    css = COLORS[color]
    return (
        f'<div class="lab" data-status="{escape(kind)}" style="padding-top:.5em">'
        f'<div style="border-left:.35em solid {css};padding:.1em 0 .1em .6em;min-height:3.6em;'
        'display:flex;align-items:center">'
        f'<span style="font-size:1.25em;font-weight:600;color:{css}" class="n">'
        f"{_SIGNS[kind]} {steady_sizes(escape(words))}</span>"
        "</div></div>"
    )


def steady_sizes(words: str) -> str:
    """Escaped words with room for three figures before every N and N m, so that those behind do not jump."""
    return _SIZE.sub(rf'<span style="{_THREE_FIGURES}">\1</span>', words)


def time_line(
    time: float,
    real_time_factor: float,
    speed: float,
    playing: bool,
    failures: int = 0,
    behind: float = 0.0,
) -> str:
    """Simulated time and how it runs, in figures that do not change their width."""
    asked = "" if speed == 1.0 else f" · speed {speed:g}"
    pace = f"{steady(real_time_factor, 2, 1)} × real time" if playing else "paused"
    if behind:
        pace = f"{steady(behind, 2, 2)} s before the end"
    clock = f"{blanks(time, 2, 3)}<b>{time:.2f} s</b>"
    # The longer line has to fit where the shorter one does: what is around it keeps its place.
    small = " small" if behind else ""
    told = f"simulated time {clock} · {pace}{asked}{_failures(failures)}"
    return f'<div class="lab{small} n dim" data-time="{time:.3f}">{told}</div>'


def _failures(count: int) -> str:
    words = f"solver failed {count} ×"
    return f' · <b style="color:{COLORS["vermillion"]}">{words}</b>' if count else ""


def slider_ends(low: str, high: str) -> str:
    """Words at the ends of the slider above."""
    return (
        '<div class="lab dim" style="display:flex;justify-content:space-between;'
        f'padding:0 4.6em .4em 8.2em;margin-top:-.3em;font-size:.8em"><span>◂ {escape(low)}</span>'
        f"<span>{escape(high)} ▸</span></div>"
    )


def sentence(words: str) -> str:
    """A sentence in a panel."""
    return f'<div class="lab">{escape(words)}</div>'


def changes(lines: Iterable[str]) -> str:
    """What differs from the scenario, one line each."""
    found = "".join(f"<li>{escape(line)}</li>" for line in lines)
    if not found:
        return '<div class="lab dim">Everything is as the scenario has it.</div>'
    return (
        '<div class="lab">Changed against the scenario:'
        f'<ul class="n" style="margin:0;padding-left:1.2em">{found}</ul></div>'
    )


def slacks(values: Iterable[tuple[str, float, str]]) -> str:
    """What has to wait: name, slack and unit of each output, with a bar as long as it is large."""
    lines = "".join(
        f"<tr><td>{escape(name)}</td>"
        f'<td class="n" style="text-align:right;padding:0 .5em">{abs(value):.2f} {unit}</td>'
        f'<td style="width:40%"><div style="width:{_share(value):.0f}%;height:.6em;background:{COLORS["orange"]}">'
        "</div></td></tr>"
        for name, value, unit in values
    )
    return (
        '<div class="lab small"><b>What has to wait</b> <span class="dim">(slack: asked for, not given)</span>'
        f'<table style="width:100%;border-collapse:collapse">{lines}</table></div>'
    )


def _share(value: float) -> float:
    """Length of a bar in percent: half of it for a slack of 1, all of it for a very large one."""
    return round(100.0 * abs(value) / (1.0 + abs(value)))


def legend(keys: Iterable[str], explained: bool) -> str:
    """Symbol and name of some marks, with what they mean if asked for."""
    items = []
    for key in keys:
        style = STYLES[key]
        meaning = f' <span class="dim">{escape(style.help)}</span>' if explained else ""
        name = f"<b>{escape(style.label)}</b>" if explained else escape(style.label)
        items.append(
            f'<span style="display:{"flex" if explained else "inline-flex"};align-items:center;gap:.35em;'
            f'margin:.1em .8em .1em 0">{symbol(style)}<span>{name}{meaning}</span></span>'
        )
    return f'<div class="lab small">{"".join(items)}</div>'


def plot_title(title: str, lines: Iterable[tuple[str, str, bool]]) -> str:
    """Title of a plot and its lines: name, colour, whether dashed; lines without a name are left out."""
    items = "".join(
        f'<span style="white-space:nowrap;margin-right:.8em"><svg width="16" height="8" viewBox="0 -4 16 8">'
        f'<path d="M0 0H16" stroke="{color}" stroke-width="2.2"{_DASHED if dashed else ""}/></svg> '
        f"{escape(name)}</span>"
        for name, color, dashed in lines
        if name
    )
    return f'<div class="lab small"><b>{escape(title)}</b><br>{items}</div>'


def symbol(style: MarkStyle) -> str:
    """The shape of a mark as a small drawing."""
    body = _DRAWINGS[style.shape].replace("COLOR", style.css)
    return f'<svg width="18" height="14" viewBox="-9 -7 18 14" style="flex:none">{body}</svg>'


_DRAWINGS = {
    "ball": '<circle r="5.5" fill="COLOR"/>',
    "ring": '<circle r="4.5" fill="none" stroke="COLOR" stroke-width="2"/>',
    "disc": '<ellipse rx="4" ry="2.5" fill="COLOR"/>',
    "diamond": '<path d="M0-6 5 0 0 6-5 0Z" fill="COLOR"/>',
    "triangle": '<path d="M0-6 6 5H-6Z" fill="COLOR"/>',
    "cross": '<path d="M-5 0H5M0-5V5" stroke="COLOR" stroke-width="3"/>',
    "square": '<rect x="-5" y="-5" width="10" height="10" fill="COLOR"/>',
    "hollow square": '<rect x="-5" y="-5" width="10" height="10" fill="none" stroke="COLOR" stroke-width="2"/>',
    "arrow": '<path d="M0 6V-2" stroke="COLOR" stroke-width="2.5"/><path d="M0-7 4-1H-4Z" fill="COLOR"/>',
    "thin arrow": '<path d="M0 6V-3" stroke="COLOR" stroke-width="1.2"/><path d="M0-7 2.5-2H-2.5Z" fill="COLOR"/>',
    "line": '<path d="M-6 5 6-5" stroke="COLOR" stroke-width="1.5"/>',
    "bar": '<path d="M-8 0H8" stroke="COLOR" stroke-width="5"/>',
    "area": '<path d="M-8 4-5-5H8L6 4Z" fill="COLOR" fill-opacity=".3"/>',
    "dashes": '<path d="M-8 0H8" stroke="COLOR" stroke-width="2" stroke-dasharray="3 2"/>',
}
