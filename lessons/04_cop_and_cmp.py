"""CoP, CMP and the gap between them

The ground cannot push from outside the feet. Can its force still pass by the centre of mass?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.measured import push_end, push_start, times
from momentum_lab.lesson import quantities as q

RUNS = {"push": lab.Run("fig4")}


def gap(session):
    """CMP minus CoP, forward, mm."""
    column = session.recording.column
    return 1e3 * (column("cmp") - column("cop_measured"))[:, 0]


def after(session):
    return times(session) > push_end(session)


def farthest(session):
    """The tick after the push at which both points are farthest apart."""
    return int(np.where(after(session), np.abs(gap(session)), 0.0).argmax())


def beyond_toes(runs, name):
    """How far a point goes beyond the front edge of the feet after the push, mm."""
    session = runs["push"]
    toes = session.recording.column("sole_pose")[0, :, 0].mean() + session.robot.soles[0].upper[0]
    points = session.recording.column(name)[after(session), 0]
    return 1e3 * float(np.percentile(points, 99.5) - toes)


def quiet_gap(runs):
    session = runs["push"]
    return float(np.abs(gap(session)[times(session) < push_start(session)]).max())


MEASURES = {
    "push": lab.Measure(lambda runs: runs["push"].pushes[0].force, "N"),
    "quiet": lab.Measure(quiet_gap, "mm", ".2f"),
    "gap": lab.Measure(lambda runs: float(np.abs(gap(runs["push"]))[farthest(runs["push"])]), "mm"),
    "cop": lab.Measure(lambda runs: beyond_toes(runs, "cop_measured"), "mm"),
    "cmp": lab.Measure(lambda runs: beyond_toes(runs, "cmp"), "mm"),
}

STEPS = (
    lab.Prose(
        "Two points on the floor. The CoP is where the ground's force acts. The CMP is where it would have to act "
        "to point at the CoM. In quiet standing they are {quiet} apart: one point."
    ),
    lab.Choice(
        "After a push of {push} from behind, which of the two can be found in front of the toes?",
        (
            lab.Option("Neither", lambda m: m["cop"] <= 1.0 and m["cmp"] <= 1.0),
            lab.Option("Only the CoP", lambda m: m["cop"] > 1.0 and m["cmp"] <= 1.0),
            lab.Option("Only the CMP", lambda m: m["cop"] <= 1.0 and m["cmp"] > 1.0),
            lab.Option("Both", lambda m: m["cop"] > 1.0 and m["cmp"] > 1.0),
        ),
    ),
    lab.Number("How far apart are they at most?", "gap", 0, 200),
    lab.Play(
        "Look at the bar between both points, and at the body, push by push.", "push", ("push", "push height")
    ),
    lab.Compare(
        "The CMP went {cmp} beyond the toes. The CoP stayed within its border (a minus is inside): {cop}. "
        "The gap grew to {gap}.",
        ("cop", "cmp", "gap"),
    ),
    lab.Explain(
        "A force that passes by the CoM turns the body. The gap is the lever: times the vertical force it is the "
        "rate of angular momentum (Eq. 23).",
        "push",
        0.35,
        lab.Equation(
            "dk_y = f_z * (s_x - p_x)",
            {"dk_y": q.TURNING, "f_z": q.FORCE_Z, "s_x": q.CMP_X, "p_x": q.COP_X},
            within=0.5,
            unit="N m",
            share=0.95,
            since=0.31,
        ),
    ),
    lab.Prose(
        "So a robot has a way past its toes: it pays with rotation. The bar on the screen is the price."
    ),
)

CLAIMS = (
    lab.Stands("push"),
    lab.Bound("at rest CoP and CMP are one point", "quiet", high=0.1),
    lab.Bound("after the push they part", "gap", low=10.0),
    lab.Bound("the CoP stays on the feet", "cop", high=0.5),
    lab.Bound("the CMP leaves them", "cmp", low=5.0),
)
