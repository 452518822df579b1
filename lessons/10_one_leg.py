"""One leg, CoM outside the foot

It stands on one leg, and its CoM is beyond the edge of the foot. What can bring it back?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.fig5 import edge
from momentum_lab.experiments.fig9 import body_roll, com_slack, lateral_cop, outer_border
from momentum_lab.experiments.measured import com_outside_goal, times
from momentum_lab.lesson import quantities as q

EARLY = 0.2  # s
RUNS = {
    "turning": lab.Run("fig9", {"seconds": 2.6}),
    "upright": lab.Run("fig9", {"priority": 1.0, "seconds": 2.0}),
}


def pinned(session):
    """How long the CoP stays at the outer border of the foot, s."""
    at_border = np.abs(lateral_cop(session) - outer_border(session)) < 5e-4
    return at_border.sum() * session.scenario.timestep


def gone(session, values, part):
    """When something falls below a part of its largest for good, s."""
    return times(session)[np.flatnonzero(np.abs(values) > part * np.abs(values).max())[-1]]


def outward(session):
    """The largest roll, degrees; outward, to the left, counts as positive."""
    roll = -np.degrees(body_roll(session))
    return roll[np.abs(roll).argmax()]


def beyond_edge(session):
    """How far the CMP is outside the foot's edge (n,), mm."""
    return 1e3 * (q.CMP_Y.values(session) - edge(session))


def slack_gone(session):
    return gone(session, com_slack(session), 0.02)


def roll_gone(session):
    return gone(session, body_roll(session), 0.1)


MEASURES = {
    "outside": lab.of("turning", lambda s: 1e3 * s.scenario.com_outside, "mm"),
    "turning": lab.fate("turning"),
    "upright": lab.fate("upright"),
    "pinned": lab.of("turning", pinned, "s", ".2f"),
    "slack_gone": lab.of("turning", slack_gone, "s", ".2f"),
    "roll": lab.of("turning", lambda s: np.degrees(np.abs(body_roll(s)).max()), "degrees", ".1f"),
    "outward": lab.of("turning", outward, "degrees", ".1f"),
    "cmp": lab.at("turning", EARLY, beyond_edge, "mm", ".1f"),
    "com": lab.at("turning", EARLY, lambda s: 1e3 * (q.COM_Y.values(s) - edge(s)), "mm", ".1f"),
    "lead": lab.at("turning", EARLY, lambda s: 1e3 * (q.CMP_Y.values(s) - q.COM_Y.values(s)), "mm", ".1f"),
    "roll_gone": lab.of("turning", roll_gone, "s", ".2f"),
    "later": lab.of("turning", lambda s: roll_gone(s) - slack_gone(s), "s", ".2f"),
    "left_over": lab.of("turning", lambda s: 1e3 * np.linalg.norm(com_outside_goal(s)[-1]), "mm", ".1f"),
}

STEPS = (
    lab.Prose(
        "On its left leg, at rest, the CoM is {outside} to the left of the foot's edge. The CoP can go no farther "
        "than the edge. A force from there through the CoM pushes the CoM outward, and the robot tips over."
    ),
    lab.Choice(
        "One robot keeps its trunk upright, and tips over. The other throws it to one side, and is saved. To which?",
        (
            lab.Option("Inward, over the foot", lambda m: m["outward"] <= -5.0),
            lab.Option("To neither: forward or back", lambda m: abs(m["outward"]) < 5.0),
            lab.Option("Outward, even farther over the edge", lambda m: m["outward"] >= 5.0),
        ),
    ),
    lab.Number("How far does it roll?", "roll", 0, 90),
    lab.Play(
        "You look from the front: outward is to your right. Watch the trunks.",
        "turning",
        ("priority", "com_stiffness"),
        beside="upright",
        view="Front",
    ),
    lab.Compare(
        "The trunk rolled outward by {roll}, and the robot {turning}. The one that kept it upright {upright}.",
        ("turning", "upright", "roll"),
    ),
    lab.Explain(
        "A force that turns the trunk outward passes by the CoM, and pushes it inward: its CMP is {cmp} outside "
        "the edge, the CoM by then only {com} (Eq. 23). The CoM is back first: after {slack_gone} it gets all the "
        "force it wants. Then the trunk follows, upright after {roll_gone}.",
        "turning",
        EARLY,
        lab.Equation(
            "dk_x = f_z * (p_y - s_y)",
            {"dk_x": q.ROLLING, "f_z": q.FORCE_Z, "p_y": q.COP_Y, "s_y": q.CMP_Y},
            within=0.5,
            unit="N m",
            share=0.95,
        ),
    ),
)

CLAIMS = (
    lab.Stands("turning", "the robot that lets its body turn"),
    lab.Falls("upright", "the robot that keeps its body upright"),
    lab.Bound("the CoP is at its border", "pinned", low=0.3),
    lab.Bound("the body turns outward", "outward", low=10.0),
    lab.Bound("the CMP is outside the foot", "cmp", low=1.0),
    lab.Bound("and farther out than the CoM", "lead", low=1.0),
    lab.Bound("first the CoM, then the body", "later", low=0.2),
    lab.Bound("the CoM comes back", "left_over", high=1.0),
)
