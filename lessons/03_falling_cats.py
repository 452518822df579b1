"""Falling cats

In the air there is nothing to push against. Can a robot still turn its body?
"""

from functools import lru_cache

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments import flight
from momentum_lab.experiments.flight_push import given
from momentum_lab.experiments.measured import pelvis_turn, push_end, times
from momentum_lab.robot.state import State

RUNS = {"cat": lab.Run("flight"), "kicked": lab.Run("flight-push")}


def turn(session):
    """How far the pelvis has turned in the end, degrees."""
    return float(np.degrees(np.linalg.norm(pelvis_turn(session)[-1])))


def bent(session):
    """How far the joints are from where they were, in the end, degrees."""
    angles = session.recording.column("q")[:, 7:]
    return float(np.degrees(np.abs(angles[-1] - angles[0]).max()))


def most_spin(session):
    """The largest angular momentum about the CoM, N m s."""
    return float(np.linalg.norm(session.recording.column("momentum")[:, 3:], axis=1).max())


@lru_cache(2)
def shares(session):
    """Angular momentum about y that comes from the whole body's motion, and from the joints' (n, 2), N m s."""
    column, found = session.recording.column, []
    for q, v in zip(column("q"), column("v"), strict=True):
        parts = session.robot.at(State(q, v)).centroidal_map[4] * v
        found.append((parts[:6].sum(), parts[6:].sum()))
    return np.array(found)


def kept(session):
    """How far the angular momentum strays after the push, as part of it, %."""
    spin = session.recording.column("momentum")[times(session) > push_end(session) + 1e-9, 3:]
    return 100.0 * float(np.abs(spin - spin[0]).max() / np.linalg.norm(spin[0]))


def touched(runs):
    return float(max(np.abs(run.recording.column("foot_wrench_measured")).max() for run in runs.values()))


MEASURES = {
    "height": lab.Measure(lambda runs: runs["cat"].scenario.drop_height, "m", ".1f"),
    "touched": lab.Measure(touched, "N"),
    "none": lab.Measure(lambda runs: most_spin(runs["cat"]), "N m s", ".2f"),
    "bent": lab.Measure(lambda runs: bent(runs["cat"]), "degrees", ".1f"),
    "foretold": lab.Measure(
        lambda runs: float(np.degrees(flight.foretold(runs["cat"])[-1])), "degrees", ".1f"
    ),
    "cat": lab.Measure(lambda runs: turn(runs["cat"]), "degrees", ".1f"),
    "kicked": lab.Measure(lambda runs: turn(runs["kicked"]), "degrees", ".1f"),
    "kick": lab.Measure(lambda runs: float(np.linalg.norm(given(runs["kicked"]))), "N m s", ".2f"),
    "kept": lab.Measure(lambda runs: kept(runs["kicked"]), "%", ".2f"),
    "limbs": lab.Measure(lambda runs: float(np.abs(flight.shares(runs["cat"])[1]).max()), "N m s", ".1f"),
}

STEPS = (
    lab.Prose(
        "The robot is dropped from {height}. Until it lands, only its weight acts, and weight has no lever about the "
        "CoM. So its angular momentum cannot change: it is {none} at most, which the steps of the simulation leave."
    ),
    lab.Choice(
        "Its legs may move, but have to be back where they were before it lands. Can the body be turned then?",
        (
            lab.Option("No: without angular momentum nothing turns", lambda m: m["cat"] < 1.0),
            lab.Option("Yes: the legs go out on one way and come back on another", lambda m: m["cat"] >= 1.0),
        ),
    ),
    lab.Number(
        "Now it is kicked in the air. How much of the kick's spin is lost before it lands?", "kept", 0, 100
    ),
    lab.Play(
        "Drop it, pause it in the air, look at the body.", "cat", ("push", "push height"), beside="kicked"
    ),
    lab.Compare(
        "Its legs scissored while they were spread and went back while they were not, with up to {limbs}, which the "
        "body took back. In the end they are where they were to {bent}, and the body is turned by {cat}: that is how "
        "a cat lands on its feet. Kicked, it turned by {kicked}, and of the spin of {kick} only {kept} strayed.",
        ("cat", "bent", "kicked", "kept"),
    ),
    lab.Prose(
        "How far it turns depends on the loop of the legs alone, not on how fast they go or on what drives them. "
        "With no momentum, their rates give the body's rates (Eq. 15), and those {foretold} without any physics."
    ),
    lab.Explain(
        "What the joints contribute, the body as a whole takes back: their sum is what the kick gave, moment by "
        "moment (Eq. 1), and nothing else. Here the joints move, the body turns, the sum stays.",
        "kicked",
        0.3,
        lab.Equation(
            "k_body + k_joints = k_kick",
            {
                "k_body": lab.Symbol(lambda s: shares(s)[:, 0], "N m s", "of the body turning as one", ".2f"),
                "k_joints": lab.Symbol(lambda s: shares(s)[:, 1], "N m s", "of the joints' motion", ".2f"),
                "k_kick": lab.Symbol(
                    lambda s: given(s)[1], "N m s", "moment of the kick over its time", ".2f"
                ),
            },
            within=0.1,
            unit="N m s",
            since=0.11,
        ),
    ),
)

CLAIMS = (
    lab.Bound("nothing touches the ground", "touched", high=0.0),
    # The legs move fast now: what a tick of 1 ms leaves of them is less than 1 % of their momentum.
    lab.Bound("without a kick there is no angular momentum", "none", high=0.1),
    lab.Bound("the limbs have much more", "limbs", low=5.0),
    lab.Bound("they come back", "bent", high=0.5),
    lab.Bound("still the body is turned", "cat", low=20.0),
    lab.Bound("by what kinematics gives", "foretold", low=20.0),
    lab.Bound("the spin of a kick stays", "kept", high=1.0),
    lab.Bound("and turns the body, too", "kicked", low=10.0),
)
