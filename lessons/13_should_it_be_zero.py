"""Should angular momentum be zero?

A balance controller asks for zero angular momentum. Now the arms are to swing. Is zero still a good wish?
"""

from functools import lru_cache

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.arm_swing import spin, turned
from momentum_lab.experiments.measured import motion_done
from momentum_lab.robot.state import State

RUNS = {
    "zero": lab.Run("arm-swing", {"seconds": 3.0}),
    "reference": lab.Run("arm-swing", {"seconds": 3.0, "angular_goal": "reference"}),
    "partial": lab.Run("arm-swing", {"seconds": 3.0, "controlled": "linear"}),
}


def done(session):
    """The least of what every arm does of its swing, %."""
    return 100.0 * float(motion_done(session).max(axis=0).min())


def turn(session):
    """The largest turn of the pelvis, degrees."""
    return float(np.degrees(turned(session).max()))


def part(runs, label):
    """The turn of the pelvis as part of that with a goal of zero, %."""
    return 100.0 * turn(runs[label]) / turn(runs["zero"])


@lru_cache(2)
def shares(session):
    """Angular momentum of the swinging joints, of everything else and of the body (n, 3), N m s (Eq. 16).

    About the axis about which the arms have most.
    """
    swinging = 6 + np.flatnonzero(session.motion_reach)
    column, found = session.recording.column, []
    for q, v in zip(column("q"), column("v"), strict=True):
        parts = session.robot.at(State(q, v)).centroidal_map[3:] * v
        found.append((parts[:, swinging].sum(1), parts.sum(1) - parts[:, swinging].sum(1)))
    parts = np.array(found)
    axis = int(np.abs(parts[:, 0]).max(axis=0).argmax())
    return np.column_stack([parts[:, 0, axis], parts[:, 1, axis], column("momentum")[:, 3 + axis]])


MEASURES = {
    "arms": lab.Measure(lambda runs: min(done(run) for run in runs.values()), "%"),
    "zero": lab.Measure(lambda runs: turn(runs["zero"]), "degrees", ".1f"),
    "reference": lab.Measure(lambda runs: turn(runs["reference"]), "degrees", ".1f"),
    "partial": lab.Measure(lambda runs: turn(runs["partial"]), "degrees", ".2f"),
    "left": lab.Measure(lambda runs: part(runs, "reference"), "%"),
    "left_partial": lab.Measure(lambda runs: part(runs, "partial"), "%"),
    "spin_zero": lab.Measure(lambda runs: float(spin(runs["zero"]).max()), "N m s", ".2f"),
    "spin": lab.Measure(lambda runs: float(spin(runs["reference"]).max()), "N m s", ".2f"),
}

STEPS = (
    lab.Choice(
        "The arms swing as they are told, feet stay, and the controller asks for zero angular momentum. What gives?",
        (
            lab.Option("Nothing: the arms cancel each other", lambda m: m["zero"] < 1.0 and m["arms"] > 80.0),
            lab.Option("The arms hardly swing", lambda m: m["arms"] <= 80.0),
            lab.Option("The body turns against the arms", lambda m: m["zero"] >= 1.0 and m["arms"] > 80.0),
        ),
    ),
    lab.Number(
        "Now it asks for the angular momentum that the swing has by itself. How much of that turn is left?",
        "left",
        0,
        150,
    ),
    lab.Play("Watch the hips, and the momentum in the plots.", "zero", ("angular goal", "momenta")),
    lab.Compare(
        "With a goal of zero the pelvis turned by {zero}; with the swing's own by {reference}, {left} of it; with no "
        "goal for the angular momentum at all by {partial}. The angular momentum grew to {spin_zero} and {spin}.",
        ("zero", "reference", "partial", "left"),
    ),
    lab.Explain(
        "What the arms have, the rest takes back, moment by moment: that is all that zero can mean. The swing's own "
        "angular momentum, that of the same motion by kinematics alone, leaves the rest in peace.",
        "zero",
        2.25,
        lab.Equation(
            "k = k_arms + k_rest",
            {
                "k": lab.Symbol(
                    lambda s: shares(s)[:, 2], "N m s", "of the body, about the arms' axis", ".2f"
                ),
                "k_arms": lab.Symbol(lambda s: shares(s)[:, 0], "N m s", "of the swinging joints", ".2f"),
                "k_rest": lab.Symbol(lambda s: shares(s)[:, 1], "N m s", "of everything else", ".2f"),
            },
            within=1e-6,
            unit="N m s",
        ),
    ),
    lab.Prose(
        "Standing still, zero is right. For a motion with a momentum of its own, zero is a task too many: give its "
        "own as the goal, or let it go."
    ),
)

CLAIMS = (
    lab.Stands("zero"),
    lab.Stands("reference"),
    lab.Stands("partial"),
    lab.Bound("the arms swing", "arms", low=80.0),
    lab.Bound("with a goal of zero the body turns", "zero", low=2.0),
    lab.Bound("with the swing's own goal it turns less", "left", high=50.0),
    lab.Bound("with no goal it hardly turns", "left_partial", high=25.0),
)
