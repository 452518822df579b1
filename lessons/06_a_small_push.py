"""A small push

Pulled back like a spring and braked like a damper, a robot returns to its place. How hard should it brake?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.measured import com_moved, push_end, saturated, times
from momentum_lab.lesson import quantities as q

STIFFNESS = 60.0
PUSH = lab.Push(velocity_change=0.03, duration=0.1, start=0.2)


def small_push(zeta):
    """Gamma_21 = 2 zeta sqrt(Gamma_22)."""
    gains = {"linear_stiffness": STIFFNESS, "linear_damping": 2.0 * zeta * STIFFNESS**0.5}
    return lab.Run("stand", {"seconds": 2.1, "pushes": (PUSH,), "gains": gains})


RUNS = {"loose": small_push(0.2), "even": small_push(1.0), "tight": small_push(2.5)}


def ratio(session):
    """The damping ratio zeta."""
    return session.choices.gains.linear_damping / (2.0 * session.choices.gains.linear_stiffness**0.5)


def way(session):
    """Way of the CoM, forward, mm."""
    return 1e3 * com_moved(session)[:, 0]


def back(session):
    """How long after the push the CoM is back for good, within a tenth of its farthest, s."""
    moved = np.abs(way(session))
    return times(session)[np.flatnonzero(moved > 0.1 * moved.max())[-1]] - push_end(session)


def overshoot(session):
    """How far it swings to the other side, as part of its farthest, %."""
    moved = way(session)
    return 100.0 * max(0.0, -moved.min()) / moved.max()


MEASURES = {
    "push": lab.of("even", q.push_force, "N"),
    "way": lab.of("loose", lambda s: way(s).max(), "mm", ".1f"),
    "outside": lab.Measure(lambda runs: sum(saturated(run).sum() for run in runs.values()), "ticks"),
    "loose": lab.of("loose", back, "s", ".2f"),
    "even": lab.of("even", back, "s", ".2f"),
    "tight": lab.of("tight", back, "s", ".2f"),
    "lead": lab.Measure(lambda runs: min(back(runs["loose"]), back(runs["tight"])) - back(runs["even"]), "s"),
    "swing": lab.of("loose", overshoot, "%"),
    "no_swing": lab.of("even", overshoot, "%", ".1f"),
    "ratios": lab.Measure(lambda runs: "{:.1f}, {:.1f} and {:.1f}".format(*map(ratio, runs.values()))),
}

STEPS = (
    lab.Prose(
        "A push of {push} moves the CoM by only {way}: a CoP within the feet can undo it. The controller makes "
        "the robot a spring that pulls the CoM back, and a damper that brakes it."
    ),
    lab.Choice(
        "Three robots have the same spring. Loose brakes little, even more, tight most: damping ratios {ratios}. "
        "Whose CoM is back first, for good?",
        (
            lab.Option(
                "The loose one: nothing holds it up", lambda m: m["loose"] < min(m["even"], m["tight"])
            ),
            lab.Option("The even one, in the middle", lambda m: m["even"] < min(m["loose"], m["tight"])),
            lab.Option("The tight one: it brakes hardest", lambda m: m["tight"] < min(m["loose"], m["even"])),
        ),
    ),
    lab.Number("How far does the loose one swing past its place, as part of its farthest?", "swing", 0, 100),
    lab.Play(
        "The motion is small: watch the CoM in the plot.",
        "loose",
        ("push", "linear_damping", "linear_stiffness"),
        beside="even",
    ),
    lab.Compare(
        "Back for good after {loose}, {even} and {tight}. The loose one swings past by {swing}, the even one by "
        "{no_swing}; the tight one creeps.",
        ("loose", "even", "tight", "swing"),
    ),
    lab.Explain(
        "The CoM of a body with dozens of joints really moves like one spring, Gamma_22, with one damper, "
        "Gamma_21 (Eq. 38). The sliders set both. The damping ratio is Gamma_21 over twice the root of Gamma_22.",
        "loose",
        0.5,
        lab.Equation(
            "ddr_x = Gamma_22 * (r_d - r_x) - Gamma_21 * dr_x",
            {
                "ddr_x": lab.Symbol(
                    lambda s: q.FORCE_X.values(s) / s.robot.mass, "m/s^2", "by the forces", ".3f"
                ),
                "Gamma_22": lab.Symbol(lambda s: s.choices.gains.linear_stiffness, "1/s^2", "spring"),
                "Gamma_21": lab.Symbol(lambda s: s.choices.gains.linear_damping, "1/s", "damper", ".1f"),
                "r_d": lab.Symbol(
                    lambda s: q.COM_X.values(s)[0], "m", "where it stood before the push", ".4f"
                ),
                "r_x": q.COM_X,
                "dr_x": q.COM_SPEED_X,
            },
            within=0.01,
            unit="m/s^2",
            share=0.99,
            since=0.31,
        ),
    ),
)

CLAIMS = (
    *(lab.Stands(label, f"the {label} robot") for label in RUNS),
    lab.Bound("the feet can give all that is wanted", "outside", high=0.0),
    # A spring with a damper, kicked from rest, swings back by exp(-pi zeta / sqrt(1 - zeta^2)).
    lab.Bound("the loose one swings back as far as a spring and damper do", "swing", low=49.7, high=55.7),
    lab.Bound("the one in the middle is back first", "lead", low=0.5),
    lab.Bound("critically damped it does not swing", "no_swing", high=2.0),
)
