"""Names for a screen reader: viser draws sliders, plots and some buttons without one, so the page adds them."""

from __future__ import annotations

from html import escape

from momentum_lab.app.viser_page import ROW

# Between two looks at a page that keeps changing, ms.
_PERIOD = 500

_NAME = (
    "(()=>{if(window.labNames)return;window.labNames=true;"
    "const set=(e,n,v)=>{if(e&&v&&e.getAttribute(n)!==v)e.setAttribute(n,v)};"
    "const all=(s,f)=>document.querySelectorAll(s).forEach(f);"
    # A slider and the box beside it, which carries the same number, are called by the words before them.
    "const row=l=>{const words=l.textContent.trim(),box=document.getElementById(l.htmlFor);if(!words)return;"
    "if(box){const s=box.querySelector('[role=slider]');set(s,'aria-label',words);"
    "if(s&&s.ariaValueNow!==null)set(s,'aria-valuetext',text(words,s.ariaValueNow));"
    "const i=box.parentElement.querySelector('input:not([type=hidden])');"
    "if(box.tagName==='DIV'&&i)set(i,'aria-label',words+', typed')}"
    f"else{{const g=l.closest('{ROW}')?.lastElementChild;"
    "if(g&&g.querySelector('button')){set(g,'role','group');set(g,'aria-label',words)}}};"
    "const text=(words,now)=>{const u=/\\(([^)]*)\\)\\s*$/.exec(words);"
    "return String(+(+now).toPrecision(6))+(u?' '+u[1]:'')};"
    "const name=()=>{all('label[for]',row);"
    "all('.uplot',u=>{let e=u,t=null;for(let n=0;e&&n<8&&!t;n++,e=e.parentElement)"
    "{t=e.previousElementSibling?.querySelector?.('.lab.small b')}"
    "set(u,'role','img');set(u,'aria-label',t&&'Plot: '+t.textContent)});"
    "all('canvas[data-engine]',c=>{set(c,'role','img');"
    "set(c,'aria-label','The robot and its marks. The status says in words how it is doing.')});"
    "all('[data-status]',s=>set(s.parentElement,'role','status'));"
    "all('.tabler-icon-list-search',i=>set(i.closest('button'),'aria-label','All commands (Ctrl+K)'));"
    "all('.tabler-icon-adjustments',i=>set(i.closest('button'),'aria-label','Settings of the viewer'))};"
    f"name();setInterval(name,{_PERIOD})"
    "})()"
)
NAMES = f'<img alt="" src="data:," style="display:none" onerror="{escape(_NAME)}">'
"""Once in a page: names what has no name of its own, now and whenever something is added."""
