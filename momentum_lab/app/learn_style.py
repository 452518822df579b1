"""How the lessons' panel looks: on a light page and a dark one, and on a phone."""

from __future__ import annotations

from momentum_lab.app.html import COLORS
from momentum_lab.app.viser_page import DARK_PAGE, PHONE, SHEET, UNFOLDED

BLUE, GREEN, RED = "#0072b2", COLORS["green"], COLORS["vermillion"]
# On a dark page the style sheet below gives these names lighter colours.
MINE, INK, PALE = "var(--learn-mine,#0072b2)", "var(--learn-ink,#222222)", "var(--learn-pale,#6b6b6b)"
LIST = '<span class="learn-list"></span>'
"""Buttons after it look like a list."""
WAY = '<span class="learn-way"></span>'
"""The button after it stays in sight on a phone."""

_DARK = f"{DARK_PAGE} .learn"
_TEXT = (
    ".learn{padding:.15em .9em .5em .9em;font-size:.95em;line-height:1.45}"
    ".learn h3{font-size:1.05em;margin:.1em 0 .25em 0;font-weight:650}"
    ".learn .q{font-size:1.02em;font-weight:550;color:#0b4f79}.learn .dim{color:#6b6b6b;font-size:.88em}"
    ".learn .o{display:flex;gap:.6em;padding:.32em .5em;margin:.2em 0;border-radius:.35em;"
    "border:1px solid #d5dbe0}.learn .o b{flex:none;width:1em}"
    f".learn .o.mine{{border-color:{BLUE};background:#e8f3fa}}"
    ".learn .bar{height:.3em;background:#e3e7ea;margin:.15em 0 .45em 0}"
    f".learn .bar div{{height:100%;background:{BLUE}}}"
    ".learn .card{border-left:.3em solid;padding:.3em .6em;margin:.4em 0;background:#f6f7f8}"
    ".learn .eq{overflow-x:auto;padding:.5em 0;text-align:center}"
    ".learn math{font-size:1.15em}.learn mtext{font-size:.68em;color:#0b4f79}"
    ".learn td{padding:0 .6em .1em 0;vertical-align:top}.learn .n{font-variant-numeric:tabular-nums}"
    ".learn .err{border:1px solid;border-radius:.35em;padding:.5em .6em;overflow-wrap:anywhere}"
)
# What is chosen from is a list with whole sentences in it, not a row of buttons.
_CHOICES = (
    "div:has(>.learn-list)~* button{height:auto!important;min-height:2.1em;background:#f6f8f9!important;"
    "color:#1f2a33!important;border:1px solid #d5dbe0!important}"
    "div:has(>.learn-list)~* button:disabled{color:#6b6b6b!important}"
    "div:has(>.learn-list)~* button:hover:not(:disabled){border-color:#0072b2!important}"
    "div:has(>.learn-list)~* .mantine-Button-inner{justify-content:flex-start}"
    "div:has(>.learn-list)~* .mantine-Button-label{white-space:normal;text-align:left;height:auto;"
    "overflow:visible;padding:.3em .2em;line-height:1.3;font-weight:450;font-size:1.08em}"
)
_AT_NIGHT = (
    f"{DARK_PAGE}{{--learn-mine:#7cc4f0;--learn-ink:#f0f0f0;--learn-pale:#a6a6a6}}"
    f"{_DARK} .q,{_DARK} mtext{{color:#7cc4f0}}{_DARK} .dim{{color:#a6a6a6}}"
    f"{_DARK} .o{{border-color:#4a5057}}{_DARK} .o.mine{{background:#16384d}}"
    f"{_DARK} .bar{{background:#3a3f45}}{_DARK} .card{{background:#2b2f34}}"
    f"{DARK_PAGE} div:has(>.learn-list)~* button{{background:#2b2f34!important;color:#e4e7ea!important;"
    f"border-color:#4a5057!important}}{DARK_PAGE} div:has(>.learn-list)~* button:disabled"
    "{color:#a6a6a6!important}"
)
STYLE = f"<style>{_TEXT}{_CHOICES}{_AT_NIGHT}</style>"
_PANELS = f"{SHEET}>:last-child"
ON_A_PHONE = (
    f"<style>{PHONE}{{{_PANELS}{{display:flex;flex-direction:column}}"
    f"{_PANELS}>:has({UNFOLDED}){{order:-1}}"
    "div:has(>.learn-way)+div{position:sticky;bottom:0;z-index:2;background:var(--mantine-color-body)}}</style>"
)
"""Once in a page: unfolded, this panel comes first in a phone's one sheet, and the way on stays in sight below."""
