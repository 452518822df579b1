"""CoP, CMP and the gap between them

The ground cannot push from outside the feet. Can its force still pass by the centre of mass?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.measured import push_end, push_start, times
from momentum_lab.lesson import quantities as q

RUNS = {"push": lab.Run("fig4")}


def gap(session):
    """CMP minus CoP, forward (n,), mm."""
    column = session.recording.column
    return 1e3 * (column("cmp") - column("cop_measured"))[:, 0]


def after(session):
    return times(session) > push_end(session)


def beyond_toes(session, name):
    """How far a point goes beyond the front edge of the feet after the push, mm."""
    points = session.recording.column(name)[after(session), 0]
    return 1e3 * (np.percentile(points, 99.5) - q.toes(session))


MEASURES = {
    "push": lab.of("push", q.push_force, "N"),
    "quiet": lab.of("push", lambda s: np.abs(gap(s)[times(s) < push_start(s)]).max(), "mm", ".2f"),
    "gap": lab.of("push", lambda s: np.abs(gap(s)[after(s)]).max(), "mm"),
    "cop": lab.of("push", lambda s: beyond_toes(s, "cop_measured"), "mm"),
    "inside": lab.of("push", lambda s: -beyond_toes(s, "cop_measured"), "mm", ".1f"),
    "cmp": lab.of("push", lambda s: beyond_toes(s, "cmp"), "mm"),
}

STEPS = (
    lab.Prose(
        "Two points on the floor. The CoP, the centre of pressure, is where the ground's force acts. The CMP "
        "is where it would have to act to point at the CoM. Standing still, they are {quiet} apart: one point."
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
    lab.Play("Watch the bar between the two points, and the trunk.", "push", ("push", "push height")),
    lab.Compare(
        "The CMP went {cmp} beyond the toes. The CoP stopped {inside} inside. The gap grew to {gap}.",
        ("cop", "cmp", "gap"),
    ),
    lab.Explain(
        "A force that passes by the CoM turns the body. The gap is its lever: times the vertical force, it is "
        "how fast the angular momentum changes (Eq. 23).",
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
        "The farther ahead the CMP, the harder the CoM is pushed back. A robot can send it past the toes, and "
        "pays by turning. The bar on the screen is the price."
    ),
)

CLAIMS = (
    lab.Stands("push"),
    lab.Bound("at rest CoP and CMP are one point", "quiet", high=0.1),
    lab.Bound("after the push they part", "gap", low=10.0),
    lab.Bound("the CoP stays on the feet", "cop", high=0.5),
    lab.Bound("the CMP leaves them", "cmp", low=5.0),
)
