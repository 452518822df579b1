"""A larger push

Balance asks for a CoP in front of the toes, where there is no foot. Something has to give: which choice stands?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.measured import com_moved, rate_gap, upright
from momentum_lab.lesson import quantities as q

RUNS = {
    "bend": lab.Run("fig7", {"priority": 0.0, "seconds": 1.8}),
    "upright": lab.Run("fig7", {"priority": 1.0}),
}
END = 0.3  # of the push, s


def asked_beyond(session):
    """How far in front of what the ground can give the desired CoP is, mm."""
    column = session.recording.column
    return 1e3 * (column("cop_desired") - column("cop_admissible"))[:, 0].max()


def missing(row):
    """How much of a desired momentum rate a robot gives up (n,), N or N m."""
    return lambda s: np.abs(rate_gap(s)[:, row])


def way(session):
    """How far the CoM goes before a fall, mm."""
    return 1e3 * com_moved(session)[upright(session), 0].max()


MEASURES = {
    "push": lab.of("bend", q.push_force, "N"),
    "asked": lab.of("bend", asked_beyond, "mm"),
    "bend": lab.fate("bend"),
    "upright": lab.fate("upright"),
    "bend_turns": lab.at("bend", END, missing(4), "N m"),
    "bend_brakes": lab.at("bend", END, missing(0), "N", ".1f"),
    "upright_turns": lab.at("upright", END, missing(4), "N m", ".1f"),
    "upright_brakes": lab.at("upright", END, missing(0), "N"),
    "bend_way": lab.of("bend", way, "mm"),
    "bend_end": lab.of("bend", lambda s: 1e3 * com_moved(s)[-1, 0], "mm"),
}

STEPS = (
    lab.Prose(
        "Two robots get a push of {push} from behind. To stop their CoM and stay upright, they would need a CoP "
        "{asked} in front of what the feet can give. One brakes its CoM all the same, and its body "
        "bends. The other stays upright and brakes less."
    ),
    lab.Choice(
        "Same push, same feet. Which of the two falls?",
        (
            lab.Option("Neither", lambda m: m["bend"] == "stands" == m["upright"]),
            lab.Option(
                "The one that bends: it gives up its posture", lambda m: m["bend"] != "stands" == m["upright"]
            ),
            lab.Option(
                "The one that stays upright: it brakes less", lambda m: m["upright"] != "stands" == m["bend"]
            ),
            lab.Option("Both", lambda m: "stands" not in (m["bend"], m["upright"])),
        ),
    ),
    lab.Play(
        "Watch the trunks, then the feet. Your priority is that of the one that bends.",
        "bend",
        ("push", "priority"),
        beside="upright",
    ),
    lab.Compare(
        "The robot that bends {bend}; its CoM went {bend_way} and came back. The one that stays upright {upright}.",
        ("bend", "upright", "bend_way"),
    ),
    lab.Explain(
        "The CoP ties braking to turning (Eq. 21). With the CoP stuck at the toes, the ground brakes harder only "
        "if the body may turn. The bent one lets it turn with {bend_turns} more than it wants, and brakes as "
        "it wants. The upright one does not turn, and lacks {upright_brakes} of braking.",
        "bend",
        END,
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
        "So this is why the trunk rotates: the feet end, and only a body that turns lets the ground push the CoM "
        "back harder. Priority 0 bends, priority 1 stays upright, and between them is every mixture."
    ),
)

CLAIMS = (
    lab.Bound("the push asks for a CoP beyond the feet", "asked", low=5.0),
    lab.Stands("bend", "the robot that bends"),
    lab.Falls("upright", "the robot that stays upright"),
    lab.Bound("its CoM comes back", "bend_end", low=-10.0, high=10.0),
    lab.Bound("the one that bends keeps braking", "bend_brakes", high=1.0),
    lab.Bound("and gives up turning", "bend_turns", low=5.0),
    lab.Bound("the other keeps its body from turning", "upright_turns", high=1.0),
    lab.Bound("and gives up braking", "upright_brakes", low=10.0),
)
