"""The chapter's push

A push that a textbook robot survived, scaled to yours: how long does it ask for more than its feet can give?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.measured import com_moved, push_end, rate_gap, saturated, times
from momentum_lab.lesson import quantities as q

RUNS = {"push": lab.Run("fig8")}


def time_outside(session):
    """How long the desired CoP lies beyond the feet, s."""
    return float(saturated(session).sum()) * session.scenario.timestep


def kept_braking(runs):
    """The largest part of the desired braking that was given up, N."""
    return float(np.abs(rate_gap(runs["push"])[:, :2]).max())


def spin(runs):
    """Angular momentum about y after the push where it is largest, with its sign, N m s."""
    session = runs["push"]
    values = session.recording.column("momentum")[times(session) > push_end(session), 4]
    return float(values[np.abs(values).argmax()])


def quiet(runs):
    """Ticks outside before the push and in the last half second."""
    session = runs["push"]
    clock = times(session)
    still = (clock < session.pushes[0].start) | (clock > session.scenario.seconds - 0.5)
    return float(saturated(session)[still].sum())


MEASURES = {
    "push": lab.Measure(lambda runs: runs["push"].pushes[0].force, "N"),
    "lasts": lab.Measure(lambda runs: 1e3 * runs["push"].pushes[0].duration, "ms"),
    "mass": lab.Measure(lambda runs: runs["push"].robot.mass, "kg", ".1f"),
    "kick": lab.Measure(lambda runs: runs["push"].pushes[0].impulse / runs["push"].robot.mass, "m/s", ".2f"),
    "outside": lab.Measure(lambda runs: 1e3 * time_outside(runs["push"]), "ms"),
    "quiet": lab.Measure(quiet, "ticks"),
    "braking": lab.Measure(kept_braking, "N", ".2f"),
    "turning": lab.Measure(lambda runs: float(np.abs(rate_gap(runs["push"])[:, 4]).max()), "N m", ".1f"),
    "spin": lab.Measure(spin, "N m s", ".2f"),
    "way": lab.Measure(lambda runs: 1e3 * float(com_moved(runs["push"])[:, 0].max()), "mm"),
}

STEPS = (
    lab.Prose(
        "The chapter's robot is another one, so its push is scaled: {push} for {lasts} on {mass}, which gives the "
        "CoM {kick}, whatever the mass."
    ),
    lab.Number("For how long in all does the robot want a CoP beyond its feet?", "outside", 0, 1000),
    lab.Choice(
        "Meanwhile, which way does the body turn?",
        (
            lab.Option("It bends forward, with the push", lambda m: m["spin"] > 0.0),
            lab.Option("It leans back, against the push", lambda m: m["spin"] < 0.0),
        ),
    ),
    lab.Play(
        "Push, pause, step. Compare the desired CoP with the one that is granted.", "push", ("push", "robot")
    ),
    lab.Compare(
        "For {outside} it asked for too much; before the push and at the end on {quiet}. The CoM moved {way} and "
        "came back.",
        ("outside", "way", "spin"),
    ),
    lab.Explain(
        "What the feet cannot give becomes rotation. Braking was kept to within {braking}; turning gave way by "
        "{turning}: exactly the missing part of the CoP times the force.",
        "push",
        0.3,
        lab.Equation(
            "dk_a = dk_d + f_z * (p_d - p_a)",
            {
                "dk_a": q.TURNING_GRANTED,
                "dk_d": q.TURNING_WANTED,
                "f_z": q.FORCE_GRANTED_Z,
                "p_d": q.COP_WANTED_X,
                "p_a": q.COP_GRANTED_X,
            },
            within=0.1,
            unit="N m",
            share=0.99,
        ),
    ),
)

CLAIMS = (
    lab.Stands("push"),
    lab.Bound("the robot asks for more than its feet can give", "outside", low=50.0),
    lab.Bound("but neither before the push nor at the end", "quiet", high=0.0),
    lab.Bound("braking is kept", "braking", high=1.0),
    lab.Bound("turning gives way", "turning", low=5.0),
    lab.Bound("the body turns with the push", "spin", low=0.2),
)
