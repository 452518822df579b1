"""HTML of the share tab: fields that can be copied, and the script that reads a code out of the page's address."""

from __future__ import annotations

from html import escape

_FIELD = (
    "flex:1;min-width:0;font:.85em monospace;padding:.35em;border:1px solid #ccc;border-radius:.25em;"
    "color:inherit;background:transparent"
)
_BUTTON = "padding:.2em .7em;border:1px solid #aaa;border-radius:.25em;cursor:pointer;background:transparent"
_COPY = (
    "const f=this.previousElementSibling;{before}f.select();document.execCommand('copy');"
    "this.textContent='copied';setTimeout(()=>this.textContent='copy',1500)"
)
# Whoever reached the lab by another name than the server knows gets an address that is good for others there.
_HERE = "f.value=location.origin+location.pathname+'?run='+f.dataset.code;"

HIDDEN_NEXT = '<span class="lab-address"></span><style>div:has(>.lab-address)+*{display:none}</style>'
"""Hides the text that follows: a page puts the code of its address there."""

# The text is React's: it takes notice of a value only through the element's own setter and an input event.
_READ = (
    "(()=>{const code=new URLSearchParams(location.search).get('run');if(!code)return;let left=100;"
    "const look=setInterval(()=>{const i=document.querySelector('div:has(>.lab-address)+* input');"
    "if(!i){if(!--left)clearInterval(look);return}clearInterval(look);"
    "Object.getOwnPropertyDescriptor(HTMLInputElement.prototype,'value').set.call(i,code);"
    "i.dispatchEvent(new Event('input',{bubbles:true}))},100)})()"
)
READ_ADDRESS = f'<img alt="" src="data:," style="display:none" onerror="{escape(_READ)}">'
"""Once in a page: opens the code that its address carries."""


def code(code: str, address: str) -> str:
    """A code and its address, each in a field with a button that copies it."""
    return (
        '<div class="lab">'
        + _line("code", code, code, "")
        + _line("address", address, code, _HERE)
        + f'<div class="dim small">{len(code)} letters</div></div>'
    )


def _line(name: str, text: str, code: str, before: str) -> str:
    return (
        '<div style="display:flex;gap:.4em;align-items:center;margin-bottom:.3em">'
        f'<span style="width:4.2em">{name}</span>'
        f'<input readonly aria-label="{name} to copy" data-code="{escape(code)}" value="{escape(text)}" '
        f'style="{_FIELD}" onclick="this.select()">'
        f'<button style="{_BUTTON}" onclick="{escape(_COPY.format(before=before))}">copy</button></div>'
    )
