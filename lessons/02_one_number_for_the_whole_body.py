"""One number for the whole body

Dozens of joints move at once. How much of all that motion can the ground feel?
"""

from functools import lru_cache

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.measured import motion_done, pelvis_turn
from momentum_lab.lesson import quantities as q
from momentum_lab.lesson import spins
from momentum_lab.momentum.centroidal import link_by_link
from momentum_lab.robot.state import State

RUNS = {
    "balanced": lab.Run("kick", {"seconds": 1.2}),
    "bare": lab.Run("kick", {"seconds": 1.2, "controlled": "linear"}),
}
KICK = 0.7  # the leg is on its way forward, s


@lru_cache(1)
def of_links(session):
    """Angular momentum of every link about the CoM, about y (n, links), N m s (Eq. 12)."""
    column = session.recording.column
    states = [State(q, v) for q, v in zip(column("q"), column("v"), strict=True)]
    return np.array([link_by_link(session.robot, state).momenta_about_com[:, 4] for state in states])


def wander(session):
    """How far the force of the ground wanders forward and back, mm."""
    return 1e3 * np.ptp(q.COP_X.values(session))


def cancelled(session):
    """The part of the links' angular momenta that cancels meanwhile, %."""
    spin = of_links(session)[round(KICK / session.scenario.timestep)]
    return 100.0 * (1.0 - abs(spin.sum()) / np.abs(spin).sum())


def trunk(session):
    """How far the trunk tips forward and back, degrees."""
    return np.degrees(np.ptp(pelvis_turn(session)[:, 1]))


def least_done(runs):
    """The least of what any joint does of its kick, %."""
    return 100.0 * min(motion_done(run).max(axis=0).min() for run in runs.values())


MEASURES = {
    "speeds": lab.of("balanced", lambda s: s.robot.nv, "speeds"),
    "felt": lab.of("balanced", lambda s: np.linalg.matrix_rank(s.dynamics.centroidal_map), "numbers"),
    "kick": lab.Measure(least_done, "%"),
    "balanced": lab.of("balanced", wander, "mm"),
    "bare": lab.of("bare", wander, "mm"),
    "times": lab.Measure(lambda runs: wander(runs["bare"]) / wander(runs["balanced"]), "times"),
    "trunk": lab.of("balanced", trunk, "degrees"),
    "bare_trunk": lab.of("bare", trunk, "degrees"),
    "cancelled": lab.of("balanced", cancelled, "%"),
}

STEPS = (
    lab.Prose(
        "Two robots stand on one leg and make the same kick. The balanced one swings its trunk and arms against "
        "the leg. The bare one only keeps its CoM, the centre of mass, in its place."
    ),
    lab.Choice(
        "More of the balanced one moves. Below which of them does the green arrow, the force of the ground, "
        "wander farther?",
        (
            lab.Option(
                "The balanced one: more motion, more to feel", lambda m: m["balanced"] > 2.0 * m["bare"]
            ),
            lab.Option("Both alike: it is the same kick", lambda m: 0.5 <= m["balanced"] / m["bare"] <= 2.0),
            lab.Option("The bare one", lambda m: m["bare"] > 2.0 * m["balanced"]),
        ),
    ),
    lab.Number(
        "The joints and the body of each robot have {speeds}. How many numbers tell all that the ground feels of "
        "them?",
        "felt",
        0,
        40,
    ),
    lab.Play("Watch where the green arrows stand.", "balanced", ("momenta",), beside="bare"),
    lab.Compare(
        "Below the balanced robot the arrow wandered by {balanced}, below the bare one by {bare}. The balanced one "
        "tips its trunk by {trunk} as well, and the ground feels less: its parts cancel each other.",
        ("balanced", "bare", "felt"),
    ),
    lab.Explain(
        "Each part of the body turns about the CoM: that is its angular momentum. Here {cancelled} of "
        "it cancels. One table of numbers, A_G, adds up all parts at once (Eqs. 12, 16). Speeds go in, and "
        "{felt} come out: three of linear, three of angular momentum. The ground feels no others, so a "
        "controller can think of these first, and of joints later.",
        "balanced",
        KICK,
        lab.Equation(
            "k_y = k_forward + k_back",
            {
                "k_y": lab.Symbol(
                    lambda s: spins.of_speeds(s)[:, 1].sum(1), "N m s", "of the body: a row of A_G", ".2f"
                ),
                "k_forward": lab.Symbol(
                    lambda s: np.maximum(of_links(s), 0).sum(1), "N m s", "of parts turning forward", ".2f"
                ),
                "k_back": lab.Symbol(
                    lambda s: np.minimum(of_links(s), 0).sum(1), "N m s", "of parts turning back", ".2f"
                ),
            },
            within=1e-6,
            unit="N m s",
        ),
    ),
)

CLAIMS = (
    lab.Stands("balanced", "the balanced robot"),
    lab.Stands("bare", "the bare robot"),
    lab.Bound("both kick", "kick", low=80.0),
    lab.Bound("the arrow of the bare one wanders several times as far", "times", low=4.0),
    lab.Bound("the balanced one moves its trunk", "trunk", low=8.0),
    lab.Bound("the bare one does not", "bare_trunk", high=2.0),
    lab.Bound("what parts turn forward and back cancels", "cancelled", low=90.0),
    lab.Bound("what is left is six numbers", "felt", low=6.0, high=6.0),
)
