"""A larger push

Balance asks for a CoP in front of the toes, where there is no foot. Something has to give: which choice stands?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.measured import com_moved, rate_gap, saturated, times, upright
from momentum_lab.lesson import quantities as q

RUNS = {
    "bend": lab.Run("fig7", {"priority": 0.0, "seconds": 1.8}),
    "upright": lab.Run("fig7", {"priority": 1.0}),
}
EARLY = 0.2  # of the time after the push began: before anything is decided, s


def asked_beyond(runs):
    """How far in front of what the ground can give the desired CoP is, mm."""
    column = runs["bend"].recording.column
    return 1e3 * float((column("cop_desired") - column("cop_admissible"))[:, 0].max())


def missing(runs, label, row):
    """How much of a desired momentum rate is given up early on, N or N m."""
    session = runs[label]
    early = times(session) < session.pushes[0].start + EARLY
    return float(np.abs(rate_gap(session)[early, row]).max())


def way(runs, label):
    session = runs[label]
    return 1e3 * float(com_moved(session)[upright(session), 0].max())


def fate(runs, label):
    fall = runs[label].fall
    return "stands" if fall is None else f"falls after {fall.time:.1f} s"


def first_outside(session):
    return float(times(session)[saturated(session).argmax()])


MEASURES = {
    "push": lab.Measure(lambda runs: runs["bend"].pushes[0].force, "N"),
    "asked": lab.Measure(asked_beyond, "mm"),
    "bend": lab.Measure(lambda runs: fate(runs, "bend")),
    "upright": lab.Measure(lambda runs: fate(runs, "upright")),
    "bend_turns": lab.Measure(lambda runs: missing(runs, "bend", 4), "N m"),
    "bend_brakes": lab.Measure(lambda runs: missing(runs, "bend", 0), "N", ".1f"),
    "upright_turns": lab.Measure(lambda runs: missing(runs, "upright", 4), "N m", ".1f"),
    "upright_brakes": lab.Measure(lambda runs: missing(runs, "upright", 0), "N"),
    "bend_way": lab.Measure(lambda runs: way(runs, "bend"), "mm"),
    "upright_way": lab.Measure(lambda runs: way(runs, "upright"), "mm"),
}

STEPS = (
    lab.Prose(
        "A push of {push} from behind. To brake as it wants, the robot needs a CoP {asked} in front of where the "
        "feet end. The CoP stops there. Two robots choose differently. One keeps braking its CoM, and lets the "
        "body bend forward. The other keeps its body from turning, and brakes less."
    ),
    lab.Choice(
        "Same push, same feet. Who is standing in the end?",
        (
            lab.Option("Both", lambda m: m["bend"] == "stands" == m["upright"]),
            lab.Option("Only the one that stays upright", lambda m: m["bend"] != "stands" == m["upright"]),
            lab.Option("Only the one that bends", lambda m: m["upright"] != "stands" == m["bend"]),
            lab.Option("Neither", lambda m: "stands" not in (m["bend"], m["upright"])),
        ),
    ),
    lab.Play("Push both. Then move the priority.", "bend", ("push", "priority"), beside="upright"),
    lab.Compare(
        "The robot that bends {bend}; the one that stays upright {upright}. Their CoMs went {bend_way} and "
        "{upright_way}.",
        ("bend", "upright", "bend_way", "upright_way"),
    ),
    lab.Explain(
        "Eq. 21 ties the CoP to both momentum rates. With the CoP stuck, one rate fixes the other. The robot that "
        "bends gave up {bend_turns} of turning and {bend_brakes} of braking; the other {upright_turns} and "
        "{upright_brakes}. Where the CoM goes decides about the fall, and only braking stops the CoM.",
        "bend",
        0.3,
        lab.Equation(
            "p_x = r_x - (r_z * dl_x + dk_y) / f_z",
            {
                "p_x": q.COP_GRANTED_X,
                "r_x": q.COM_X,
                "r_z": q.COM_Z,
                "dl_x": q.BRAKING_GRANTED,
                "dk_y": q.TURNING_GRANTED,
                "f_z": q.FORCE_GRANTED_Z,
            },
            within=1e-3,
            unit="m",
            share=0.99,
        ),
    ),
    lab.Prose("Priority 0 bends, priority 1 stays upright, and between them is every mixture."),
)

CLAIMS = (
    lab.Bound("the push asks for a CoP beyond the feet", "asked", low=5.0),
    lab.Stands("bend", "the robot that bends"),
    lab.Falls("upright", "the robot that stays upright"),
    lab.Bound("the one that bends keeps braking", "bend_brakes", high=1.0),
    lab.Bound("and gives up turning", "bend_turns", low=5.0),
    lab.Bound("the other keeps its body from turning", "upright_turns", high=1.0),
    lab.Bound("and gives up braking", "upright_brakes", low=10.0),
)
