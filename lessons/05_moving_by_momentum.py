"""Moving by momentum

A hand reaches out, and the momentum of the whole body is to stay zero. Who pays?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.measured import com_moved, motion_done, pelvis_turn
from momentum_lab.lesson import spins

RESOLVED = {"controller": "resolved-momentum", "seconds": 2.0}
RUNS = {
    "held": lab.Run("reach", RESOLVED),
    "free": lab.Run("reach", {**RESOLVED, "controlled": "linear"}),
}
OUT = 0.8  # the hand is on its way out, s
Z = 2


def turn(session):
    """How far the pelvis turns about the vertical, degrees; to the left counts as positive."""
    turned = np.degrees(pelvis_turn(session)[:, Z])
    return turned[np.abs(turned).argmax()]


def hips_back(session):
    """How far the pelvis goes back, mm."""
    x = session.recording.column("q")[:, 0]
    return 1e3 * (x[0] - x.min())


def least_done(runs):
    """The least of what any joint does of its way, %."""
    return 100.0 * min(motion_done(run).max(axis=0).min() for run in runs.values())


def of_arm(session):
    return spins.of_motion(session)[:, Z]


def of_rest(session):
    return spins.of_rest(session)[:, Z]


def paid(session):
    """The part of the arm's angular momentum that the rest makes up for (n,), %."""
    with np.errstate(all="ignore"):
        return -100.0 * of_rest(session) / of_arm(session)


MEASURES = {
    "done": lab.Measure(least_done, "%"),
    "com": lab.Measure(lambda runs: 1e3 * max(np.abs(com_moved(run)).max() for run in runs.values()), "mm"),
    "back": lab.of("held", hips_back, "mm"),
    "turn": lab.of("held", turn, "degrees", ".1f"),
    "size": lab.of("held", lambda s: abs(turn(s)), "degrees", ".1f"),
    "free": lab.of("free", lambda s: abs(turn(s)), "degrees", ".1f"),
    "arm": lab.at("held", OUT, of_arm, "N m s", ".2f"),
    "paid": lab.at("held", OUT, paid, "%"),
    "paid_free": lab.at("free", OUT, paid, "%"),
    "left": lab.at("held", OUT, lambda s: of_arm(s) + of_rest(s), "N m s", ".2f"),
}

STEPS = (
    lab.Prose(
        "A controller can begin with the momentum of the whole body, six numbers, and find joint speeds that "
        "give it (Eq. 25). The right hand reaches forward. All six numbers are to stay zero."
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
        "You look from above, forward is up. Watch the hips. The free robot may have angular momentum.",
        "held",
        ("momenta",),
        beside="free",
        view="Above",
    ),
    lab.Compare(
        "The hips went back by {back} and turned by {size} to the right. Free to have angular momentum, they "
        "turned by {free}.",
        ("back", "turn", "free"),
    ),
    lab.Explain(
        "The hand goes forward on the right of the CoM: that is angular momentum to the left. For the sum to "
        "stay zero, the rest turns to the right (Eq. 16). It makes up for {paid} of the arm's, not for all: "
        "the plan is zero, but the joints follow it a little late. Unasked, it makes up for nothing.",
        "held",
        OUT,
        lab.Equation(
            "k_z = k_arm + k_rest",
            {
                "k_z": lab.Symbol(
                    lambda s: s.recording.column("momentum")[:, 5], "N m s", "of the whole body", ".2f"
                ),
                "k_arm": lab.Symbol(of_arm, "N m s", "of the reaching arm", ".2f"),
                "k_rest": lab.Symbol(of_rest, "N m s", "of everything else", ".2f"),
            },
            within=1e-6,
            unit="N m s",
        ),
    ),
    lab.Prose("So the trunk pays. Zero angular momentum is not free: it costs motion of everything else."),
)

CLAIMS = (
    *(lab.Stands(label, f"the {label} robot") for label in RUNS),
    lab.Bound("the hand reaches out", "done", low=70.0),
    lab.Bound("the CoM stays", "com", high=20.0),
    lab.Bound("the hips go back for the hand", "back", low=10.0),
    lab.Bound("and turn to the right", "turn", high=-1.0),
    lab.Bound("free to turn, they hardly turn", "free", high=2.0),
    lab.Bound("held, the rest pays for the arm", "paid", low=60.0, high=100.0),
    lab.Bound("free, it pays nothing", "paid_free", high=10.0),
)
