"""What is typed arrives before what is pressed after it; what is typed into a box is none of the lab's keys.

Viser tells of a change at most every 50 ms, and only of the last one: a button that is pressed right after a number
has been typed would take its place. Enter leaves a box of a number, so that the next letter is a key again.
"""

from __future__ import annotations

from html import escape

# How long after a change a press is held back, ms: longer than viser waits with a change.
_HELD = 80

_TYPED = (
    "(()=>{if(window.labTyped)return;window.labTyped=true;"
    "const box='input[inputmode=numeric],input[inputmode=decimal]';"
    "let told=-1e9,again=false;const note=()=>{told=performance.now()};"
    f"const left=()=>Math.max(0,told+{_HELD}-performance.now());"
    "const on=(type,act)=>window.addEventListener(type,act,true);"
    "on('input',note);"
    # Who leaves a box brings its number into range.
    "on('focusout',e=>{if(e.target.matches?.(box))note()});"
    "const stop=e=>{e.preventDefault();e.stopImmediatePropagation()};"
    "const hold=(e,act)=>{if(again||!left())return;stop(e);"
    "setTimeout(()=>{again=true;try{act()}finally{again=false}},left())};"
    "on('click',e=>{const b=e.target.closest?.('.mantine-Button-root');if(b)hold(e,()=>b.click())});"
    "on('submit',e=>hold(e,()=>e.target.requestSubmit()));"
    # W, A, S, D, Q and E move the camera for as long as they are down, and are none of the lab's keys.
    "on('keydown',e=>{if(e.target.matches?.('[role=slider]'))note();"
    "if(e.key==='Enter'&&e.target.matches?.(box))e.target.blur();"
    "if(!e.isTrusted||e.ctrlKey||e.metaKey||e.altKey||!/^[a-z]$/i.test(e.key)||/^[wasdqe]$/i.test(e.key))return;"
    "if(!left()||e.target.matches?.('input,textarea,select'))return;"
    "const key={key:e.key,code:e.code,shiftKey:e.shiftKey,bubbles:true};stop(e);"
    "setTimeout(()=>document.body.dispatchEvent(new KeyboardEvent('keydown',key)),left())})"
    "})()"
)
TYPED = f'<img alt="" src="data:," style="display:none" onerror="{escape(_TYPED)}">'
"""Once in a page: keeps the order of what is typed and what is pressed."""
