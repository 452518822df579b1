"""One leg, CoM outside the foot

It stands on one leg, at rest, and its CoM is beyond the edge of the foot. What can hold it now?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.fig9 import body_roll, com_slack, lateral_cop, outer_border
from momentum_lab.experiments.measured import com_outside_goal, times
from momentum_lab.lesson import quantities as q

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


def slack_gone(session):
    return gone(session, com_slack(session), 0.02)


def roll_gone(session):
    return gone(session, body_roll(session), 0.1)


MEASURES = {
    "outside": lab.of("turning", lambda s: 1e3 * s.scenario.com_outside, "mm"),
    "turning": lab.fate("turning"),
    "upright": lab.fate("upright"),
    "pinned": lab.of("turning", pinned, "s", ".2f"),
    "slack": lab.of("turning", lambda s: np.abs(com_slack(s)).max(), "m/s^2", ".2f"),
    "slack_gone": lab.of("turning", slack_gone, "s", ".2f"),
    "roll": lab.of("turning", lambda s: np.degrees(np.abs(body_roll(s)).max()), "degrees", ".1f"),
    "roll_gone": lab.of("turning", roll_gone, "s", ".2f"),
    "later": lab.of("turning", lambda s: roll_gone(s) - slack_gone(s), "s", ".2f"),
    "left_over": lab.of("turning", lambda s: 1e3 * np.linalg.norm(com_outside_goal(s)[-1]), "mm", ".1f"),
}

STEPS = (
    lab.Prose(
        "The CoM is {outside} outside the edge of the foot. The CoP is at the edge and can go no further. A "
        "force from there that points at the CoM pushes it outward, and the robot tips over."
    ),
    lab.Choice(
        "No step, no hands, no second foot. Can it come back?",
        (
            lab.Option("No", lambda m: "stands" not in (m["turning"], m["upright"])),
            lab.Option(
                "Yes, if it keeps its body upright", lambda m: m["turning"] != "stands" == m["upright"]
            ),
            lab.Option("Yes, if it lets its body turn", lambda m: m["upright"] != "stands" == m["turning"]),
            lab.Option("Yes, either way", lambda m: m["turning"] == "stands" == m["upright"]),
        ),
    ),
    lab.Number("How far does its body roll to the side on the way?", "roll", 0, 90),
    lab.Play("Watch the trunk, from the front.", "turning", ("priority", "com_stiffness"), beside="upright"),
    lab.Compare(
        "The robot that lets its body turn {turning}; the one that keeps it upright {upright}. The body rolled "
        "by {roll} while the CoP was at its border for {pinned}.",
        ("turning", "upright", "roll", "pinned"),
    ),
    lab.Explain(
        "The force does not point at the CoM but inward of it: the CMP lies outside the foot, and the body "
        "pays for the gap by rolling (Eq. 23). The slack is what the CoM's goal still has to do without, "
        "{slack} at most. It is gone after {slack_gone}. Then the body comes back too, upright after "
        "{roll_gone}.",
        "turning",
        0.2,
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
    lab.Bound("the body turns", "roll", low=10.0),
    lab.Bound("first the CoM, then the body", "later", low=0.2),
    lab.Bound("the CoM comes back", "left_over", high=1.0),
)
