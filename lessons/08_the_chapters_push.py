"""The chapter's push

A robot in a textbook stood a push by turning its body. When do the feet of yours stop being enough?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.measured import com_moved, push_end, rate_gap, saturated, times
from momentum_lab.lesson import quantities as q

HALF = (lab.Push(velocity_change=0.12, duration=0.1, start=0.2),)
RUNS = {"push": lab.Run("fig8"), "half": lab.Run("fig8", {"pushes": HALF})}
END = 0.3  # of the push, s


def outside(session):
    """How long the desired CoP lies beyond the feet, ms."""
    return 1e3 * saturated(session).sum() * session.scenario.timestep


def reach(session, name):
    """How far ahead of its place a CoP goes, mm."""
    point = session.recording.column(name)[:, 0]
    return 1e3 * (point.max() - point[0])


def enough(runs):
    """The part of the chapter's push that asks for a CoP just at the edge, by proportion, %."""
    part = runs["half"].pushes[0].impulse / runs["push"].pushes[0].impulse
    return 100.0 * part * reach(runs["push"], "cop_admissible") / reach(runs["half"], "cop_desired")


def spin(session):
    """Angular momentum about y after the push where it is largest, with its sign, N m s."""
    values = session.recording.column("momentum")[times(session) > push_end(session), 4]
    return values[np.abs(values).argmax()]


MEASURES = {
    "push": lab.of("push", q.push_force, "N"),
    "half": lab.of("half", q.push_force, "N"),
    "lasts": lab.of("push", lambda s: 1e3 * s.pushes[0].duration, "ms"),
    "mass": lab.of("push", lambda s: s.robot.mass, "kg", ".1f"),
    "speed": lab.of("push", lambda s: s.pushes[0].impulse / s.robot.mass, "m/s", ".2f"),
    "enough": lab.Measure(enough, "%"),
    "outside": lab.of("push", outside, "ms"),
    "half_outside": lab.of("half", outside, "ms"),
    "twice": lab.Measure(
        lambda runs: reach(runs["push"], "cop_desired") / reach(runs["half"], "cop_desired"), "times", ".2f"
    ),
    "braking": lab.of("push", lambda s: np.abs(rate_gap(s)[:, :2]).max(), "N", ".2f"),
    "turning": lab.at("push", END, lambda s: np.abs(rate_gap(s)[:, 4]), "N m", ".1f"),
    "spin": lab.of("push", spin, "N m s", ".2f"),
    "way": lab.of("push", lambda s: 1e3 * com_moved(s)[:, 0].max(), "mm"),
    "end": lab.of("push", lambda s: 1e3 * com_moved(s)[-1, 0], "mm", ".1f"),
}

STEPS = (
    lab.Prose(
        "The chapter pushes a robot of its own to {speed} within {lasts}. Yours weighs {mass}: for the same "
        "speed it takes {push}."
    ),
    lab.Number(
        "Up to which part of this push can the feet do it alone, with no need to turn the body?",
        "enough",
        0,
        100,
    ),
    lab.Play(
        "Beside it, half the push. The hollow square is the CoP that a robot wants, the diamond the one it has. "
        "Then find the smallest push that parts them, on your robot or on another.",
        "push",
        ("push", "robot"),
        beside="half",
        view="Feet",
    ),
    lab.Compare(
        "Half the push never asked for more than the feet have. The whole push asked {twice} as far ahead, for "
        "{outside} beyond the feet. In proportion, with brakes as hard as this, the feet are enough for {enough}.",
        ("enough", "outside"),
    ),
    lab.Explain(
        "What the feet cannot give becomes turning: the missing part of the CoP, times the force. Here it is "
        "{turning}, and bends the body forward. Braking is kept, and so the CoM came back: it went {way}.",
        "push",
        END,
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
        view="Whole robot",
    ),
)

CLAIMS = (
    lab.Stands("push"),
    lab.Stands("half", "after half the push the robot"),
    lab.Bound("the robot asks for more than its feet can give", "outside", low=50.0),
    lab.Bound("after half the push it does not", "half_outside", high=0.0),
    lab.Bound("twice the push asks for twice as much", "twice", low=1.8, high=2.2),
    lab.Bound("the feet are enough for more than half", "enough", low=51.0, high=95.0),
    lab.Bound("braking is kept", "braking", high=1.0),
    lab.Bound("turning gives way", "turning", low=5.0),
    lab.Bound("the body turns with the push", "spin", low=0.2),
    lab.Bound("the CoM comes back", "end", low=-5.0, high=5.0),
)
