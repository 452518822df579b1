"""One number for the whole body

Dozens of joints move at once. How much of all that motion can the ground feel?
"""

from functools import lru_cache

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.measured import push_end, times
from momentum_lab.lesson import quantities as q
from momentum_lab.lesson import spins
from momentum_lab.momentum.centroidal import link_by_link
from momentum_lab.robot.state import State

RUNS = {"push": lab.Run("fig8", {"seconds": 0.35})}


@lru_cache(1)
def of_links(session):
    """Angular momentum of every link about the CoM, about y (n, links), N m s (Eq. 12)."""
    column = session.recording.column
    states = [State(q, v) for q, v in zip(column("q"), column("v"), strict=True)]
    return np.array([link_by_link(session.robot, state).momenta_about_com[:, 4] for state in states])


def at_the_end(session):
    """The angular momentum of every link at the end of the push (links,), N m s."""
    return of_links(session)[np.searchsorted(times(session), push_end(session))]


def cancelled(session):
    """The part of the links' angular momenta that cancels, %."""
    spin = at_the_end(session)
    return 100.0 * (1.0 - abs(spin.sum()) / np.abs(spin).sum())


def felt(session):
    """How many independent numbers all speeds amount to for the ground."""
    return np.linalg.matrix_rank(session.dynamics.centroidal_map)


MEASURES = {
    "push": lab.of("push", q.push_force, "N"),
    "joints": lab.of("push", lambda s: s.robot.na, "joints"),
    "speeds": lab.of("push", lambda s: s.robot.nv, "speeds"),
    "felt": lab.of("push", felt, "numbers"),
    "unfelt": lab.of("push", lambda s: s.robot.nv - felt(s), "ways"),
    "forward": lab.of("push", lambda s: np.maximum(at_the_end(s), 0).sum(), "N m s", ".2f"),
    "backward": lab.of("push", lambda s: -np.minimum(at_the_end(s), 0).sum(), "N m s", ".2f"),
    "cancelled": lab.of("push", cancelled, "%"),
}

STEPS = (
    lab.Prose(
        "The robot has {joints}, and its body can move and turn as a whole: {speeds} in all. A push of {push} "
        "moves every part of it differently."
    ),
    lab.Number(
        "Each part has an angular momentum of its own. As the push ends, some turn forward, some backward. How "
        "much of it cancels in the sum?",
        "cancelled",
        0,
        100,
    ),
    lab.Choice(
        "In how many independent ways can the {speeds} change without changing what the ground feels?",
        (
            lab.Option("None: whatever moves is felt", lambda m: m["unfelt"] == 0),
            lab.Option("About half of them", lambda m: 0 < m["unfelt"] <= 0.75 * m["speeds"]),
            lab.Option("Nearly all of them", lambda m: m["unfelt"] > 0.75 * m["speeds"]),
        ),
    ),
    lab.Play("It is short: play it slowly. Which parts turn forward, which back?", "push", ("push",)),
    lab.Compare(
        "Forward {forward}, backward {backward}: {cancelled} cancels. Of {speeds} the ground feels {felt}; "
        "{unfelt} to move it does not feel at all.",
        ("cancelled", "felt", "unfelt"),
    ),
    lab.Explain(
        "One matrix, A_G, adds the momenta of all parts (Eqs. 12, 16). Times the speeds it gives three numbers "
        "of linear and three of angular momentum. The ground answers to these alone: so a controller may think "
        "of six numbers first, and of joints later.",
        "push",
        0.3,
        lab.Equation(
            "k_y = k_forward + k_backward",
            {
                "k_y": lab.Symbol(
                    lambda s: spins.of_speeds(s)[:, 1].sum(1),
                    "N m s",
                    "of the body: a row of A_G times speeds",
                    ".3f",
                ),
                "k_forward": lab.Symbol(
                    lambda s: np.maximum(of_links(s), 0).sum(1), "N m s", "of parts turning forward", ".3f"
                ),
                "k_backward": lab.Symbol(
                    lambda s: np.minimum(of_links(s), 0).sum(1), "N m s", "of parts turning backward", ".3f"
                ),
            },
            within=1e-6,
            unit="N m s",
        ),
    ),
)

CLAIMS = (
    lab.Stands("push"),
    lab.Bound("parts turn both ways, and much cancels", "cancelled", low=30.0),
    lab.Bound("what is left is six numbers", "felt", low=6.0, high=6.0),
)
