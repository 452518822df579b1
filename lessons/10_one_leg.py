"""One leg, CoM outside the foot

It stands on one leg, at rest, and its CoM is beyond the edge of the foot. What can hold it now?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.fig9 import body_roll, com_slack, lateral_cop, outer_border
from momentum_lab.experiments.measured import com_outside_goal, times
from momentum_lab.lesson import quantities as q

RUNS = {"com": lab.Run("fig9", {"seconds": 2.6}), "body": lab.Run("fig9", {"priority": 1.0, "seconds": 2.0})}


def pinned(session):
    """How long the CoP stays at the outer border of the foot, s."""
    return (
        float((np.abs(lateral_cop(session) - outer_border(session)) < 5e-4).sum()) * session.scenario.timestep
    )


def gone(session, values, part):
    """When something falls below a part of its largest for good, s."""
    above = np.flatnonzero(np.abs(values) > part * np.abs(values).max())
    return float(times(session)[above[-1]])


def later(session):
    """How much later the roll is gone than the slack, s."""
    return gone(session, body_roll(session), 0.1) - gone(session, com_slack(session), 0.02)


def left_over(session):
    """How far the CoM is from the middle of the foot at the end, mm."""
    return 1e3 * float(np.linalg.norm(com_outside_goal(session)[-1]))


MEASURES = {
    "outside": lab.Measure(lambda runs: 1e3 * runs["com"].scenario.com_outside, "mm"),
    "com": lab.Measure(lambda runs: "stands" if runs["com"].fall is None else "falls"),
    "body": lab.Measure(lambda runs: "stands" if runs["body"].fall is None else "falls"),
    "pinned": lab.Measure(lambda runs: pinned(runs["com"]), "s", ".2f"),
    "slack": lab.Measure(lambda runs: float(np.abs(com_slack(runs["com"])).max()), "m/s^2", ".2f"),
    "slack_gone": lab.Measure(lambda runs: gone(runs["com"], com_slack(runs["com"]), 0.02), "s", ".2f"),
    "roll": lab.Measure(
        lambda runs: float(np.degrees(np.abs(body_roll(runs["com"])).max())), "degrees", ".1f"
    ),
    "roll_gone": lab.Measure(lambda runs: gone(runs["com"], body_roll(runs["com"]), 0.1), "s", ".2f"),
    "later": lab.Measure(lambda runs: later(runs["com"]), "s", ".2f"),
    "left_over": lab.Measure(lambda runs: left_over(runs["com"]), "mm", ".1f"),
}

STEPS = (
    lab.Prose(
        "The CoM starts {outside} outside the edge. The CoP goes to the edge at once and can go no further. If the "
        "force of the ground points at the CoM, it pushes it outward: the robot tips over."
    ),
    lab.Choice(
        "No step, no hands, no second foot. Can it come back?",
        (
            lab.Option("No", lambda m: m["com"] == "falls" == m["body"]),
            lab.Option("Yes, if it keeps its body upright", lambda m: m["com"] == "falls" != m["body"]),
            lab.Option("Yes, if it lets its body turn", lambda m: m["body"] == "falls" != m["com"]),
            lab.Option("Yes, either way", lambda m: "falls" not in (m["com"], m["body"])),
        ),
    ),
    lab.Number("How far does the body roll on the way?", "roll", 0, 90),
    lab.Play(
        "Let it go. Then exchange what matters more.", "com", ("priority", "com_stiffness"), beside="body"
    ),
    lab.Compare(
        "The robot that lets its body turn {com}; the one that keeps it upright {body}. The body rolled by {roll} "
        "while the CoP was at its border for {pinned}.",
        ("com", "body", "roll", "pinned"),
    ),
    lab.Explain(
        "The force passes by the CoM: the CMP lies outside the foot, the CoP inside, and the body pays for the gap "
        "(Eq. 23). What the CoM still lacks is its slack, {slack} at most. It is gone after {slack_gone}; the body "
        "follows, upright after {roll_gone}, and the CoM ends {left_over} from its place.",
        "com",
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
    lab.Stands("com", "the robot that lets its body turn"),
    lab.Falls("body", "the robot that keeps its body upright"),
    lab.Bound("the CoP is at its border", "pinned", low=0.3),
    lab.Bound("the body turns", "roll", low=10.0),
    lab.Bound("first the CoM, then the body", "later", low=0.2),
    lab.Bound("the CoM comes back", "left_over", high=1.0),
)
