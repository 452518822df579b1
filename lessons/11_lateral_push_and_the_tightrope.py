"""Lateral push and the tightrope

Someone on a tightrope, pushed to the left: which way do the arms and the free leg swing, and why?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.fig5 import edge, swing_foot
from momentum_lab.experiments.measured import com_outside_goal, pelvis_turn, push_start, times
from momentum_lab.lesson import quantities as q

RUNS = {"push": lab.Run("fig5", {"seconds": 2.2})}


def early(session, values):
    """The part of an array within six tenths of a second after the push began."""
    clock = times(session)
    return values[(clock > push_start(session)) & (clock < push_start(session) + 0.6)]


def roll(session):
    """Largest early roll of the pelvis, degrees; to the left counts as positive."""
    turned = -np.degrees(early(session, pelvis_turn(session)[:, 0]))
    return turned[np.abs(turned).argmax()]


def left(session):
    """The part of the largest angular momentum that is there at the end, %."""
    spin = np.abs(session.recording.column("momentum")[:, 3])
    return 100.0 * spin[-1] / spin.max()


MEASURES = {
    "push": lab.of("push", q.push_force, "N"),
    "cmp": lab.of("push", lambda s: 1e3 * (q.CMP_Y.values(s).max() - edge(s)), "mm"),
    "cop": lab.of("push", lambda s: 1e3 * (edge(s) - q.COP_Y.values(s).max()), "mm", ".1f"),
    "roll": lab.of("push", roll, "degrees", ".1f"),
    "spin": lab.of("push", lambda s: -s.recording.column("momentum")[:, 3].min(), "N m s", ".2f"),
    "left": lab.of("push", left, "%"),
    "foot": lab.of("push", lambda s: 1e3 * np.linalg.norm(swing_foot(s), axis=1).max(), "mm"),
    "foot_up": lab.of("push", lambda s: 1e3 * swing_foot(s)[:, 1].max(), "mm"),
    "end": lab.of("push", lambda s: 1e3 * np.linalg.norm(com_outside_goal(s)[-1]), "mm", ".1f"),
}

STEPS = (
    lab.Prose(
        "The robot stands on its left leg: no rope, but a narrow foot. A push of {push} comes from the right."
    ),
    lab.Choice(
        "Which way does its body roll at first?",
        (
            lab.Option("To the right, against the push", lambda m: m["roll"] <= -1.0),
            lab.Option("Not at all", lambda m: abs(m["roll"]) < 1.0),
            lab.Option("To the left, with the push", lambda m: m["roll"] >= 1.0),
        ),
    ),
    lab.Number("How far does the free foot swing?", "foot", 0, 500),
    lab.Play("Look from the front. Then push from either side.", "push", ("push", "push direction")),
    lab.Compare(
        "The body rolled by {roll} with the push. The free foot swung by {foot}, {foot_up} of it upward: out "
        "and up, as on a tightrope.",
        ("roll", "foot", "foot_up"),
    ),
    lab.Explain(
        "To stop the CoM, the ground must push to the right, harder than a force through the CoM could. So the "
        "CMP goes {cmp} beyond the edge, the CoP stays {cop} inside, and the gap turns body and leg to the "
        "left (Eq. 23). They take up {spin} and give it back: {left} is left, and the CoM ends {end} from its "
        "place.",
        "push",
        0.35,
        lab.Equation(
            "dk_x = f_z * (p_y - s_y)",
            {"dk_x": q.ROLLING, "f_z": q.FORCE_Z, "p_y": q.COP_Y, "s_y": q.CMP_Y},
            within=0.5,
            unit="N m",
            share=0.95,
            since=0.31,
        ),
    ),
)

CLAIMS = (
    lab.Stands("push"),
    lab.Bound("the CMP leaves the foot", "cmp", low=5.0),
    lab.Bound("the CoP does not", "cop", low=0.0),
    lab.Bound("the body rolls with the push", "roll", low=2.0),
    lab.Bound("and takes the spin", "spin", low=0.2),
    lab.Bound("and gives it back", "left", high=10.0),
    lab.Bound("the free foot swings", "foot", low=10.0),
    lab.Bound("upward too", "foot_up", low=5.0),
    lab.Bound("the CoM comes back", "end", high=5.0),
)
