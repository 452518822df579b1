"""The chapter's push

A robot in a textbook was pushed, and stood by turning its body. The same push, scaled to yours: which way?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.measured import com_moved, push_end, rate_gap, saturated, times
from momentum_lab.lesson import quantities as q

RUNS = {"push": lab.Run("fig8")}


def outside(session):
    """How long the desired CoP lies beyond the feet, ms."""
    return 1e3 * saturated(session).sum() * session.scenario.timestep


def spin(session):
    """Angular momentum about y after the push where it is largest, with its sign, N m s."""
    values = session.recording.column("momentum")[times(session) > push_end(session), 4]
    return values[np.abs(values).argmax()]


def quiet(session):
    """The same before the push and in the last half second, ms."""
    clock = times(session)
    still = (clock < session.pushes[0].start) | (clock > session.scenario.seconds - 0.5)
    return 1e3 * saturated(session)[still].sum() * session.scenario.timestep


MEASURES = {
    "push": lab.of("push", q.push_force, "N"),
    "lasts": lab.of("push", lambda s: 1e3 * s.pushes[0].duration, "ms"),
    "mass": lab.of("push", lambda s: s.robot.mass, "kg", ".1f"),
    "speed": lab.of("push", lambda s: s.pushes[0].impulse / s.robot.mass, "m/s", ".2f"),
    "outside": lab.of("push", outside, "ms"),
    "quiet": lab.of("push", quiet, "ms"),
    "braking": lab.of("push", lambda s: np.abs(rate_gap(s)[:, :2]).max(), "N", ".2f"),
    "turning": lab.of("push", lambda s: np.abs(rate_gap(s)[:, 4]).max(), "N m", ".1f"),
    "spin": lab.of("push", spin, "N m s", ".2f"),
    "way": lab.of("push", lambda s: 1e3 * com_moved(s)[:, 0].max(), "mm"),
}

STEPS = (
    lab.Prose(
        "The chapter pushes a robot of its own. Yours weighs {mass}; to give its CoM the same {speed} within "
        "{lasts}, the push is {push}."
    ),
    lab.Choice(
        "The push comes from behind. Which way does the body turn while the robot brakes?",
        (
            lab.Option("It leans back, against the push", lambda m: m["spin"] < -0.1),
            lab.Option("Hardly at all", lambda m: abs(m["spin"]) <= 0.1),
            lab.Option("It bends forward, with the push", lambda m: m["spin"] > 0.1),
        ),
    ),
    lab.Number("For how long in all does the robot want a CoP beyond its feet?", "outside", 0, 1000),
    lab.Play(
        "Slow it down. The hollow square is the CoP that it wants, the diamond the one it has. Then the other robot.",
        "push",
        ("push", "robot"),
    ),
    lab.Compare(
        "It bent forward. For {outside} it wanted more than its feet have; before the push and at the end for "
        "{quiet}. The CoM moved {way} and came back.",
        ("outside", "way", "spin"),
    ),
    lab.Explain(
        "What the feet cannot give becomes turning. Braking was kept to within {braking}. Turning gave way by "
        "up to {turning}: the part of the CoP that is missing, times the force.",
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
