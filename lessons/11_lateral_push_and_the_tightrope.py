"""Lateral push and the tightrope

Someone on a tightrope is pushed to the left: which way do the arms and the free leg turn, and why?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.fig5 import edge, swing_foot
from momentum_lab.experiments.measured import com_outside_goal
from momentum_lab.lesson import quantities as q
from momentum_lab.momentum.centroidal import link_by_link
from momentum_lab.robot.state import State

RUNS = {"push": lab.Run("fig5", {"seconds": 2.2})}
AFTER = 0.32  # just after the push, s
ARMS, LEGS = ("arm_", "gripper", "shoulder", "elbow", "wrist"), ("leg_", "hip", "knee", "ankle")


def spin(session):
    """Angular momentum to the left, about x (n,), N m s."""
    return -session.recording.column("momentum")[:, 3]


def share(words, side=""):
    """The part of the largest angular momentum that some links have, by their joints' names, %."""

    def part(session):
        tick = spin(session).argmax()
        state = State(session.recording.column("q")[tick], session.recording.column("v")[tick])
        found = link_by_link(session.robot, state)
        named = [any(word in name for word in words) and side in name for name in found.joint_names]
        return -100.0 * found.momenta_about_com[named, 3].sum() / spin(session)[tick]

    return part


def lean(session):
    """How far the trunk leans to the left at most, °."""
    x, y, z, w = session.recording.column("q")[:, 3:7].T
    return np.degrees(np.arcsin(-2.0 * (w * x + y * z))).max()


def beyond_edge(session):
    """How far the CMP is outside the foot's edge (n,), mm."""
    return 1e3 * (q.CMP_Y.values(session) - edge(session))


def inside_edge(session):
    """How far the CoP is inside it (n,), mm."""
    return 1e3 * (edge(session) - q.COP_Y.values(session))


MEASURES = {
    "push": lab.of("push", q.push_force, "N"),
    "arms": lab.of("push", share(ARMS), "%"),
    "leg": lab.of("push", share(LEGS, "right"), "%"),
    "foot_right": lab.of("push", lambda s: -1e3 * swing_foot(s)[:, 0].min(), "mm"),
    "foot_up": lab.of("push", lambda s: 1e3 * swing_foot(s)[:, 1].max(), "mm"),
    "lean": lab.of("push", lean, "°", ".1f"),
    "cmp": lab.at("push", AFTER, beyond_edge, "mm", ".1f"),
    "cop": lab.at("push", AFTER, inside_edge, "mm", ".1f"),
    "farthest": lab.of("push", lambda s: inside_edge(s).min(), "mm", ".1f"),
    "spin": lab.of("push", lambda s: spin(s).max(), "N m s", ".2f"),
    "left": lab.of("push", lambda s: 100.0 * abs(spin(s)[-1]) / spin(s).max(), "%"),
    "end": lab.of("push", lambda s: 1e3 * np.linalg.norm(com_outside_goal(s)[-1]), "mm", ".1f"),
}

STEPS = (
    lab.Prose(
        "The robot stands on its left leg: no rope, but a narrow foot. A push of {push} comes from the right. "
        "To turn to the left is to turn like a wheel that rolls there: what is above its middle goes left, "
        "what hangs below it goes right."
    ),
    lab.Choice(
        "Which way do its arms and its free leg turn at first?",
        (
            lab.Option("To the right, against the push", lambda m: max(m["arms"], m["leg"]) <= -5.0),
            lab.Option("The arms one way, the leg the other", lambda m: m["arms"] * m["leg"] < -25.0),
            lab.Option("To the left, with the push", lambda m: min(m["arms"], m["leg"]) >= 5.0),
        ),
    ),
    lab.Number("How much of the whole body's angular momentum do the arms take?", "arms", 0, 100),
    lab.Play(
        "You look from the front: its left is on your right. Slow time down. Watch the head, above the middle, and "
        "the hands and the free foot, below it.",
        "push",
        ("push", "push direction"),
        view="Front",
    ),
    lab.Compare(
        "All turned to the left, like a wheel that rolls with the push: the head leant left, and the free foot, "
        "below, swung {foot_right} to the right and {foot_up} up. The arms took {arms} of the angular momentum, "
        "the free leg {leg}.",
        ("arms", "leg", "foot_right"),
    ),
    lab.Explain(
        "To stop the CoM the ground must push to the right, harder than a force through the CoM could. So the "
        "CMP goes {cmp} beyond the edge, while the CoP stays {cop} inside. The gap turns the body to the left "
        "(Eq. 23). Arms and leg reach far out, so they take up much of it. They give it back: {left} of {spin} "
        "is left at the end.",
        "push",
        AFTER,
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
    lab.Bound("nor at any other time", "farthest", low=0.0),
    lab.Bound("the body turns with the push", "spin", low=0.2),
    lab.Bound("the arms take much of it", "arms", low=20.0),
    lab.Bound("and the free leg", "leg", low=10.0),
    lab.Bound("they give it back", "left", high=10.0),
    lab.Bound("the free foot, below, swings to the right", "foot_right", low=5.0),
    lab.Bound("the trunk, above, leans to the left", "lean", low=0.5),
    lab.Bound("upward too", "foot_up", low=5.0),
    lab.Bound("the CoM comes back", "end", high=5.0),
)
