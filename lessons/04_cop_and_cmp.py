"""CoP, CMP and the gap between them

The ground cannot push from outside the feet. Can its force still pass by the centre of mass?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.measured import push_end, push_start, times
from momentum_lab.lesson import quantities as q

RUNS = {"push": lab.Run("fig4")}
SHOWN = 0.32  # just after the push, s


def gap(session):
    """CMP minus CoP, forward (n,), mm."""
    column = session.recording.column
    return 1e3 * (column("cmp") - column("cop_measured"))[:, 0]


def after(session):
    return times(session) > push_end(session)


def widest(session):
    """The tick after the push at which CoP and CMP are farthest apart."""
    return np.flatnonzero(after(session))[np.abs(gap(session)[after(session)]).argmax()]


def beyond_toes(session, name):
    """How far a point is beyond the front edge of the feet then, mm."""
    return 1e3 * (session.recording.column(name)[widest(session), 0] - q.toes(session))


MEASURES = {
    "push": lab.of("push", q.push_force, "N"),
    "quiet": lab.of("push", lambda s: np.abs(gap(s)[times(s) < push_start(s)]).max(), "mm", ".2f"),
    "gap": lab.of("push", lambda s: gap(s)[widest(s)], "mm", ".1f"),
    "sooner": lab.of("push", lambda s: 1e3 * (times(s)[widest(s)] - push_end(s)), "ms"),
    "shown": lab.at("push", SHOWN, gap, "mm", ".1f"),
    "moment": lab.at("push", SHOWN, q.TURNING.values, "N m", ".1f"),
    "cop": lab.of("push", lambda s: beyond_toes(s, "cop_measured"), "mm"),
    "inside": lab.of("push", lambda s: -beyond_toes(s, "cop_measured"), "mm", ".1f"),
    "cmp": lab.of("push", lambda s: beyond_toes(s, "cmp"), "mm", ".1f"),
}

STEPS = (
    lab.Prose(
        "Two points on the floor. The CoP, the centre of pressure, is where the ground's force acts. The CMP "
        "is where the same force would have to act to point at the CoM. Standing still they are one point, "
        "{quiet} apart."
    ),
    lab.Choice(
        "After a push of {push} from behind, which of the two is in front of the toes?",
        (
            lab.Option("Neither", lambda m: m["cop"] <= 1.0 and m["cmp"] <= 1.0),
            lab.Option("Only the CoP", lambda m: m["cop"] > 1.0 and m["cmp"] <= 1.0),
            lab.Option("Only the CMP", lambda m: m["cop"] <= 1.0 and m["cmp"] > 1.0),
            lab.Option("Both", lambda m: m["cop"] > 1.0 and m["cmp"] > 1.0),
        ),
    ),
    lab.Number("How far apart are they at most?", "gap", 0, 200),
    lab.Play(
        "Slow it down. Watch the two points, and the bar between them.",
        "push",
        ("push", "push height"),
        view="Feet",
    ),
    lab.Compare(
        "At their farthest, right after the push, the CMP was {cmp} in front of the toes, and the CoP {inside} "
        "behind them: a gap of {gap}.",
        ("cop", "cmp", "gap"),
    ),
    lab.Explain(
        "A force that passes by the CoM turns the body, and the gap is its lever. Gap times vertical force is "
        "how fast the angular momentum changes (Eq. 23): here {shown} make {moment}.",
        "push",
        SHOWN,
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
        "The farther ahead the CMP, the harder the CoM is pushed back. The CMP may leave the feet; the body pays "
        "by turning, and the bar is the price."
    ),
)

CLAIMS = (
    lab.Stands("push"),
    lab.Bound("at rest CoP and CMP are one point", "quiet", high=0.1),
    lab.Bound("right after the push", "sooner", high=20.0),
    lab.Bound("they part", "gap", low=10.0),
    lab.Bound("the CoP stays on the feet", "cop", high=0.5),
    lab.Bound("the CMP leaves them", "cmp", low=5.0),
)
