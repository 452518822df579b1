"""A larger push

Balance asks for a CoP in front of the toes, where there is no foot. Something has to give: which choice stands?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.measured import com_moved, rate_gap, times, upright
from momentum_lab.lesson import quantities as q

RUNS = {
    "bend": lab.Run("fig7", {"priority": 0.0, "seconds": 1.8}),
    "upright": lab.Run("fig7", {"priority": 1.0}),
}
EARLY = 0.2  # of the time after the push began: before anything is decided, s


def asked_beyond(session):
    """How far in front of what the ground can give the desired CoP is, mm."""
    column = session.recording.column
    return 1e3 * (column("cop_desired") - column("cop_admissible"))[:, 0].max()


def missing(row):
    """How much of a desired momentum rate a robot gives up early on, N or N m."""
    return lambda s: np.abs(rate_gap(s)[times(s) < s.pushes[0].start + EARLY, row]).max()


def way(session):
    """How far the CoM goes before a fall, mm."""
    return 1e3 * com_moved(session)[upright(session), 0].max()


MEASURES = {
    "push": lab.of("bend", q.push_force, "N"),
    "asked": lab.of("bend", asked_beyond, "mm"),
    "bend": lab.fate("bend"),
    "upright": lab.fate("upright"),
    "bend_turns": lab.of("bend", missing(4), "N m"),
    "bend_brakes": lab.of("bend", missing(0), "N", ".1f"),
    "upright_turns": lab.of("upright", missing(4), "N m", ".1f"),
    "upright_brakes": lab.of("upright", missing(0), "N"),
    "bend_way": lab.of("bend", way, "mm"),
    "upright_way": lab.of("upright", way, "mm"),
}

STEPS = (
    lab.Prose(
        "Two robots get a push of {push} from behind. To brake as they want, they would need a CoP {asked} in "
        "front of where the feet end. It cannot go there. One robot keeps braking its CoM, and lets its body "
        "bend forward. The other keeps its body from turning, and brakes less."
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
    lab.Play(
        "Watch the trunks, then the feet. The priority you can move is that of the first robot.",
        "bend",
        ("push", "priority"),
        beside="upright",
    ),
    lab.Compare(
        "The robot that bends {bend}; the one that stays upright {upright}. Their CoMs went {bend_way} and "
        "{upright_way}.",
        ("bend", "upright", "bend_way", "upright_way"),
    ),
    lab.Explain(
        "The CoP holds braking and turning together (Eq. 21): with the CoP stuck at the toes, more of one is "
        "less of the other. Who bends gave up {bend_turns} of its turning goal and {bend_brakes} of braking; "
        "who stays upright {upright_turns} and {upright_brakes}. Only braking stops the CoM.",
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
    lab.Prose(
        "So that is why the trunk rotates: the feet end, and turning is what lets the ground push the CoM back "
        "harder than the toes alone allow. Priority 0 bends, priority 1 stays upright; between them is every "
        "mixture."
    ),
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
