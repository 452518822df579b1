"""Style sheets of the page: names of sliders that can be read, short hints, a bar on phones that can be found."""

from __future__ import annotations

from html import escape

from momentum_lab.app.viser_page import FOLDED, PHONE, ROW, UNFOLDED

WIDE = '<span class="lab-wide"></span>'
"""First in a folder: below it every name stands above its slider, on a line of its own."""

LEVEL = '<span class="lab-level"></span>'
"""First in a form: its widgets stand exactly below those outside of it."""

_ROW = f"{ROW}:has(>div>p>label)"
_LEVEL_NAME = f"form:has(>div>.lab-level)>div>{_ROW}>div:first-child"
_WIDE_ROW = f"div:has(>.lab-wide)~* {_ROW}"

# What a hand has unfolded comes into sight; it lies below everything else.
_UNFOLD = (
    "(()=>{if(window.labUnfolds)return;window.labUnfolds=true;"
    f"const show=left=>{{const open=document.querySelector(`{UNFOLDED}`);open?.scrollIntoView();"
    "const top=open?.closest('[data-scrollarea-viewport]')?.getBoundingClientRect().top;"
    # It grows for a while, and cannot be scrolled to its place before.
    "if(left&&!(open?.getBoundingClientRect().top<top+60))setTimeout(show,200,left-1)};"
    f"const seen=e=>{{if(e.target.closest?.(`{FOLDED}`))setTimeout(show,200,15)}};"
    "window.addEventListener('click',seen,true);window.addEventListener('keydown',seen,true)})()"
)

STYLE = (
    "<style>"
    # Viser draws names pale, their letters so close that they touch, and breaks units after a slash.
    "p>label{letter-spacing:-.2px;color:var(--mantine-color-text)}p>label wbr{display:none}"
    # Viser counts a form as a folder, and gives names in one less room.
    f"{_LEVEL_NAME}{{width:7.25em!important}}"
    f"{_WIDE_ROW}{{flex-wrap:wrap}}{_WIDE_ROW}>div:first-child{{width:100%!important}}"
    f"{_WIDE_ROW}>div:first-child label{{letter-spacing:0}}"
    # A tick stands beside its words.
    f"{_WIDE_ROW}:has(input[type=checkbox]){{flex-wrap:nowrap}}"
    f"{_WIDE_ROW}:has(input[type=checkbox])>div:first-child{{width:auto!important}}"
    # A hint is no wider than its words, and as low as they allow: it covers one row.
    ".mantine-Tooltip-tooltip{width:max-content!important;max-width:19rem;font-size:.78rem;line-height:1.3;"
    "padding:.25em .6em}"
    # On a phone the panel of plots and lessons is folded to a bar: it stays in sight and looks like what it is.
    f"{PHONE}{{"
    f"div:has(>div>{FOLDED}){{position:sticky;bottom:0;z-index:5}}"
    f"{FOLDED}{{min-height:2.9em!important;background:#0072b2;font-weight:600}}"
    f"{FOLDED} *{{color:#fff!important;opacity:1!important}}"
    f"div:has(>{UNFOLDED}){{position:sticky;top:0;z-index:5;background:var(--mantine-color-body)}}"
    "}</style>"
    f'<img alt="" src="data:," style="display:none" onerror="{escape(_UNFOLD)}">'
)
"""Once in a page."""
