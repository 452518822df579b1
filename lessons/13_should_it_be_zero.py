"""Should angular momentum be zero?

A balance controller asks for zero angular momentum. Now the arms are to swing. Is zero still a good wish?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.arm_swing import spin, turned
from momentum_lab.experiments.measured import motion_done
from momentum_lab.lesson import spins

SWUNG = 2.65  # the arms are fast, s
RUNS = {
    "zero": lab.Run("arm-swing", {"seconds": 3.0}),
    "its_own": lab.Run("arm-swing", {"seconds": 3.0, "angular_goal": "reference"}),
    "no_goal": lab.Run("arm-swing", {"seconds": 3.0, "controlled": "linear"}),
}


def least_done(runs):
    """The least of what every arm does of its swing, %."""
    return 100.0 * min(motion_done(run).max(axis=0).min() for run in runs.values())


def turn(session):
    """The largest turn of the pelvis, degrees."""
    return np.degrees(turned(session).max())


def left(label):
    """The turn of the pelvis as part of that with a goal of zero, %."""
    return lambda runs: 100.0 * float(turn(runs[label]) / turn(runs["zero"]))


def axis(session):
    """The axis about which the arms have most angular momentum."""
    return int(np.abs(spins.of_motion(session)).max(axis=0).argmax())


def about_it(part):
    """A part of the angular momentum about that axis (n,), N m s."""
    return lambda s: part(s)[:, axis(s)]


def against(session):
    """What the rest has against the arms then, as part of theirs, %."""
    tick = round(SWUNG / session.scenario.timestep)
    return -100.0 * about_it(spins.of_rest)(session)[tick] / about_it(spins.of_motion)(session)[tick]


MEASURES = {
    "arms": lab.Measure(least_done, "%"),
    "arms_have": lab.at("zero", SWUNG, lambda s: np.abs(about_it(spins.of_motion)(s)), "N m s", ".2f"),
    "rest": lab.at("zero", SWUNG, lambda s: np.abs(about_it(spins.of_rest)(s)), "N m s", ".2f"),
    "against": lab.of("zero", against, "%"),
    "zero": lab.of("zero", turn, "degrees", ".1f"),
    "its_own": lab.of("its_own", turn, "degrees", ".1f"),
    "no_goal": lab.of("no_goal", turn, "degrees", ".1f"),
    "left": lab.Measure(left("its_own"), "%"),
    "left_free": lab.Measure(left("no_goal"), "%"),
    "spin_zero": lab.of("zero", lambda s: spin(s).max(), "N m s", ".1f"),
    "spin": lab.of("its_own", lambda s: spin(s).max(), "N m s", ".1f"),
}

STEPS = (
    lab.Choice(
        "The arms swing, the feet stay, and the controller asks for zero angular momentum. What gives?",
        (
            lab.Option("Nothing: the arms cancel each other", lambda m: m["zero"] < 1.0 and m["arms"] > 80.0),
            lab.Option("The arms hardly swing", lambda m: m["arms"] <= 80.0),
            lab.Option("The body turns against the arms", lambda m: m["zero"] >= 1.0 and m["arms"] > 80.0),
        ),
    ),
    lab.Number(
        "A second robot is asked for the angular momentum that such a swing has by itself. What part of the "
        "first one's turn does it make?",
        "left",
        0,
        150,
    ),
    lab.Play(
        "Watch the trunks, not the arms.",
        "zero",
        ("angular goal", "momenta"),
        beside="its_own",
    ),
    lab.Compare(
        "Asked for zero, the body turned by {zero}. Asked for the swing's own, by {its_own}: {left} of it. A "
        "third, asked for nothing, turned by {no_goal}. The first never had more than {spin_zero}, the second "
        "up to {spin}.",
        ("zero", "its_own", "no_goal", "left"),
    ),
    lab.Explain(
        "The arms have angular momentum, whatever is asked. To make the sum zero, the rest of the body moves "
        "against them: here {rest} against {arms_have}. Asked for the swing's own, it need not.",
        "zero",
        SWUNG,
        lab.Equation(
            "k = k_arms + k_rest",
            {
                "k": lab.Symbol(
                    about_it(lambda s: s.recording.column("momentum")[:, 3:]), "N m s", "of the body", ".2f"
                ),
                "k_arms": lab.Symbol(about_it(spins.of_motion), "N m s", "of the swinging joints", ".2f"),
                "k_rest": lab.Symbol(about_it(spins.of_rest), "N m s", "of everything else", ".2f"),
            },
            within=1e-6,
            unit="N m s",
        ),
    ),
    lab.Prose(
        "For standing still, zero is right. A motion with angular momentum of its own wants just that as its "
        "goal, or none."
    ),
)

CLAIMS = (
    lab.Stands("zero"),
    lab.Stands("its_own"),
    lab.Stands("no_goal"),
    lab.Bound("the arms swing", "arms", low=80.0),
    lab.Bound("the rest moves against them", "against", low=80.0),
    lab.Bound("with a goal of zero the body turns", "zero", low=2.0),
    lab.Bound("with the swing's own goal it turns less", "left", high=50.0),
    lab.Bound("with no goal it hardly turns", "left_free", high=25.0),
)
