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


def inside(session):
    """How far the CoP stays inside the outer edge of the foot, mm."""
    return 1e3 * float(edge(session) - q.COP_Y.values(session).max())


def roll(session):
    """Largest early roll of the pelvis, degrees; to the left counts as positive."""
    turned = -np.degrees(early(session, pelvis_turn(session)[:, 0]))
    return float(turned[np.abs(turned).argmax()])


def left(session):
    """The part of the largest spin that is there at the end, %."""
    spin = np.abs(session.recording.column("momentum")[:, 3])
    return 100.0 * float(spin[-1] / spin.max())


MEASURES = {
    "push": lab.Measure(lambda runs: runs["push"].pushes[0].force, "N"),
    "cmp": lab.Measure(
        lambda runs: 1e3 * float(q.CMP_Y.values(runs["push"]).max() - edge(runs["push"])), "mm"
    ),
    "cop": lab.Measure(lambda runs: inside(runs["push"]), "mm", ".1f"),
    "roll": lab.Measure(lambda runs: roll(runs["push"]), "degrees", ".1f"),
    "spin": lab.Measure(
        lambda runs: -float(runs["push"].recording.column("momentum")[:, 3].min()), "N m s", ".2f"
    ),
    "left": lab.Measure(lambda runs: left(runs["push"]), "%"),
    "foot": lab.Measure(
        lambda runs: 1e3 * float(np.linalg.norm(swing_foot(runs["push"]), axis=1).max()), "mm"
    ),
    "foot_up": lab.Measure(lambda runs: 1e3 * float(swing_foot(runs["push"])[:, 1].max()), "mm"),
    "end": lab.Measure(
        lambda runs: 1e3 * float(np.linalg.norm(com_outside_goal(runs["push"])[-1])), "mm", ".1f"
    ),
}

STEPS = (
    lab.Prose(
        "The robot stands on its left leg, on a foot, not a rope, but narrow. A push of {push} comes from the right."
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
    lab.Play("Push from either side. Look at the free leg.", "push", ("push", "push direction")),
    lab.Compare(
        "The body rolled by {roll} with the push. The free foot swung by {foot}, {foot_up} of it upward: outward and "
        "up, as on a tightrope.",
        ("roll", "foot", "foot_up"),
    ),
    lab.Explain(
        "To stop the CoM, the ground has to push to the right, harder than its place under the foot allows. So the "
        "CMP goes {cmp} beyond the edge, while the CoP stays {cop} inside. The gap turns body and leg to the left "
        "(Eq. 23): they take a spin of {spin}, of which {left} are left in the end. The CoM ends {end} from its "
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
