"""Keys for what viser leaves to a mouse: folders and bars of panels are reached with Tab, opened with Enter."""

from __future__ import annotations

from html import escape

# Between two looks at a page that keeps changing, ms.
_PERIOD = 500
# The head of a folder is a sheet of paper with a chevron; that of an open panel on a phone says that it is a button.
_HEADS = ".mantine-Paper-root[style*='cursor: pointer'],[role=button]:not([tabindex]):not(button)"

_KEYS = (
    "(()=>{if(window.labKeys)return;window.labKeys=true;"
    "const set=(e,n,v)=>{if(e.getAttribute(n)!==v)e.setAttribute(n,v)};"
    f"const reach=()=>document.querySelectorAll(`{_HEADS},[data-lab-key]`).forEach(e=>{{"
    "set(e,'tabindex','0');set(e,'data-lab-key','');set(e,'role','button');"
    "if(e.classList.contains('mantine-Paper-root'))"
    "set(e,'aria-expanded',String(!!e.querySelector('.tabler-icon-chevron-up')))});"
    "window.addEventListener('keydown',k=>{if((k.key==='Enter'||k.key===' ')&&k.target.dataset?.labKey===''){"
    "k.preventDefault();k.target.click();setTimeout(reach,50)}});"
    f"reach();setInterval(reach,{_PERIOD})"
    "})()"
)
KEYS = f'<img alt="" src="data:," style="display:none" onerror="{escape(_KEYS)}">'
"""Once in a page."""
