"""Moving by momentum

A hand reaches out, a leg kicks. If the momentum of the whole body must stay zero, who pays?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.measured import com_moved, motion_done, pelvis_turn
from momentum_lab.lesson import spins

RESOLVED = {"controller": "resolved-momentum", "seconds": 2.0}
RUNS = {
    "held": lab.Run("reach", RESOLVED),
    "free": lab.Run("reach", {**RESOLVED, "controlled": "linear"}),
    "kick_held": lab.Run("kick", RESOLVED),
    "kick_free": lab.Run("kick", {**RESOLVED, "controlled": "linear+kz"}),
}
Y, Z = 1, 2


def farthest(values):
    """The largest of all values, with its sign."""
    return values[np.abs(values).argmax()]


def turn(session):
    """How far the pelvis turns about the vertical, degrees; to the left counts as positive."""
    return farthest(np.degrees(pelvis_turn(session)[:, Z]))


def swing(session):
    """How far the pelvis tips forward and back, degrees."""
    return np.degrees(np.ptp(pelvis_turn(session)[:, Y]))


def hips_back(session):
    """How far the pelvis goes back, mm."""
    x = session.recording.column("q")[:, 0]
    return 1e3 * (x[0] - x.min())


def least_done(runs):
    """The least of what any joint does of its way, %."""
    return 100.0 * min(motion_done(run).max(axis=0).min() for run in runs.values())


MEASURES = {
    "done": lab.Measure(least_done, "%"),
    "com": lab.Measure(lambda runs: 1e3 * max(np.abs(com_moved(run)).max() for run in runs.values()), "mm"),
    "back": lab.of("held", hips_back, "mm"),
    "turn": lab.of("held", turn, "degrees", ".1f"),
    "size": lab.of("held", lambda s: abs(turn(s)), "degrees", ".1f"),
    "free": lab.of("free", lambda s: abs(turn(s)), "degrees", ".1f"),
    "leg": lab.of("kick_held", lambda s: np.abs(spins.of_motion(s)[:, Y]).max(), "N m s", ".1f"),
    "paid": lab.of("kick_held", lambda s: spins.taken_back(s, Y), "%"),
    "paid_free": lab.of("kick_free", lambda s: spins.taken_back(s, Y), "%"),
    "swing": lab.of("kick_held", swing, "degrees", ".1f"),
    "swing_free": lab.of("kick_free", swing, "degrees", ".1f"),
}

STEPS = (
    lab.Prose(
        "This controller thinks of six numbers, the linear and the angular momentum of the whole body, and "
        "finds joint speeds that give them (Eq. 25). The right hand reaches forward. All six are to stay zero."
    ),
    lab.Number("The arm goes forward and the CoM must not. How far do the hips go back?", "back", 0, 200),
    lab.Choice(
        "Seen from above, which way do the hips turn meanwhile?",
        (
            lab.Option("To the left: the right side follows the hand", lambda m: m["turn"] >= 1.0),
            lab.Option("Not at all", lambda m: abs(m["turn"]) < 1.0),
            lab.Option("To the right, against the hand", lambda m: m["turn"] <= -1.0),
        ),
    ),
    lab.Play(
        "Watch the hips of both. The second robot is free to have angular momentum.",
        "held",
        ("momenta",),
        beside="free",
    ),
    lab.Compare(
        "The hips went back by {back} and turned by {size} to the right. Free to have angular momentum, they "
        "turned by {free}.",
        ("back", "turn", "free"),
    ),
    lab.Explain(
        "The hand passes the body on its right and so turns to the left about the CoM. For the sum to stay "
        "zero, the rest has to turn to the right (Eq. 16).",
        "held",
        0.8,
        lab.Equation(
            "k_z = k_arm + k_rest",
            {
                "k_z": lab.Symbol(
                    lambda s: s.recording.column("momentum")[:, 5], "N m s", "of the whole body", ".2f"
                ),
                "k_arm": lab.Symbol(
                    lambda s: spins.of_motion(s)[:, Z], "N m s", "of the reaching arm", ".2f"
                ),
                "k_rest": lab.Symbol(lambda s: spins.of_rest(s)[:, Z], "N m s", "of everything else", ".2f"),
            },
            within=1e-6,
            unit="N m s",
        ),
    ),
    lab.Number(
        "Now it stands on one leg and kicks. When the leg has most angular momentum, how much does the rest "
        "take back?",
        "paid",
        0,
        150,
    ),
    lab.Play("Watch the trunk, not the leg.", "kick_held", ("momenta",), beside="kick_free"),
    lab.Compare(
        "The leg had {leg}; the rest took {paid} of it back, {paid_free} where tipping was free. The pelvis "
        "swung by {swing} and {swing_free}. Zero angular momentum costs motion of the trunk.",
        ("paid", "swing", "swing_free"),
    ),
)

CLAIMS = (
    *(lab.Stands(label, f"the robot of the run {label}") for label in RUNS),
    lab.Bound("every motion is done", "done", low=70.0),
    lab.Bound("the CoM stays", "com", high=20.0),
    lab.Bound("the hips go back for the hand", "back", low=10.0),
    lab.Bound("free to turn, they hardly turn", "free", high=2.0),
    lab.Bound("held, the rest pays for the leg", "paid", low=50.0),
    lab.Bound("free, it pays less", "paid_free", high=50.0),
)
