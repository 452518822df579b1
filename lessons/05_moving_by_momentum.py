"""Moving by momentum

Standing on one leg, a robot kicks with the other. Who pays for the kick, if the angular momentum must stay zero?
"""

from functools import lru_cache

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.measured import com_moved, motion_done, pelvis_turn
from momentum_lab.robot.state import State

RESOLVED = {"controller": "resolved-momentum", "seconds": 2.0}
RUNS = {
    "held": lab.Run("kick", RESOLVED),
    "free": lab.Run("kick", {**RESOLVED, "controlled": "linear+kz"}),
}


def pitch(session):
    """How far the pelvis swings forward and back, degrees."""
    turned = np.degrees(pelvis_turn(session)[:, 1])
    return float(turned.max() - turned.min())


def spin(session):
    """The largest angular momentum about y, N m s."""
    return float(np.abs(session.recording.column("momentum")[:, 4]).max())


@lru_cache(2)
def shares(session):
    """Angular momentum about y of the kicking joints, and of everything else (n, 2), N m s (Eq. 16)."""
    kicking = 6 + np.flatnonzero(session.motion_reach)
    column, found = session.recording.column, []
    for q, v in zip(column("q"), column("v"), strict=True):
        parts = session.robot.at(State(q, v)).centroidal_map[4] * v
        found.append((parts[kicking].sum(), parts.sum() - parts[kicking].sum()))
    return np.array(found)


def paid(session):
    """The part of the leg's largest angular momentum that the rest takes back in that moment, %."""
    leg, rest = shares(session).T
    tick = int(np.abs(leg).argmax())
    return 100.0 * float(-rest[tick] / leg[tick])


MEASURES = {
    "kick": lab.Measure(
        lambda runs: 100.0 * min(float(motion_done(run)[:, 0].max()) for run in runs.values()), "%"
    ),
    "com": lab.Measure(
        lambda runs: 1e3 * max(float(np.abs(com_moved(run)).max()) for run in runs.values()), "mm"
    ),
    "leg": lab.Measure(lambda runs: float(np.abs(shares(runs["held"])[:, 0]).max()), "N m s", ".1f"),
    "paid": lab.Measure(lambda runs: paid(runs["held"]), "%"),
    "paid_free": lab.Measure(lambda runs: paid(runs["free"]), "%"),
    "held": lab.Measure(lambda runs: pitch(runs["held"]), "degrees", ".1f"),
    "free": lab.Measure(lambda runs: pitch(runs["free"]), "degrees", ".1f"),
    "spin_held": lab.Measure(lambda runs: spin(runs["held"]), "N m s", ".1f"),
    "spin_free": lab.Measure(lambda runs: spin(runs["free"]), "N m s", ".1f"),
}

STEPS = (
    lab.Prose(
        "This controller is asked for six numbers, the momentum of the whole body, and finds the joints' speeds "
        "that give it (Eq. 25). The hip kicks; all other joints are its own affair."
    ),
    lab.Number(
        "Angular momentum is to stay zero. When the leg has most of it, how much does the rest take back?",
        "paid",
        0,
        150,
    ),
    lab.Choice(
        "Once all six numbers are held, once two of them are let go: how the body tips forward and sideways. When "
        "does the pelvis swing more?",
        (
            lab.Option("With all six held", lambda m: m["held"] > 1.2 * m["free"]),
            lab.Option("With two let go", lambda m: m["free"] > 1.2 * m["held"]),
            lab.Option(
                "Much the same", lambda m: max(m["held"], m["free"]) <= 1.2 * min(m["held"], m["free"])
            ),
        ),
    ),
    lab.Play("Look at the upper body, not at the leg.", "held", ("momenta",), beside="free"),
    lab.Compare(
        "The leg had {leg}; the rest took {paid} of it back, {paid_free} when it was free to. Held, the pelvis swung "
        "by {held}, free by {free}; the angular momentum reached {spin_held} and {spin_free}.",
        ("paid", "held", "free", "spin_held", "spin_free"),
    ),
    lab.Explain(
        "Leg and rest add up to what the ground feels (Eq. 16). Hold the sum at zero, and the rest has to mirror the "
        "leg. Let it go, and the ground has to turn the body, and turn it back.",
        "held",
        0.68,
        lab.Equation(
            "k_y = k_leg + k_rest",
            {
                "k_y": lab.Symbol(
                    lambda s: s.recording.column("momentum")[:, 4], "N m s", "of the whole body", ".2f"
                ),
                "k_leg": lab.Symbol(lambda s: shares(s)[:, 0], "N m s", "of the kicking joints", ".2f"),
                "k_rest": lab.Symbol(lambda s: shares(s)[:, 1], "N m s", "of everything else", ".2f"),
            },
            within=1e-6,
            unit="N m s",
        ),
    ),
)

CLAIMS = (
    lab.Stands("held", "the robot that holds all six"),
    lab.Stands("free", "the robot that lets two go"),
    lab.Bound("both kick", "kick", low=70.0),
    lab.Bound("both keep their CoM", "com", high=20.0),
    lab.Bound("held, the rest pays for the leg", "paid", low=50.0),
    lab.Bound("held, there is less angular momentum", "spin_held", high=2.5),
)
