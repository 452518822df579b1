"""The page of help: every key, what there is to see, and what a keyboard or a screen reader can do here."""

from __future__ import annotations

from html import escape

from momentum_lab.app.viser_page import AROUND_DIALOG

_OUTSIDE = (
    "(()=>{if(window.labOutside)return;window.labOutside=true;"
    f"window.addEventListener('click',e=>{{if(e.target.matches?.('{AROUND_DIALOG}'))"
    "document.body.dispatchEvent(new KeyboardEvent('keydown',{key:'Escape',code:'Escape',bubbles:true}))},true)})()"
)
CLOSE_OUTSIDE = f'<img alt="" src="data:," style="display:none" onerror="{escape(_OUTSIDE)}">'
"""Once in a page: a click beside the help is its key to close it."""

HELP = """
| key | |
|---|---|
| **P** | push, as the Push tab or the open lesson says |
| **F** | what would this push do? |
| **K** | play or pause |
| **J** · **L** | step 1 ms · step 20 ms |
| **R** | stand up again |
| **B** | go on from the instant you look at, with other gains if you like |
| **M** · **N** | keep this run as A · the same pushes again |
| **G** | show or hide A |
| **T** · **Z** | a drag pushes the robot without Shift, or no longer · let go of it without a push |
| **1** **2** **3** **4** **5** | the tabs Push, Control, View, Runs, Share |
| **C** | a dark page, or a light one |
| **I** · **U** | next step · previous step of a lesson (*Learn* tab, left) |
| **X** | end the demonstration; so does any touch |
| **H** · **Esc** | this help · close it |

All of them, and more, are in the list that Ctrl+K opens. Space and arrows stay with the widgets.

The robot stands on its own; you push it. The controller moves the **CoP** (◆) under the feet to bring the
**CoM** (●) back. Where the safe border of the feet stops the CoP, the ground cannot give both goals: either the
body turns (linear momentum is kept) or the CoM gives way (angular momentum is kept). The *priority* slider of the
Control tab decides. At 0, too, computed-torque puts angular momentum first when the body runs out of room to turn and
the capture point is safe.

The line from the CoM to the **CMP** (▲) is parallel to the ground reaction force. The bar from CoP to CMP is the
lever with which that force turns the body: the longer it is, the faster angular momentum changes. Names in one label
(*CoP · CMP*) are of marks near each other, not at the same place: the bar says how far apart they are.

Drag to turn the picture, right-drag to move it, scroll to come closer. **Shift + drag** on the robot pulls it
there: the arrow shows the force, letting go pushes (*pulse*) or ends the push (*hold*, in the Push tab). Go back to
where you began, or press **Z**, and nobody is pushed. With a finger, or a hand that has no Shift, switch on *drag
pushes the robot* in the Push tab (**T**). *pulls* there lets your hand move up and sideways, not over the ground.

**Without a mouse.** Tab and Shift+Tab go from widget to widget, arrows move a slider, Home and End take it to its
ends. Letters typed into a box are no keys of the lab; Enter leaves a box of a number. Once the picture has the
focus, W, A, S, D, Q and E move the camera; the View tab has five fixed views.

**With a screen reader.** Sliders say their name, value and unit; the status is read out when it changes. The 3D
picture and the plots have a name but cannot be read: the status, the Runs table and `momentum-lab run --json` have
their numbers. A hint of a widget shows only under a mouse, and panels are moved and resized only with one.
"""


def keys_in_help() -> set[str]:
    """The keys that the page explains."""
    rows = [line for line in HELP.splitlines() if line.startswith("| **")]
    cells = [row.split("|")[1] for row in rows]
    return {word.strip("* ") for cell in cells for word in cell.replace("·", " ").split()}
