"""Falling cats

In the air there is nothing to push against. Can a robot still turn its body?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments import flight
from momentum_lab.experiments.arm_swing import spin
from momentum_lab.experiments.flight_push import given
from momentum_lab.experiments.measured import pelvis_turn, push_end, times
from momentum_lab.lesson import spins

RUNS = {"cat": lab.Run("flight"), "kicked": lab.Run("flight-push")}


def turn(session):
    """How far the pelvis is turned (n,), degrees."""
    return np.degrees(np.linalg.norm(pelvis_turn(session), axis=1))


def upward(session):
    """The part of its turn that is about the vertical, %."""
    turned = np.abs(pelvis_turn(session)[-1])
    return 100.0 * turned[2] / np.linalg.norm(turned)


def bent(session):
    """How far the joints are from where they were, in the end, degrees."""
    angles = session.recording.column("q")[:, 7:]
    return np.degrees(np.abs(angles[-1] - angles[0]).max())


def lost(session):
    """How far the angular momentum strays after the push, as part of it, %."""
    kept = session.recording.column("momentum")[times(session) > push_end(session) + 1e-9, 3:]
    return 100.0 * np.abs(kept - kept[0]).max() / np.linalg.norm(kept[0])


def touched(runs):
    return max(np.abs(run.recording.column("foot_wrench_measured")).max() for run in runs.values())


MEASURES = {
    "height": lab.of("cat", lambda s: s.scenario.drop_height, "m", ".1f"),
    "touched": lab.Measure(touched, "N"),
    "none": lab.of("cat", lambda s: spin(s).max(), "N m s", ".2f"),
    "bent": lab.of("cat", bent, "degrees", ".1f"),
    "foretold": lab.of("cat", lambda s: np.degrees(flight.foretold(s)[-1]), "degrees", ".1f"),
    "cat": lab.of("cat", lambda s: turn(s)[-1], "degrees", ".1f"),
    "upright": lab.of("cat", upward, "%"),
    "midway": lab.of("cat", lambda s: turn(s).max(), "degrees", ".1f"),
    "kicked": lab.of("kicked", lambda s: turn(s)[-1], "degrees", ".1f"),
    "kick": lab.of("kicked", lambda s: np.linalg.norm(given(s)), "N m s", ".2f"),
    "lost": lab.of("kicked", lost, "%", ".2f"),
    "limbs": lab.of("cat", lambda s: np.abs(flight.shares(s)[1]).max(), "N m s", ".1f"),
}

STEPS = (
    lab.Prose(
        "A robot is let go {height} up, at rest. Its weight acts at the CoM and has no lever, so its angular "
        "momentum stays zero. Its legs may move, but must be back in place before it lands."
    ),
    lab.Choice(
        "Does its chest face another way when it lands?",
        (
            lab.Option("No: without angular momentum nothing turns", lambda m: m["midway"] < 1.0),
            lab.Option(
                "On the way, but it turns back with the legs", lambda m: m["cat"] < 1.0 <= m["midway"]
            ),
            lab.Option("Yes", lambda m: m["cat"] >= 1.0),
        ),
    ),
    lab.Number(
        "Another one is kicked in the air. How much of its spin is lost before it lands?", "lost", 0, 100
    ),
    lab.Play("You look from the front. Slow it down.", "cat", ("push",), beside="kicked", view="Front"),
    lab.Compare(
        "The legs are back to within {bent}. The body has turned by {cat} about the vertical. The "
        "legs had up to {limbs}, the body as much the other way, and the sum was never more than {none}. Of "
        "the kick's {kick}, {lost} was lost.",
        ("cat", "bent", "lost"),
    ),
    lab.Prose(
        "The legs swung one way while spread, and back while together. Spread legs turn the body farther, so it "
        "does not turn back as far. Only their way counts, not their speed: geometry alone gives {foretold} "
        "(Eq. 15). A cat does the like about its spine."
    ),
    lab.Explain(
        "In the air, what the joints gain in angular momentum the body loses. Their sum is what the kick gave, "
        "from then on (Eq. 1).",
        "kicked",
        0.3,
        lab.Equation(
            "k_body + k_joints = k_kick",
            {
                "k_body": lab.Symbol(
                    lambda s: spins.of_body(s)[:, 1], "N m s", "of the body turning as one", ".2f"
                ),
                "k_joints": lab.Symbol(
                    lambda s: spins.of_joints(s)[:, 1], "N m s", "of the joints' motion", ".2f"
                ),
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
    # The legs move fast: what a tick of 1 ms leaves of them is less than 1 % of their momentum.
    lab.Bound("without a kick there is no angular momentum", "none", high=0.1),
    lab.Bound("the limbs have much more", "limbs", low=5.0),
    lab.Bound("they come back", "bent", high=0.5),
    lab.Bound("still the body is turned", "cat", low=20.0),
    lab.Bound("about the vertical", "upright", low=95.0),
    lab.Bound("by what geometry gives", "foretold", low=20.0),
    lab.Bound("the angular momentum of a kick stays", "lost", high=1.0),
    lab.Bound("and turns the body, too", "kicked", low=10.0),
)
