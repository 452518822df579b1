"""One number for the whole body

Dozens of joints move at once. How much of all that motion can the ground feel?
"""

from functools import lru_cache

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.measured import push_end, times
from momentum_lab.momentum.centroidal import link_by_link
from momentum_lab.robot.state import State

RUNS = {"push": lab.Run("fig8", {"seconds": 0.35})}


def states(session):
    column = session.recording.column
    return [State(q, v) for q, v in zip(column("q"), column("v"), strict=True)]


@lru_cache(1)
def of_links(session):
    """Angular momentum of every link about the CoM, about y (n, links), N m s (Eq. 12)."""
    return np.array([link_by_link(session.robot, s).momenta_about_com[:, 4] for s in states(session)])


def at_the_end(session):
    """The spin of every link at the end of the push (links,), N m s."""
    tick = int(np.searchsorted(times(session), push_end(session)))
    return link_by_link(session.robot, states(session)[tick]).momenta_about_com[:, 4]


def cancelled(runs):
    """The part of the links' spins that cancels, %."""
    spins = at_the_end(runs["push"])
    return 100.0 * float(1.0 - abs(spins.sum()) / np.abs(spins).sum())


def mapped(session):
    """The same in one product, (A_G v)_y (n,), N m s (Eq. 16)."""
    return np.array([session.robot.at(s).centroidal_map[4] @ s.v for s in states(session)])


MEASURES = {
    "joints": lab.Measure(lambda runs: runs["push"].robot.na, "joints"),
    "speeds": lab.Measure(lambda runs: runs["push"].robot.nv, "numbers"),
    "rows": lab.Measure(lambda runs: np.linalg.matrix_rank(runs["push"].dynamics.centroidal_map), "numbers"),
    "unfelt": lab.Measure(
        lambda runs: runs["push"].robot.nv - np.linalg.matrix_rank(runs["push"].dynamics.centroidal_map),
        "ways",
    ),
    "forward": lab.Measure(lambda runs: float(np.maximum(at_the_end(runs["push"]), 0).sum()), "N m s", ".2f"),
    "backward": lab.Measure(
        lambda runs: float(np.minimum(at_the_end(runs["push"]), 0).sum()), "N m s", ".2f"
    ),
    "cancelled": lab.Measure(cancelled, "%"),
}

STEPS = (
    lab.Prose(
        "The robot has {joints}; with the place and direction of its body that makes {speeds} for its speeds. Each "
        "of its links moves and turns on its own."
    ),
    lab.Number(
        "As a push ends, some links turn forward, some backward. How much cancels?", "cancelled", 0, 100
    ),
    lab.Choice(
        "In how many independent ways can the speeds change without the ground feeling anything?",
        (
            lab.Option("None: whatever moves is felt", lambda m: m["unfelt"] == 0),
            lab.Option("About half of them", lambda m: 0 < m["unfelt"] <= 0.75 * m["speeds"]),
            lab.Option("Nearly all of them", lambda m: m["unfelt"] > 0.75 * m["speeds"]),
        ),
    ),
    lab.Play(
        "Push, stop early, and compare the links with the one arrow of the whole body.", "push", ("push",)
    ),
    lab.Compare(
        "The links' spins are {forward} forward and {backward} backward: {cancelled} cancels. What is left of all "
        "speeds is {rows}, and {unfelt} of moving are not felt.",
        ("cancelled", "rows", "unfelt"),
    ),
    lab.Explain(
        "All links' momenta, moved to the CoM and added, are one product: the matrix A_G times the speeds (Eqs. 12, "
        "16). Only this sum answers to the ground. That is why a controller may think of six numbers first, and of "
        "joints later.",
        "push",
        0.3,
        lab.Equation(
            "k_y = k_forward + k_backward",
            {
                "k_y": lab.Symbol(mapped, "N m s", "of the body: a row of A_G times the speeds", ".3f"),
                "k_forward": lab.Symbol(
                    lambda s: np.maximum(of_links(s), 0).sum(1), "N m s", "of links", ".3f"
                ),
                "k_backward": lab.Symbol(
                    lambda s: np.minimum(of_links(s), 0).sum(1), "N m s", "of links", ".3f"
                ),
            },
            within=1e-6,
            unit="N m s",
        ),
    ),
)

CLAIMS = (
    lab.Stands("push"),
    lab.Bound("links turn both ways, and much cancels", "cancelled", low=30.0),
    lab.Bound("what is left is six numbers", "rows", low=6.0, high=6.0),
)
